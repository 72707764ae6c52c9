// The law `table`: a monotone cubic through rows of force against depth (Fritsch & Carlson, SIAM J. Numer. Anal. 17,
// 1980). Its slope is continuous. Beyond the last row it goes on with the slope there.
#pragma once

#include "components/cubic_pieces.h"
#include "pliant/parameters.h"

namespace pliant {

// Per unit of stiffness: x the depth [m], value [m], slope [1], integral of the value from 0 [m2].
struct MonotoneCubic : CubicPieces<ForceTable::kMost> {};

// [N/m] The slope at depth 0, at least a quarter of the first interval's mean. The table must have no fault.
double stiffness_of(const ForceTable& table);
MonotoneCubic monotone_cubic(const ForceTable& table, double stiffness);

}  // namespace pliant
