// Finds the contacts that begin in this tick.
#pragma once

#include "systems/touch/collide/contact_search.h"

namespace pliant {

// On the tip's way on the object. `fresh`: its first pose. `searched`: where this tip last searched for walls of the
// object. `clear`: around it no wall is near.
void find_new_contacts(const ContactSearch& s, const ProbeTip& tip, TipPlace& searched, ClearBall& clear, bool fresh,
                       const TipPlace& from, const TipPlace& to);

}  // namespace pliant
