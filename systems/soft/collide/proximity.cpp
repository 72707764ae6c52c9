// From collision meshes to contacts: the features that meet (meetings.h), the contacts among them (meeting_filter.h),
// and their reduction (contact_thinning.h); pair by pair over all bodies. All body boxes are compared, n^2 / 2 tests:
// for hundreds of bodies, not for thousands.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "runtime/assert.h"
#include "systems/soft/body/yielding_body.h"
#include "systems/soft/collide/contact_geometry.h"
#include "systems/soft/collide/contact_thinning.h"
#include "systems/soft/collide/meeting_filter.h"
#include "systems/soft/collide/shortest_way.h"
#include "systems/soft/contact/contact_point.h"

namespace pliant {
namespace {

constexpr double kSlender = 2.0;  // [1] mean edge over the shortest local one: beyond it, the shortest one counts
constexpr double kDeepestWithin = 10.0;  // [margins] largest self-penetration that is tracked
constexpr double kDeeper = 1.5;
constexpr double kRises = 0.95;  // [1] of a penetration: remainder while it is being corrected
constexpr double kSunk = 0.1;    // [margins] contacts dropped by thinning are added if deeper than this and lasting

// Tunables of the margin within which pairs are included although they do not touch yet.
constexpr double kMarginOfEdge = 0.1;   // [1] of a mean edge: less misses contacts that begin within the step
constexpr double kMarginOfBody = 0.01;  // [1] of a body's diagonal, for meshes of few large triangles

// [m] An immovable body has no margin: a ground of two triangles has no relation to the objects on it.
double margin_of(const Body& body) {
  if (body.size() == 0) return std::numeric_limits<double>::infinity();
  const Mesh& mesh = *body.collision_mesh;
  return std::min(kMarginOfEdge * static_cast<double>(mesh.mean_edge),
                  kMarginOfBody * static_cast<double>(mesh.box.diagonal()));
}

// [m] Distance by which one of two boxes must move along an axis to leave the other; negative: their separation. It
// bounds the penetration of their contents along the shortest way.
double overlap(const Box& a, const Box& b) {
  const vec3 by = glm::min(a.max - b.min, b.max - a.min);
  return static_cast<double>(std::min({by.x, by.y, by.z}));
}

// State that a step leaves for two interpenetrating bodies.
struct PairPast {
  double deepest = 0.0;  // [m] >= 0
  dvec3 way{0};          // PairView::way
};

std::uint64_t pair_key(std::uint32_t i, std::uint32_t k) {
  return std::uint64_t{i} << 32 | k;
}

}  // namespace

struct Proximity::Parts {
  std::vector<CollisionMesh> collision_meshes;
  std::vector<double> mean_edge, own_margin;   // [m] per body
  std::vector<bool> yields;                    // per body
  std::vector<bool> seen;                      // per body: an earlier step included it
  std::map<std::uint64_t, PairPast> touching;  // pairs that interpenetrate
  ContactMemory memory;
  SideMemory sides;                    // of the last step
  std::optional<double> margin_given;  // in this step's find()
  bool late = false;                   // searching for missed contacts
  Crossings crossings;                 // of the missed contacts
  Meetings meetings;                   // of the current pair of bodies
  std::vector<Found> found;
  std::vector<Candidate> candidates, thinned;  // those to keep; all before thinning

