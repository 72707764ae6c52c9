// The contacts of one probe, on every awake object.
#pragma once

#include <algorithm>

#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// Calls visit(const Contact&) for those that are not free.
template <class Visit>
void for_contacts_of(const World& world, Entity probe, Visit visit) {
  const std::vector<TrackedContact>& all = world.touch->tracked;
  auto at = std::lower_bound(all.begin(), all.end(), probe.index,
                             [](const TrackedContact& tracked, std::uint32_t of) { return tracked.probe.index < of; });
  for (; at != all.end() && at->probe.index == probe.index; ++at) {
    const Contact& contact = world.registry.get<Contact>(at->contact);
    if (contact.probe == probe && contact.state != ContactState::kFree) visit(contact);
  }
}

}  // namespace pliant
