// Vectors and boxes, as the public headers have them.
#pragma once

#include "pliant/math.h"