  // Adds the contacts appended by find_between(); contacts with NaN are dropped (a body has diverged).
  void keep(std::size_t first, PairPast& past) {
    std::size_t kept = first;
    for (std::size_t i = first; i < found.size(); ++i) {
      const Found f = found[i];
      const Meeting& m = f.meeting;
      const dvec3 position = f.edges ? collision_meshes[f.body_a].point_on_edge(f.feature_a, m.along_a).position
                                     : collision_meshes[f.body_a].vertex(f.feature_a).x;
      if (!std::isfinite(m.gap + m.end_gap + dot(m.normal, position))) continue;
      past.deepest = std::max({past.deepest, -m.gap, late ? -m.end_gap : 0.0});
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
  }

  // [m] The mean edges give the resolution of a collision mesh; those of a slender bar are longer than its width.
  double edge_there(const Found& f) const {
    const CollisionMesh &a = collision_meshes[f.body_a], &b = collision_meshes[f.body_b];
    const double shortest = f.edges ? std::min(a.shortest_at_edge(f.feature_a), b.shortest_at_edge(f.feature_b))
                                    : std::min(a.shortest_at_vertex(f.feature_a), b.shortest_of_triangle(f.feature_b));
    return std::min({mean_edge[f.body_a], mean_edge[f.body_b], kSlender * shortest});
  }

  std::pair<SurfacePoint, SurfacePoint> points_of(const Found& f) const {
    const CollisionMesh &a = collision_meshes[f.body_a], &b = collision_meshes[f.body_b];
    if (f.edges)
      return {a.point_on_edge(f.feature_a, f.meeting.along_a), b.point_on_edge(f.feature_b, f.meeting.along_b)};
    return {a.point_at_vertex(f.feature_a), b.point_on_triangle(f.feature_b, f.meeting.barycentric)};
  }

  FeaturePair pair_of(const Found& f) const {
    return {
        collision_meshes[f.body_a], collision_meshes[f.body_b], f.edges, f.feature_a, f.feature_b, f.meeting.normal};
  }

  ContactPoint contact_of(const std::vector<std::unique_ptr<Body>>& bodies, const Candidate& candidate) const {
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

  // --- Bodies
  // Search parameters of pair i, k (i <= k) in this step, from the last step's state.
  PairView view_of(std::uint32_t i, std::uint32_t k, const PairPast& past) const {
    PairView pair{margin_between(i, k), {0.0, 0.0}, past.way, memory, sides};
    if (late) return pair;
    const double margin = pair.margin;
    double most =
        i == k ? kDeepestWithin * margin : overlap(collision_meshes[i].whole(), collision_meshes[k].whole()) + margin;
    if (i != k && std::isinf(past.deepest) && most > margin) {
      pair.way = shortest_way(collision_meshes[i], collision_meshes[k]).value_or(dvec3(0.0));
      if (pair.way == dvec3(0.0)) most = std::min(most, kDeepestWithin * margin);
    }
    if (past.deepest <= margin) pair.way = dvec3(0.0);
    pair.reach = {margin, std::max(margin, std::min(kDeeper * past.deepest, most))};
    return pair;
  }

  void find_between(const std::vector<std::unique_ptr<Body>>& bodies, std::uint32_t i, std::uint32_t k) {
    const auto known = touching.find(pair_key(i, k));
    PairPast past = known != touching.end() ? known->second : PairPast{};
    if (!late && !(seen[i] && seen[k])) past.deepest = std::numeric_limits<double>::infinity();
    const PairView pair = view_of(i, k, past);
    const MeetingSide a{i, *bodies[i], collision_meshes[i]}, b{k, *bodies[k], collision_meshes[k]};
    const std::size_t first = found.size();
    // Features whose motion find() saw within a margin of the current one were not missed.
    find_meetings(a, b, pair.reach, late ? static_cast<float>(pair.margin) : -1.0f, meetings);
    if (late)
      crossings.add(take_missed(pair, a, b, meetings, found));
    else
      take_contacts(pair, a, b, meetings, found);
    if (!late) past = {0.0, pair.way};
    keep(first, past);
    if (past.deepest > 0.0 || past.way != dvec3(0.0))
      touching[pair_key(i, k)] = past;
    else if (known != touching.end())
      touching.erase(known);
  }

  void find(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::optional<double> given,
            std::vector<ContactPoint>& out) {
    ASSERT(bodies.size() == collision_meshes.size());
    late = false;
    margin_given = given;
    memory.take(out);
    found.clear();
    candidates.clear();
    for (std::size_t i = 0; i < bodies.size(); ++i) collision_meshes[i].refit(*bodies[i], T, 0.0);
    const auto count = static_cast<std::uint32_t>(bodies.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      if (bodies[i]->self_collides && !bodies[i]->taken_out) find_between(bodies, i, i);
      for (std::uint32_t k = i + 1; k < count; ++k)
        if (bodies[i]->meets(*bodies[k])) find_between(bodies, i, k);
    }
    for (std::uint32_t i = 0; i < count; ++i) seen[i] = seen[i] || !(bodies[i]->absent || bodies[i]->taken_out);
    sides.clear();
    remember_sides();
    out.clear();
    thinned = candidates;
    thin_contacts(candidates, {});
    keep_joined();
    for (const Candidate& c : candidates) out.push_back(contact_of(bodies, c));
  }

  // A contact that joined in an earlier step stays while it carries load: the same contacts, warm-started, step after
  // step.
  void keep_joined() {
    std::vector<std::uint64_t> kept;
    for (const Candidate& c : candidates) kept.push_back(c.key);
    std::sort(kept.begin(), kept.end());
    for (const Candidate& c : thinned) {
      const ContactPoint* last = found[c.source].last;
      if (!last || !last->joined || !(last->impulse.x > 0.0)) continue;
      if (!std::binary_search(kept.begin(), kept.end(), c.key)) candidates.push_back(c);
    }
  }

  void forget(std::uint32_t body) {
    seen[body] = false;
    sides.forget(body);
    std::erase_if(touching, [&](const auto& pair) {
      return static_cast<std::uint32_t>(pair.first >> 32) == body || static_cast<std::uint32_t>(pair.first) == body;
    });
  }

  double margin_between(std::uint32_t i, std::uint32_t k) const {
    return margin_given ? *margin_given : std::min(own_margin[i], own_margin[k]);
  }

  void remember_sides() {
    for (const Candidate& c : candidates)
      sides.add({c.key, found[c.source].meeting.normal, found[c.source].meeting.gap, c.body_low, c.body_high});
    sides.sort();
  }

  // [m] Gap at the end of the step, by the contact's normal and the displacements of the collision meshes' sweep.
  double end_gap(const Found& f) const {
    const auto displacement = [](const CollisionMesh& collision_mesh, const SurfacePoint& point) {
      const std::array<Moving, 3> corner = collision_mesh.triangle(point.triangle);
      return point.barycentric.x * corner[0].d + point.barycentric.y * corner[1].d + point.barycentric.z * corner[2].d;
    };
    const auto [a, b] = points_of(f);
    return f.meeting.gap + dot(f.meeting.normal, displacement(collision_meshes[f.body_a], a) -
                                                     displacement(collision_meshes[f.body_b], b));
  }

  // Adds candidates that thinning dropped although the kept ones do not support them: they sink in.
  void take_sinking(const std::vector<ContactPoint>& contacts) {
    std::vector<std::uint64_t> kept;
    for (const ContactPoint& c : contacts) kept.push_back(c.key);
    std::sort(kept.begin(), kept.end());
    for (const Candidate& c : thinned) {
      if (std::binary_search(kept.begin(), kept.end(), c.key) || yields[c.body_low] || yields[c.body_high]) continue;
      const double end = end_gap(found[c.source]), sunk = kSunk * margin_between(c.body_low, c.body_high);
      if (!(end < std::min(-sunk, kRises * c.gap))) continue;
      candidates.push_back(c);
      candidates.back().end_gap = end;
    }
  }

  // Whether the bodies' current motion may cause contacts that find() did not see: not if it is the same motion, or
  // hardly relative.
  bool may_miss(std::uint32_t i, std::uint32_t k) const {
    const double changed = i == k ? 2.0 * collision_meshes[i].strayed_apart()
                                  : collision_meshes[i].strayed() + collision_meshes[k].strayed();
    const double moved = length(collision_meshes[i].drift() - collision_meshes[k].drift()) +
                         collision_meshes[i].spread() + collision_meshes[k].spread();
    return std::min(changed, moved) > margin_between(i, k);
  }

  Crossings find_missed(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                        std::vector<ContactPoint>& contacts) {
    late = true;
    crossings = {};
    candidates.clear();
    std::vector<dvec3> velocity;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i]->size() == 0) continue;
      bodies[i]->move_surface(velocity);
      collision_meshes[i].sweep(*bodies[i], velocity, T);
    }
    const auto count = static_cast<std::uint32_t>(bodies.size());
    const auto takes_part = [&](std::uint32_t i) { return bodies[i]->solvable() && !yields[i]; };
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!takes_part(i)) continue;
      if (bodies[i]->self_collides && !bodies[i]->taken_out && may_miss(i, i))
        collision_meshes[i].fit_swept(), find_between(bodies, i, i);
      for (std::uint32_t k = i + 1; k < count; ++k) {
        if (!bodies[i]->meets(*bodies[k]) || !takes_part(k) || !may_miss(i, k)) continue;
        collision_meshes[i].fit_swept(), collision_meshes[k].fit_swept();
        find_between(bodies, i, k);
      }
    }
    remember_sides();
    const std::vector<Candidate> crossing = candidates;
    take_sinking(contacts);
    thinned.insert(thinned.end(), crossing.begin(), crossing.end());
    thin_contacts(candidates, {});
    for (const Candidate& c : candidates) contacts.push_back(contact_of(bodies, c));
    return crossings;
  }
};

