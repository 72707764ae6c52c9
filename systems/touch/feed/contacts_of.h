// The contacts of one probe, on every awake object.
#pragma once

#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// Calls visit(const Contact&) for those that are not free.
template <class Visit>
void for_contacts_of(const World& world, Entity probe, Visit visit) {
  for (const std::uint32_t slot : world.touch->awake) {
    const ObjectState& object = world.touch->objects[slot];
    for (std::uint32_t i = 0; i < object.probe_sources; ++i) {
      if (!object.sources[i].tracked) continue;
      const Contact& contact = world.registry.get<Contact>(object.sources[i].contact);
      if (contact.probe == probe && contact.state != ContactState::kFree) visit(contact);
    }
  }
}

}  // namespace pliant
