// Vectors and boxes, as in the public headers.
#pragma once

#include "pliant/math.h"
