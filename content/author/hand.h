// A hand as a solid: palm, four fingers and a thumb that flow into the palm but never into one another.
#pragma once

#include "content/author/solid.h"

namespace pliant::solids {

// A right hand about 0.19 m long, lying flat: the back up (+Y), fingers along -Z, the thumb towards -X. [m]
Solid hand_solid();
// Holds the hand with room to spare.
Box hand_box();
// The part that a person holds: the heel of the palm and the wrist.
Box hand_bone();

}  // namespace pliant::solids
