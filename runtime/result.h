// Errors at the border, as the public headers have them; inside the house, broken promises are ASSERTs.
#pragma once

#include "pliant/result.h"
#include "runtime/assert.h"
