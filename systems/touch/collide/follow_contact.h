// Follows the contacts of the last tick.
#pragma once

#include "systems/touch/collide/contact_search.h"

namespace pliant {

// To the tip's place now, object frame: downhill from the last foot, over seams to the other surface, or to its end.
void follow_contact(const ContactSearch& s, SourceState& source, Contact& contact, const TipPlace& tip);

// Of contacts of one tip that have reached the same foot, the one stays whose depth was pushed.
void merge_contacts(const ContactSearch& s);

}  // namespace pliant
