// As many contacts as carry the load, no more: a hand on an object has thousands of pairs, and tens decide.
#pragma once

#include <cstdint>
#include <vector>

#include "components/math.h"

namespace pliant {

// A contact that might be kept.
struct Candidate {
  std::uint32_t body_low = 0, body_high = 0;  // equal: self-collision
  dvec3 position{0};                          // [m] world
  dvec3 normal{0, 1, 0};                      // [1] out of body_low, whoever is side a
  double gap = 0.0;                           // [m] now
  double end_gap = 0.0;                       // [m] predicted: deepest first
  double edge = 0.0;                          // [m] how long the collision meshes' edges are there
  bool known = false;                         // had a contact in the last step
  std::uint64_t key = 0;
  std::uint32_t source = 0;  // whatever the caller finds it by
};

struct ThinningLimits {
  double spacing = 0.2;           // [edges] contacts of alike normals nearer than this are one
  std::size_t most_of_pair = 60;  // of two bodies: the spacing grows until no more are left
};

// Leaves those to keep: deepest first, those of the last step preferred; what lies within `spacing` of one that is kept
// is dropped. Each pair by itself: what other bodies do changes nothing. The order depends on nothing but the
// candidates.
void thin_contacts(std::vector<Candidate>& candidates, const ThinningLimits& limits);

}  // namespace pliant
