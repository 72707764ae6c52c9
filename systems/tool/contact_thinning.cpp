#include "systems/tool/contact_thinning.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pliant {
namespace {

constexpr double kAlike = 0.9;   // [1] cosine between normals that push the same way
constexpr double kWidest = 1e3;  // [1] spacings grow no further: by then one contact a direction is left

using Run = std::vector<Candidate>::iterator;

std::pair<std::uint32_t, std::uint32_t> pair_of(const Candidate& c) {
  return std::minmax(c.contact.body_a, c.contact.body_b);
}

// Normals of a pair count from the lower body to the higher, whoever is side a.
dvec3 common_normal(const ContactPoint& c) {
  return c.body_a <= c.body_b ? c.normal : -c.normal;
}

// Keeps the leading candidates of [first, last) that are `spacing` apart, in their order; returns their end.
Run keep_apart(Run first, Run last, double spacing) {
  Run kept = first;
  for (Run c = first; c != last; ++c) {
    const dvec3 at = c->contact.a.position, normal = common_normal(c->contact);
    const bool taken = std::any_of(first, kept, [&](const Candidate& k) {
      const dvec3 d = k.contact.a.position - at;
      if (dot(d, d) >= spacing * spacing) return false;
      const double alike = dot(common_normal(k.contact), normal);
      // A body that touches itself has no lower side.
      return c->contact.body_a == c->contact.body_b ? std::abs(alike) > kAlike : alike > kAlike;
    });
    if (taken) continue;
    if (kept != c) std::swap(*kept, *c);
    ++kept;
  }
  return kept;
}

}  // namespace

void thin_contacts(std::vector<Candidate>& candidates, const std::vector<double>& mean_edge,
                   const ThinningLimits& limits, std::vector<ContactPoint>& out) {
  const auto spacing_of = [&](const Candidate& c) {
    return limits.spacing * std::min(mean_edge[c.contact.body_a], mean_edge[c.contact.body_b]);
  };
  const auto rank = [&](const Candidate& c) { return c.end_gap - (c.known ? spacing_of(c) : 0.0); };
  std::sort(candidates.begin(), candidates.end(), [&](const Candidate& x, const Candidate& y) {
    return std::make_tuple(pair_of(x), rank(x), x.contact.key) < std::make_tuple(pair_of(y), rank(y), y.contact.key);
  });

  // Sorted by pair, every pair is a run. All spacings grow together until the total fits, too.
  for (double wider = 1.0; wider < kWidest; wider *= 1.5) {
    Run out_end = candidates.begin();
    for (Run first = candidates.begin(); first != candidates.end();) {
      const auto pair = pair_of(*first);
      const Run last = std::find_if(first, candidates.end(), [&](const Candidate& c) { return pair_of(c) != pair; });
      double spacing = wider * spacing_of(*first);
      Run end = keep_apart(first, last, spacing);
      for (double grown = 1.0; static_cast<std::size_t>(end - first) > limits.most_of_pair; grown *= 1.5) {
        if (grown > kWidest) end = first + static_cast<std::ptrdiff_t>(limits.most_of_pair);
        end = keep_apart(first, end, spacing * grown);
      }
      out_end = std::swap_ranges(first, end, out_end);
      first = last;
    }
    candidates.erase(out_end, candidates.end());
    if (candidates.size() <= limits.most) break;
  }
  if (candidates.size() > limits.most) candidates.resize(limits.most);
  for (Candidate& c : candidates) out.push_back(c.contact);
}

}  // namespace pliant
