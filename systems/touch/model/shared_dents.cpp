#include "systems/touch/model/shared_dents.h"

#include <array>
#include <cmath>

#include "systems/touch/collide/capsule.h"

namespace pliant {

void SharedDents::add(const ContactSearch& search, std::span<const Pressing> pressing) {
  const std::size_t last = pressing.size() - 1;
  const Pressing& b = pressing[last];
  const double radius = b.source->tip.radius;
  for (std::size_t i = 0; i < last; ++i) {
    const Pressing& a = pressing[i];
    pair_[i][last] = kNone;
    const bool capsule = b.source->tip.is_capsule();
    if ((radius == 0.0 && !capsule) || count_ == kMostPairs || a.contact->probe != b.contact->probe ||
        a.contact->tip != b.contact->tip)
      continue;
    const Ridge ridge = capsule ? ridge_along(search, *a.source, *b.source)
                                : ridge_between(search.mesh, a.source->place, b.source->place, b.source->x, radius);
    pair_[i][last] = static_cast<std::uint16_t>(count_);
    pairs_.all[count_++] = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(last), ridge};
  }
}

std::span<SharedDent> SharedDents::of(std::span<const Pressing> pressing) {
  if (count_ == 0) return {};
  // The way over a third contact may be the deeper one. The depths of all ridges are then those of a tree, and the
  // matrix of their energies has no negative eigenvalue.
  Room<Ridge, kMostPairs> room;
  std::array<Ridge, kMostPairs>& deepest = room.all;
  for (std::size_t k = 0; k < count_; ++k) deepest[k] = pairs_.all[k].ridge;
  for (std::size_t over = 0; over < pressing.size(); ++over)
    for (std::size_t k = 0; k < count_; ++k) {
      const std::uint32_t a = pairs_.all[k].a, b = pairs_.all[k].b;
      if (over == a || over == b || b >= pressing.size()) continue;
      const std::uint16_t to = between(a, over), on = between(over, b);
      if (to == kNone || on == kNone) continue;
      const Ridge& lower = deepest[to].depth < deepest[on].depth ? deepest[to] : deepest[on];
      if (lower.depth > deepest[k].depth) deepest[k] = lower;
    }
  std::size_t dents = 0;
  for (std::size_t k = 0; k < count_; ++k)
    if (pairs_.all[k].b < pressing.size() && shared(pressing, pairs_.all[k], deepest[k], dents_.all[dents])) ++dents;
  return {dents_.all.data(), dents};
}

bool SharedDents::shared(std::span<const Pressing> pressing, const Pair& pair, const Ridge& ridge, SharedDent& dent) {
  const Pressing &a = pressing[pair.a], &b = pressing[pair.b];
  // Never deeper than one of them: both are lower by their roughness.
  const Raised& raised = a.raised.height < b.raised.height ? a.raised : b.raised;
  const double depth = ridge.depth + raised.height;
  const dvec3 deeper = ridge.slope + raised.gradient;
  const StoredEnergy at_a = a.law.stored(depth), at_b = b.law.stored(depth);
  if (!(at_a.energy > 0 && at_b.energy > 0 && a.stored.energy > 0 && b.stored.energy > 0)) return false;
  dent.a = pair.a;
  dent.b = pair.b;
  dent.part = std::sqrt(at_a.energy / a.stored.energy * (at_b.energy / b.stored.energy));
  const dvec3 at_ridge = (at_a.force / at_a.energy + at_b.force / at_b.energy) * deeper,
              by_a = a.stored.force / a.stored.energy * a.gradient,
              by_b = b.stored.force / b.stored.energy * b.gradient;
  dent.slope = 0.5 * dent.part * (at_ridge + by_a + by_b);
  dent.turning = 0.5 * dent.part * (cross(ridge.x, at_ridge) + cross(a.source->x, by_a) + cross(b.source->x, by_b));
  return true;
}

}  // namespace pliant
