// Damage that a probe leaves in a surface: layers that it broke through, and dents that stay (methods.md 1.14). Neither raises
// the stored energy.
#pragma once

#include "systems/touch/collide/contact_search.h"
#include "systems/touch/model/pressing.h"

namespace pliant {

// Layers that are broken at the contact's place, for a tip of its radius, are so for the contact.
void find_hole(const ObjectState& object, const SourceState& source, Contact& contact);

// Height of the dents that stay, under a tip.
Raised set_under(const ObjectState& object, const FootBlend& place, const AxisPlace& axis);

// [1] Share of a contact's depth that its drawn dent has.
inline double dent_share(const Contact& contact, const Deformable& deformable) {
  return contact.damage.broken > 0 && !deformable.layers.empty() ? deformable.layers[0].remains : 1.0;
}

// Breaks the next layer of a contact whose load is at its limit, or lets the surface yield under it. True: the contact
// stores less now, and the loads must be shared anew.
bool give_way(const ContactSearch& search, const Deformable& deformable, Pressing& pressing, LoadedContact& loaded);

// Friction of a tip in its hole, along the normal: what it does to the probe, object frame. [N]
dvec3 grip(const Deformable& deformable, const FootBlend& place, Contact& contact, double dt);

}  // namespace pliant
