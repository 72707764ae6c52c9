// The contacts of one probe, on every awake object.
#pragma once

#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// Calls visit(const Contact&) for those that are not free.
template <class Visit>
void for_contacts_of(const World& world, Entity probe, Visit visit) {
  for (const TrackedContact& tracked : world.touch->tracked) {
    if (tracked.probe != probe) continue;
    const Contact& contact = world.registry.get<Contact>(tracked.contact);
    if (contact.probe == probe && contact.state != ContactState::kFree) visit(contact);
  }
}

}  // namespace pliant
