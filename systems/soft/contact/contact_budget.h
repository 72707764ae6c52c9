// A bound on what one body's contacts may cost, far above what scenes need: a soft body answers three times a contact.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "systems/soft/contact/contact_point.h"

namespace pliant {

inline constexpr int kMostOfBody = 256;  // contacts of a body that moves; more: a step's cost grows with their square

// Leaves every body that moves at most `most` contacts, in their order. Those that carried the largest impulses in the
// last step stay first, then the deepest. Returns how many were cut.
std::size_t cut_contacts(const std::vector<std::unique_ptr<Body>>& bodies, int most,
                         std::vector<ContactPoint>& contacts);

// The same where contacts join those of a solve: the first `known` stay, of the others, in their order, those for which
// every body has room. Returns how many were cut.
std::size_t cut_late_contacts(const std::vector<std::unique_ptr<Body>>& bodies, int most, std::size_t known,
                              std::vector<ContactPoint>& contacts);

}  // namespace pliant