void Proximity::forget(std::uint32_t body) {
  parts_->forget(body);
}

Proximity::Proximity(const std::vector<std::unique_ptr<Body>>& bodies) : parts_(std::make_unique<Parts>()) {
  for (const auto& body : bodies) {
    parts_->collision_meshes.emplace_back(*body);
    parts_->mean_edge.push_back(static_cast<double>(body->collision_mesh->mean_edge));
    parts_->own_margin.push_back(margin_of(*body));
    parts_->yields.push_back(body->is_surface());
  }
  parts_->seen.assign(bodies.size(), false);
}
Proximity::~Proximity() = default;

void Proximity::find(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& out) {
  parts_->find(bodies, T, {}, out);
}

void Proximity::find(const std::vector<std::unique_ptr<Body>>& bodies, double T, double margin,
                     std::vector<ContactPoint>& out) {
  ASSERT(margin > 0.0);
  parts_->find(bodies, T, margin, out);
}

Crossings Proximity::find_missed(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                                 std::vector<ContactPoint>& contacts) {
  return parts_->find_missed(bodies, T, contacts);
}

bool Proximity::look_again(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                           std::vector<ContactPoint>& contacts) {
  if (contacts.empty()) return false;
  Parts& p = *parts_;
  std::vector<dvec3> velocity;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i]->size() == 0) continue;
    bodies[i]->move_surface(velocity);
    p.collision_meshes[i].predict(velocity, T);
  }
  bool any = false;
  for (ContactPoint& contact : contacts) {
    contact.again = contact.predicted && pliant::look_again(p.pair_of(p.found[contact.source]), contact);
    any |= contact.again;
  }
  return any;
}

}  // namespace pliant
