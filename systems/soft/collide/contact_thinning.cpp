#include "systems/soft/collide/contact_thinning.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pliant {
namespace {

constexpr double kAlike = 0.9;       // [1] cosine between normals that push the same way
constexpr double kGrowth = 1.1;      // [1] of the spacing, where too many are left: regular meshes lose half in one go
constexpr double kSteady = 0.05;     // [edges] another must be deeper by so much to replace one of the last step
constexpr double kTouches = 0.1;     // [edges] what is nearer touches already, and its neighbours would sink in unheld:
constexpr double kDenseShare = 0.5;  // [1] such contacts stand so much nearer together than those that only may touch
constexpr double kWidest = 1e3;      // [1] spacings grow no further: by then one contact a direction is left

using Run = std::vector<Candidate>::iterator;

bool same_pair(const Candidate& x, const Candidate& y) {
  return x.body_low == y.body_low && x.body_high == y.body_high;
}

// How far apart contacts must be.
struct Spacing {
  double edges;        // [1] of the shorter of the two contacts' edges
  double least = 0.0;  // [m] anywhere
  void widen() { edges *= kGrowth, least *= kGrowth; }
  double between(const Candidate& a, const Candidate& b) const {
    const double edge = std::min(a.edge, b.edge);
    return std::max(edges * edge, std::max(a.gap, b.gap) < kTouches * edge ? kDenseShare * least : least);
  }
};

// Brings the candidates of [first, last) that are apart to the front, in their order; returns their end.
Run keep_apart(Run first, Run last, const Spacing& spacing) {
  Run kept = first;
  for (Run c = first; c != last; ++c) {
    const bool both_ways = c->body_low == c->body_high;  // a body that touches itself has no lower side
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

// One pair's candidates thinned to `most`: starting at a spacing at which some times that many fit side by side.
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
  for (Run first = candidates.begin(); first != candidates.end();) {  // sorted so, every pair is a run
    const Run last = std::find_if(first, candidates.end(), [&](const auto& c) { return !same_pair(c, *first); });
    const Run end = thin_pair(first, last, {limits.spacing}, limits.most_of_pair);
    kept = kept == first ? end : std::move(first, end, kept);
    first = last;
  }
  candidates.erase(kept, candidates.end());
}

}  // namespace pliant
