// Which of the meetings of two collision meshes' features are contacts. In front of each other they are; behind, a
// feature touches what it came from, as the last step remembers, or, where it has no past, the nearest if it really is
// inside.
#pragma once

#include <vector>

#include "systems/soft/collide/contact_memory.h"
#include "systems/soft/collide/meetings.h"

namespace pliant {

// A contact before it is known whether it is kept.
struct Found {
  std::uint32_t body_a, body_b;
  bool edges;  // else a vertex of a on a triangle of b
  std::uint32_t feature_a, feature_b;
  Meeting meeting;
  const ContactPoint* last;  // of the memory, or null
  std::uint64_t key;         // contact_memory.h
};

// What is known of a pair of bodies when its meetings are looked at.
struct PairView {
  double margin = 0.0;  // [m] within which pairs are taken along although they are not about to touch
  Reach reach;
  dvec3 way{0};  // [1] of pairs that began inside each other, until they are out: where the first of them is pushed
  const ContactMemory& memory;
  const SideMemory& sides;  // of the last step; for missed ones, of this one
};

// Append to `out`; sort the meetings on the way.
void take_contacts(const PairView& pair, const MeetingSide& a, const MeetingSide& b, Meetings& meetings,
                   std::vector<Found>& out);
// Of what only a solution brings about: what crosses, and was not seen on that side before.
Crossings take_missed(const PairView& pair, const MeetingSide& a, const MeetingSide& b, Meetings& meetings,
                      std::vector<Found>& out);

}  // namespace pliant
