#include "systems/soft/collide/contact_thinning.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pliant {
namespace {

constexpr double kAlike = 0.9;       // [1] cosine between normals of similar contacts
constexpr double kGrowth = 1.1;      // [1] of the spacing, if too many are left: regular meshes lose half at once
constexpr double kSteady = 0.05;     // [edges] a new contact must be deeper by this to replace one of the last step
constexpr double kTouches = 0.1;     // [edges] closer contacts touch already; thinned too far, neighbours would sink
                                     // in:
constexpr double kDenseShare = 0.5;  // [1] their spacing relative to that of contacts that do not touch yet
constexpr double kWidest = 1e3;      // [1] limit of the spacing's growth: by then one contact per direction is left

using Run = std::vector<Candidate>::iterator;

bool same_pair(const Candidate& x, const Candidate& y) {
  return x.body_low == y.body_low && x.body_high == y.body_high;
}

// Minimum distance between contacts.
struct Spacing {
  double edges;        // [1] of the shorter of the two contacts' edges
  double least = 0.0;  // [m] anywhere
  void widen() { edges *= kGrowth, least *= kGrowth; }
  double between(const Candidate& a, const Candidate& b) const {
    const double edge = std::min(a.edge, b.edge);
    return std::max(edges * edge, std::max(a.gap, b.gap) < kTouches * edge ? kDenseShare * least : least);
  }
};

// Moves the candidates of [first, last) that are sufficiently apart to the front, in order; returns their end.
Run keep_apart(Run first, Run last, const Spacing& spacing) {
  Run kept = first;
  for (Run c = first; c != last; ++c) {
    const bool both_ways = c->body_low == c->body_high;  // in a self-contact, either side may be the lower one
    const bool taken = std::any_of(first, kept, [&](const Candidate& k) {
      const dvec3 d = k.position - c->position;
      const double apart = spacing.between(*c, k);
      if (dot(d, d) >= apart * apart) return false;
      const double alike = dot(k.normal, c->normal);
      return (both_ways ? std::abs(alike) : alike) > kAlike;
    });
    if (!taken) std::swap(*kept++, *c);
  }
  return kept;
}

// [m] Of the box around them.
double extent(Run first, Run last) {
  dvec3 low(1e300), high(-1e300);
  for (Run c = first; c != last; ++c) {
    low = glm::min(low, c->position);
    high = glm::max(high, c->position);
  }
  return length(high - low);
}

// Thins one pair's candidates to `most`, starting at a spacing at which several times that many fit.
Run thin_pair(Run first, Run last, Spacing spacing, std::size_t most) {
  const auto too_many = [&] { return static_cast<std::size_t>(last - first) > most; };
  if (too_many()) spacing.least = 0.5 * extent(first, last) / std::sqrt(static_cast<double>(most));
  last = keep_apart(first, last, spacing);
  for (double wider = kGrowth; too_many(); wider *= kGrowth) {
    if (wider > kWidest) last = first + static_cast<std::ptrdiff_t>(most);
    spacing.widen();
    last = keep_apart(first, last, spacing);
  }
  return last;
}

}  // namespace

void thin_contacts(std::vector<Candidate>& candidates, const ThinningLimits& limits) {
  const auto order = [&](const Candidate& c) {
    const double ahead = c.known ? kSteady * c.edge : 0.0;
    return std::make_tuple(c.body_low, c.body_high, c.end_gap - ahead, c.key);
  };
  std::sort(candidates.begin(), candidates.end(),
            [&](const Candidate& x, const Candidate& y) { return order(x) < order(y); });

  Run kept = candidates.begin();
  for (Run first = candidates.begin(); first != candidates.end();) {  // sorted, every pair is a contiguous run
    const Run last = std::find_if(first, candidates.end(), [&](const auto& c) { return !same_pair(c, *first); });
    const Run end = thin_pair(first, last, {limits.spacing}, limits.most_of_pair);
    kept = kept == first ? end : std::move(first, end, kept);
    first = last;
  }
  candidates.erase(kept, candidates.end());
}

}  // namespace pliant
