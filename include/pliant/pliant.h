// All of the engine. docs/embedding.md walks through it.
#pragma once

#include "pliant/device_state.h"
#include "pliant/driver.h"
#include "pliant/math.h"
#include "pliant/parameters.h"
#include "pliant/process.h"
#include "pliant/progress.h"
#include "pliant/result.h"
#include "pliant/scene.h"
#include "pliant/session.h"
