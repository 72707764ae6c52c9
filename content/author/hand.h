// A hand as a solid. The palm blends with the four fingers and the thumb; the digits do not blend with one another.
#pragma once

#include <array>

#include "content/author/solid.h"

namespace pliant::solids {

// A right hand about 0.19 m long, lying flat: its back up (+Y), fingers along -Z, the thumb towards -X. [m]
Solid hand_solid();
// Contains the hand, with a margin.
Box hand_box();
// [m] Of the thumb, then from the index to the little finger: its root in the palm, two joints, its tip.
std::array<std::array<dvec3, 4>, 5> hand_joints();
// The part that is pinned to the handle: the heel of the palm and the wrist.
Box hand_bone();

}  // namespace pliant::solids
