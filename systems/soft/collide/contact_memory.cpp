#include "systems/soft/collide/contact_memory.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/collide/farthest_axis.h"
#include "systems/soft/contact/contact_problem.h"

namespace pliant {
namespace {

// Hash finaliser of MurmurHash3: two pairs of features do not share a key in practice.
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdull;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ull;
  return x ^ (x >> 33);
}
std::uint64_t key_of(std::uint64_t kind, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const std::uint64_t bodies = static_cast<std::uint64_t>(a) << 32 | b,
                      features = static_cast<std::uint64_t>(c) << 32 | d;
  return mix(mix(mix(kind) ^ bodies) ^ features);
}

}  // namespace

std::uint64_t vertex_key(std::uint32_t a, std::uint32_t b, std::uint32_t vertex, std::uint32_t ordinal) {
  return key_of(1, a, b, vertex, ordinal);
}
std::uint64_t edge_key(std::uint32_t a, std::uint32_t b, std::uint32_t edge_a, std::uint32_t edge_b) {
  return key_of(2, a, b, edge_a, edge_b);
}

void ContactMemory::take(const std::vector<ContactPoint>& contacts) {
  contacts_ = contacts;
  by_key_.clear();
  for (std::uint32_t i = 0; i < contacts_.size(); ++i) by_key_.emplace_back(contacts_[i].key, i);
  std::sort(by_key_.begin(), by_key_.end());
}

const ContactPoint* ContactMemory::find(std::uint64_t key) const {
  const auto it = std::lower_bound(by_key_.begin(), by_key_.end(), std::make_pair(key, 0u));
  return it != by_key_.end() && it->first == key ? &contacts_[it->second] : nullptr;
}

void SideMemory::sort() {
  std::sort(sides_.begin(), sides_.end(), [](const KnownSide& x, const KnownSide& y) { return x.key < y.key; });
}

void SideMemory::forget(std::uint32_t body) {
  std::erase_if(sides_, [&](const KnownSide& side) { return side.body_low == body || side.body_high == body; });
}

const KnownSide* SideMemory::find(std::uint64_t key) const {
  const auto it = std::lower_bound(sides_.begin(), sides_.end(), key,
                                   [](const KnownSide& x, std::uint64_t k) { return x.key < k; });
  return it != sides_.end() && it->key == key ? &*it : nullptr;
}

void carry_over(const ContactPoint* last, ContactPoint& contact) {
  const dvec3 n = contact.normal;
  dvec3 along = farthest_axis(n);
  if (last) {
    const dvec3 kept = last->axes[1] - dot(last->axes[1], n) * n;
    if (dot(kept, kept) > 0.25) along = kept;
    contact.impulse = last->impulse * leaning_axes(last->lean);
    contact.sliding = last->sliding;
    contact.slipped = last->slipped;
    contact.dented = last->dented, contact.relaxed = last->relaxed;
    contact.strained = last->strained - dot(last->strained, n) * n;
  }
  const dvec3 t = normalize(along - dot(along, n) * n);
  contact.axes = dmat3(n, t, cross(n, t));
}

}  // namespace pliant
