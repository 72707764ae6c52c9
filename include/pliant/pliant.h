// Includes the whole engine interface. See docs/embedding.md.
#pragma once

#include "pliant/device_state.h"
#include "pliant/driver.h"
#include "pliant/felt_event.h"
#include "pliant/math.h"
#include "pliant/parameters.h"
#include "pliant/process.h"
#include "pliant/progress.h"
#include "pliant/result.h"
#include "pliant/scene.h"
#include "pliant/session.h"
