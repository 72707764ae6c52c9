// As many contacts as carry the load, no more: a hand on an object has thousands of pairs, and tens decide.
#pragma once

#include <vector>

#include "systems/tool/contact_point.h"

namespace pliant {

struct Candidate {
  ContactPoint contact;
  double end_gap = 0.0;  // [m] predicted: deepest first
  bool known = false;    // had a contact in the last step
};

struct ThinningLimits {
  double spacing = 0.2;           // [mean edges] contacts of alike normals nearer than this are one
  std::size_t most_of_pair = 60;  // of two bodies: the spacing grows until no more are left
  std::size_t most = 200;         // of all
};

// Deepest first, those of the last step preferred; what lies within `spacing` of one that is kept is dropped.
// `mean_edge` [m] per body. Appends to `out`, in an order that depends on nothing but the candidates.
void thin_contacts(std::vector<Candidate>& candidates, const std::vector<double>& mean_edge,
                   const ThinningLimits& limits, std::vector<ContactPoint>& out);

}  // namespace pliant
