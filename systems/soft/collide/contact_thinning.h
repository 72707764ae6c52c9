// Reduces contacts to those that carry the load: a hand on an object has thousands of pairs, and tens are sufficient.
#pragma once

#include <cstdint>
#include <vector>

#include "components/math.h"

namespace pliant {

// A possible contact.
struct Candidate {
  std::uint32_t body_low = 0, body_high = 0;  // equal: self-collision
  dvec3 position{0};                          // [m] world
  dvec3 normal{0, 1, 0};                      // [1] out of body_low, whichever is side a
  double gap = 0.0;                           // [m] now
  double end_gap = 0.0;                       // [m] predicted: deepest first
  double edge = 0.0;                          // [m] local edge length of the collision meshes
  bool known = false;                         // had a contact in the last step
  std::uint64_t key = 0;
  std::uint32_t source = 0;  // an index of the caller's
};

struct ThinningLimits {
  double spacing = 0.2;           // [edges] contacts with similar normals closer than this are merged
  std::size_t most_of_pair = 60;  // for two bodies: the spacing grows until at most this many are left
};

// Keeps the deepest first, preferring those of the last step; drops contacts within `spacing` of a kept one. Each pair
// is independent of other bodies. The order depends only on the candidates.
void thin_contacts(std::vector<Candidate>& candidates, const ThinningLimits& limits);

}  // namespace pliant
