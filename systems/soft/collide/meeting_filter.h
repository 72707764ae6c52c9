// Selects contacts among the meetings of two collision meshes' features. Features in front of each other are contacts.
// Behind, a feature touches the one that it came from, by the last step's memory. Without history it touches the
// nearest, if it really is inside.
#pragma once

#include <vector>

#include "systems/soft/collide/contact_memory.h"
#include "systems/soft/collide/meetings.h"

namespace pliant {

// A contact before thinning.
struct Found {
  std::uint32_t body_a, body_b;
  bool edges;  // else a vertex of a on a triangle of b
  std::uint32_t feature_a, feature_b;
  Meeting meeting;
  const ContactPoint* last;  // of the memory, or null
  std::uint64_t key;         // contact_memory.h
};

// State of a pair of bodies when its meetings are filtered.
struct PairView {
  double margin = 0.0;  // [m] distance within which pairs are included although they do not touch yet
  Reach reach;
  dvec3 way{0};  // [1] for pairs that began inside each other, until separated: direction in which the first is pushed
  const ContactMemory& memory;
  const SideMemory& sides;  // of the last step; for missed contacts, of this one
};

// Appends to `out`; sorts the meetings.
void take_contacts(const PairView& pair, const MeetingSide& a, const MeetingSide& b, Meetings& meetings,
                   std::vector<Found>& out);
// Contacts that only a solution produces: crossings that were not seen on that side before.
Crossings take_missed(const PairView& pair, const MeetingSide& a, const MeetingSide& b, Meetings& meetings,
                      std::vector<Found>& out);

}  // namespace pliant
