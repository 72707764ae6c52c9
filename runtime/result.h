// Errors at the border, as in the public headers. Inside, use ASSERT.
#pragma once

#include "pliant/result.h"
#include "runtime/assert.h"
