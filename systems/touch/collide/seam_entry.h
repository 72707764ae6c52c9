// Contacts that begin between the two sides of a seam, in the crack: there no side's wall is under the tip.
#pragma once

#include <optional>

#include "systems/touch/collide/contact_search.h"

namespace pliant {

// Whether this foot of x bears a tip over a crack: it is at a seam, and so is that on the other side. Of both, one
// does.
bool bears_between(const ContactSearch& s, const Foot& foot, dvec3 x);

// Where the way of a point enters a crack: the nearest place of a seam's edge.
struct SeamEntry {
  std::uint32_t triangle = 0;
  dvec3 barycentric{1, 0, 0};
  dvec3 x{0}, outward{0};  // [m] of the point, [1] normal of the triangle
};
std::optional<SeamEntry> seam_entry(const ContactSearch& s, dvec3 from, dvec3 to);

}  // namespace pliant
