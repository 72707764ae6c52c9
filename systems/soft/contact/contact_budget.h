// A bound on the cost of one body's contacts, far above the needs of scenes: a soft body solves for three columns per
// contact.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "systems/soft/contact/contact_point.h"

namespace pliant {

inline constexpr int kMostOfBody = 256;  // contacts of a movable body; more: a step's cost grows with their square

// Limits every movable body to `most` contacts, keeping their order. Contacts with the largest impulses in the last
// step are preferred, then the deepest. Returns the number of contacts cut.
std::size_t cut_contacts(const std::vector<std::unique_ptr<Body>>& bodies, int most,
                         std::vector<ContactPoint>& contacts);

// The same for contacts that join a solve. The first `known` stay; of the others, in order, those for which every body
// has room. Returns the number of contacts cut.
std::size_t cut_late_contacts(const std::vector<std::unique_ptr<Body>>& bodies, int most, std::size_t known,
                              std::vector<ContactPoint>& contacts);

}  // namespace pliant
