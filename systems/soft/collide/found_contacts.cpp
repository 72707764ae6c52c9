#include "systems/soft/collide/found_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "systems/soft/collide/contact_on_arcs.h"

namespace pliant {
namespace {

constexpr double kSlender = 2.0;  // [1] mean edge over the shortest local one: beyond it, the shortest one counts

}  // namespace

double FoundContacts::keep(std::size_t first, bool late) {
  double deepest = 0.0;
  std::size_t kept = first;
  for (std::size_t i = first; i < found.size(); ++i) {
    const Found f = found[i];
    const Meeting& m = f.meeting;
    const dvec3 position = f.edges ? collision_meshes[f.body_a].point_on_edge(f.feature_a, m.along_a).position
                                   : collision_meshes[f.body_a].vertex(f.feature_a).x;
    if (!std::isfinite(m.gap + m.end_gap + dot(m.normal, position))) continue;
    deepest = std::max({deepest, -m.gap, late ? -m.end_gap : 0.0});
    Candidate c{std::min(f.body_a, f.body_b), std::max(f.body_a, f.body_b), position};
    c.normal = f.body_a <= f.body_b ? -m.normal : m.normal;
    c.gap = m.gap;
    c.end_gap = m.end_gap;
    c.edge = edge_there(f);
    c.known = f.last != nullptr;
    c.key = f.key;
    c.source = static_cast<std::uint32_t>(kept);
    candidates.push_back(c);
    found[kept++] = f;
  }
  found.resize(kept);
  return deepest;
}

void FoundContacts::keep_joined() {
  std::vector<std::uint64_t> kept;
  for (const Candidate& c : candidates) kept.push_back(c.key);
  std::sort(kept.begin(), kept.end());
  for (const Candidate& c : thinned) {
    const ContactPoint* last = found[c.source].last;
    if (!last || !last->joined || !(last->impulse.x > 0.0)) continue;
    if (!std::binary_search(kept.begin(), kept.end(), c.key)) candidates.push_back(c);
  }
}

// [m] The mean edges give the resolution of a collision mesh; those of a slender bar are longer than its width.
double FoundContacts::edge_there(const Found& f) const {
  const CollisionMesh &a = collision_meshes[f.body_a], &b = collision_meshes[f.body_b];
  const double shortest = f.edges ? std::min(a.shortest_at_edge(f.feature_a), b.shortest_at_edge(f.feature_b))
                                  : std::min(a.shortest_at_vertex(f.feature_a), b.shortest_of_triangle(f.feature_b));
  return std::min({mean_edge[f.body_a], mean_edge[f.body_b], kSlender * shortest});
}

std::pair<SurfacePoint, SurfacePoint> FoundContacts::points_of(const Found& f) const {
  const CollisionMesh &a = collision_meshes[f.body_a], &b = collision_meshes[f.body_b];
  if (f.edges)
    return {a.point_on_edge(f.feature_a, f.meeting.along_a), b.point_on_edge(f.feature_b, f.meeting.along_b)};
  return {a.point_at_vertex(f.feature_a), b.point_on_triangle(f.feature_b, f.meeting.barycentric)};
}

FeaturePair FoundContacts::pair_of(const Found& f) const {
  return {collision_meshes[f.body_a], collision_meshes[f.body_b], f.edges, f.feature_a, f.feature_b, f.meeting.normal};
}

ContactPoint FoundContacts::contact_of(const std::vector<std::unique_ptr<Body>>& bodies, const Candidate& candidate,
                                       bool late) const {
  const Found& f = found[candidate.source];
  const Body &a = *bodies[f.body_a], &b = *bodies[f.body_b];
  ContactPoint c;
  c.body_a = f.body_a;
  c.body_b = f.body_b;
  std::tie(c.a, c.b) = points_of(f);
  c.normal = f.meeting.normal;
  c.gap = f.meeting.gap;
  c.depth = std::max(0.0, -f.meeting.gap);
  const FeaturePair pair = pair_of(f);
  c.predicted = look_ahead(pair, c);
  if (c.predicted) place_on_arcs(pair, f.meeting.gap, c);
  c.source = candidate.source;
  c.key = candidate.key;
  // A probe has no friction coefficient: as on a yielding surface, the touched body's applies.
  const Body &first = a.kind == BodyKind::kProbe ? b : a, &second = b.kind == BodyKind::kProbe ? a : b;
  c.mu_static = std::sqrt(first.friction_static * second.friction_static);
  c.mu_sliding = std::sqrt(first.friction_sliding * second.friction_sliding);
  carry_over(f.last, c);
  c.joined = late || (f.last && f.last->joined && f.last->impulse.x > 0.0);
  if (c.predicted) find_turning(pair, c);
  return c;
}

double FoundContacts::end_gap(const Found& f) const {
  const auto displacement = [](const CollisionMesh& collision_mesh, const SurfacePoint& point) {
    const std::array<Moving, 3> corner = collision_mesh.triangle(point.triangle);
    return point.barycentric.x * corner[0].d + point.barycentric.y * corner[1].d + point.barycentric.z * corner[2].d;
  };
  const auto [a, b] = points_of(f);
  return f.meeting.gap + dot(f.meeting.normal,
                             displacement(collision_meshes[f.body_a], a) - displacement(collision_meshes[f.body_b], b));
}

}  // namespace pliant
