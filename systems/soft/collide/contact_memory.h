// The last step's data of a pair of features: side, tangents, impulse. Keys do not contain the triangle under a vertex,
// so a sliding contact keeps its data from triangle to triangle.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "systems/soft/contact/contact_point.h"

namespace pliant {

// A vertex of body a on body b. It may have several contacts there (in a corner): `ordinal` 0, 1, 2.
std::uint64_t vertex_key(std::uint32_t body_a, std::uint32_t body_b, std::uint32_t vertex, std::uint32_t ordinal);
std::uint64_t edge_key(std::uint32_t body_a, std::uint32_t body_b, std::uint32_t edge_a, std::uint32_t edge_b);

class ContactMemory {
 public:
  void take(const std::vector<ContactPoint>& contacts);
  // Null if the last step had no such contact.
  const ContactPoint* find(std::uint64_t key) const;

 private:
  std::vector<ContactPoint> contacts_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> by_key_;
};

// Side and distance of two features, whether or not their contact was kept for the solve.
struct KnownSide {
  std::uint64_t key = 0;
  dvec3 normal{0};   // [1]
  double gap = 0.0;  // [m]
  std::uint32_t body_low = 0, body_high = 0;
};
class SideMemory {
 public:
  void clear() { sides_.clear(); }
  void add(const KnownSide& side) { sides_.push_back(side); }
  void forget(std::uint32_t body);
  void sort();                                     // once all are added, before find()
  const KnownSide* find(std::uint64_t key) const;  // null if they did not meet

 private:
  std::vector<KnownSide> sides_;
};

// Axes, impulse and sliding of a contact: those of the last step rotated onto the new normal, or new ones.
void carry_over(const ContactPoint* last, ContactPoint& contact);

}  // namespace pliant
