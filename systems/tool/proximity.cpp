// From skins to contacts: pairs of features that meet (meeting.h), which of them to believe, and how few are enough.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

#include "runtime/assert.h"
#include "systems/tool/contact_geometry.h"
#include "systems/tool/contact_memory.h"
#include "systems/tool/contact_point.h"
#include "systems/tool/contact_thinning.h"
#include "systems/tool/shortest_way.h"
#include "systems/tool/skin.h"
#include "systems/tool/skin_pairs.h"
#include "systems/tool/yielding_body.h"

namespace pliant {
namespace {

constexpr double kSameSide = 0.5;   // [1] cosine: a normal that is still the one of the last step
constexpr double kOtherFace = 0.8;  // [1] cosine below which a vertex has a further contact (in a corner)
constexpr std::uint32_t kMostOfVertex = 3;
constexpr double kSlender = 2.0;  // [1] of a mean edge to the shortest one there: beyond, the shortest one counts
constexpr double kComing = 1e-3;  // [margins] in a step: slower, and it does not go into a sheet but lies in it
constexpr double kDeepestWithin = 10.0;  // [margins] no penetration of a body into itself is followed farther
constexpr double kDeeper = 1.5;
constexpr double kRises = 0.95;  // [1] of a penetration: what is left of it where it is being pushed out
constexpr double kGraze = 0.3;   // [margins] what crosses by less is left to the next step
constexpr double kSunk = 0.1;    // [margins] what thinning left out joins where it is deeper and stays so

// Tunables of the margin within which pairs are taken along although they are not about to touch.
constexpr double kMarginOfEdge = 0.1;   // [1] of a mean edge: less misses what the step's end brings together
constexpr double kMarginOfBody = 0.01;  // [1] of a body's diagonal, for meshes of few large triangles

// A vertex of one skin that meets a triangle of another (or of its own).
struct VertexMeeting {
  std::uint32_t vertex, triangle;
  Meeting meeting;
};

// A contact before it is known whether it is kept.
struct Found {
  std::uint32_t body_a, body_b;
  bool edges;  // else a vertex of a on a triangle of b
  std::uint32_t feature_a, feature_b;
  Meeting meeting;
  const ContactPoint* last;  // of the memory, or null
};

// [m] What cannot move has none of its own: a ground of two triangles says nothing of what lies on it.
double margin_of(const Body& body) {
  if (body.size() == 0) return std::numeric_limits<double>::infinity();
  const Mesh& mesh = *body.skin;
  return std::min(kMarginOfEdge * static_cast<double>(mesh.mean_edge),
                  kMarginOfBody * static_cast<double>(mesh.box.diagonal()));
}

struct Side {
  std::uint32_t index;  // of the body
  const Body& body;
  const Skin& skin;
  // A fixed surface that encloses nothing: it stops what comes from its front and lets pass what comes from behind.
  bool sheet() const { return body.size() == 0 && !skin.mesh().closed; }
};

// [1] What the normals of a vertex and of the triangle that it touches may have in common at most. A sheet is touched
// from its front, at its border from the side, too.
double facing(const Side& a, std::uint32_t vertex) {
  if (!a.sheet()) return kFacing;
  return a.skin.at_border(vertex) ? 0.0 : -kFacing;
}

// [m] By how much one of two boxes must move along an axis to leave the other; negative: how far they are apart. No
// penetration of what they hold is deeper, if it is left by the shortest way.
double overlap(const Box& a, const Box& b) {
  const vec3 by = glm::min(a.max - b.min, b.max - a.min);
  return static_cast<double>(std::min({by.x, by.y, by.z}));
}

}  // namespace

struct Proximity::Parts {
  std::vector<Skin> skins;
  std::vector<double> mean_edge, own_margin;  // [m] per body
  std::vector<bool> yields;                   // per body
  // [m] >= 0, per pair of bodies: the deepest penetration that the last step left; infinite before the first step.
  std::vector<double> deepest;
  // [1] per pair of bodies that began inside each other, until they are out: where the first of them is pushed.
  std::vector<dvec3> ways;
  ContactMemory memory;
  SideMemory sides;                       // of the last step
  std::optional<double> margin_given;     // of this step's find()
  std::vector<double> strayed;            // [m] per body: from where the free motion leads, at most
  bool late = false;                      // looking for what was missed
  double margin = 0.0;                    // [m] of the pair of bodies that is looked at
  Reach reach;                            // likewise
  double* deep = nullptr;                 // likewise: for the next step
  dvec3* way = nullptr;                   // likewise
  std::vector<VertexMeeting> of_a, of_b;  // vertices of the pair's first body, of its second
  std::vector<Found> found;
  std::vector<Candidate> candidates, thinned;  // those to be kept; all that there were before

  // --- Features of two triangles
  void try_vertex(const Side& a, std::uint32_t vertex, const Side& b, std::uint32_t triangle,
                  const RelativeSweep& sweep, std::vector<VertexMeeting>& out) const {
    if (dot(a.skin.vertex_normal(vertex), b.skin.normal(triangle)) > facing(a, vertex)) return;
    if (!sweep.meet(a.skin.vertex_box(vertex), b.skin.box(triangle))) return;
    if (a.index == b.index) {
      const uvec3 c = b.skin.mesh().triangles[triangle];
      if (a.skin.near(vertex, c.x) || a.skin.near(vertex, c.y) || a.skin.near(vertex, c.z)) return;
    }
    if (const auto m = meet_triangle(a.skin.vertex(vertex), b.skin.triangle(triangle), reach))
      out.push_back({vertex, triangle, *m});
  }

  void try_edges(const Side& a, std::uint32_t edge_a, const Side& b, std::uint32_t edge_b, const RelativeSweep& sweep) {
    if (dot(a.skin.edge_normal(edge_a), b.skin.edge_normal(edge_b)) > kFacing) return;
    const SkinEdge& ea = a.skin.edges()[edge_a];
    const SkinEdge& eb = b.skin.edges()[edge_b];
    Box box_a = a.skin.vertex_box(ea.from), box_b = b.skin.vertex_box(eb.from);
    box_a.add(a.skin.vertex_box(ea.to));
    box_b.add(b.skin.vertex_box(eb.to));
    if (!sweep.meet(box_a, box_b)) return;
    if (a.index == b.index && (a.skin.near(ea.from, eb.from) || a.skin.near(ea.from, eb.to) ||
                               a.skin.near(ea.to, eb.from) || a.skin.near(ea.to, eb.to)))
      return;
    const auto m = meet_edge(a.skin.edge(edge_a), a.skin.edge_shape(edge_a), b.skin.edge(edge_b),
                             b.skin.edge_shape(edge_b), reach);
    if (!m) return;
    if (late)
      take_missed_edges(a, edge_a, b, edge_b, *m);
    else
      take_edges(a, edge_a, b, edge_b, *m);
  }

  void try_triangles(const Side& a, std::uint32_t s, const Side& b, std::uint32_t t, const RelativeSweep& sweep) {
    const unsigned of_s = a.skin.live(s), of_t = b.skin.live(t);
    const RelativeSweep back = sweep.reversed();
    for (int i = 0; i < 3; ++i) {
      if (of_s & 1u << i) try_vertex(a, a.skin.mesh().triangles[s][i], b, t, sweep, of_a);
      if (of_t & 1u << i) try_vertex(b, b.skin.mesh().triangles[t][i], a, s, back, a.index == b.index ? of_a : of_b);
    }
    // Of two edges one that is live, the other too, unless a sharp one is pressed into something that bends.
    const unsigned edges_s = of_s | a.skin.supple(s), edges_t = of_t | b.skin.supple(t);
    if (edges_s < 8u || edges_t < 8u || (of_s < 8u && of_t < 8u)) return;
    for (int i = 0; i < 3; ++i) {
      const unsigned bit_s = 8u << i;
      const unsigned others = of_s & bit_s ? of_t | (a.skin.sharp(s) & bit_s ? b.skin.supple(t) : 0u)
                                           : (a.skin.supple(s) & bit_s ? b.skin.sharp(t) : 0u);
      for (int k = 0; k < 3; ++k)
        if (others & 8u << k) try_edges(a, a.skin.edge_of(s, i), b, b.skin.edge_of(t, k), sweep);
    }
  }

  float box_reach() const { return static_cast<float>(std::max(reach.front, reach.behind)); }

  // --- Which meetings to believe
  void take_edges(const Side& a, std::uint32_t edge_a, const Side& b, std::uint32_t edge_b, const Meeting& m) {
    const std::uint64_t key = edge_key(a.index, b.index, edge_a, edge_b);
    const ContactPoint* last = memory.find(key);
    const bool met = sides.find(key) != nullptr;
    // Edges deep below each other that never met: others hold those bodies.
    if (m.gap < -margin && !met && !(began_inside() && leads_out(a, b, m))) return;
    if (a.sheet() && !meets_front(a.skin.edge_normal(edge_a), -m.normal, m, met)) return;
    if (b.sheet() && !meets_front(b.skin.edge_normal(edge_b), m.normal, m, met)) return;
    keep({a.index, b.index, true, edge_a, edge_b, m, last}, key, a.skin.point_on_edge(edge_a, m.along_a).position);
  }

  bool began_inside() const { return *way != dvec3(0.0); }
  bool leads_out(const Side& a, const Side& b, const Meeting& m) const {
    return dot(a.index < b.index ? *way : -*way, m.normal) > kSameSide;
  }

  // Whether what meets an edge of a sheet, pushed along `push` by it, is in front of it.
  bool meets_front(dvec3 front, dvec3 push, const Meeting& m, bool met) const {
    const double along = dot(front, push);
    return along >= 0.0 && (m.gap >= 0.0 || met || (along > kFacing && enters(m)));
  }
  // A sheet has no inside. What shows behind it without a past and goes in was put there, or slipped in beside others;
  // what goes out came from behind.
  bool enters(const Meeting& m) const { return m.gap >= -margin && m.end_gap < m.gap - kComing * margin; }

  // Meetings of every vertex of body a with body b. In front, a vertex touches what it meets; behind, it touches what
  // it came from: the side of the last step, or, where there is none, the nearest if it really is inside.
  void take_vertices(const Side& a, const Side& b, std::vector<VertexMeeting>& met) {
    std::sort(met.begin(), met.end(), [](const VertexMeeting& x, const VertexMeeting& y) {
      return x.vertex != y.vertex ? x.vertex < y.vertex : x.triangle < y.triangle;
    });
    for (auto first = met.begin(); first != met.end();) {
      const auto last = std::find_if(first, met.end(), [&](const auto& m) { return m.vertex != first->vertex; });
      take_vertex(a, b, {first, last});
      first = last;
    }
  }

  void take_vertex(const Side& a, const Side& b, std::span<VertexMeeting> met) {
    const std::uint32_t vertex = met.front().vertex;
    std::array<const ContactPoint*, kMostOfVertex> past;
    for (std::uint32_t k = 0; k < kMostOfVertex; ++k) past[k] = memory.find(vertex_key(a.index, b.index, vertex, k));
    const std::optional<VertexMeeting> behind = side_to_return_to(a, b, met);

    std::array<const VertexMeeting*, kMostOfVertex> kept{};
    std::uint32_t count = 0;
    if (behind) kept[count++] = &*behind;
    std::sort(met.begin(), met.end(), [](const VertexMeeting& x, const VertexMeeting& y) {
      return x.meeting.end_gap != y.meeting.end_gap ? x.meeting.end_gap < y.meeting.end_gap : x.triangle < y.triangle;
    });
    for (const VertexMeeting& m : met) {
      if (m.meeting.gap < 0.0 || count == kMostOfVertex) continue;
      if (behind && dot(behind->meeting.normal, m.meeting.normal) < 0.0) continue;  // a thin body's far side
      const bool alike = std::any_of(kept.begin(), kept.begin() + count, [&](const VertexMeeting* k) {
        return dot(k->meeting.normal, m.meeting.normal) > kOtherFace;
      });
      if (!alike) kept[count++] = &m;
    }

    // Each takes on the past contact whose normal is the most alike; the others take the ordinals that are left.
    std::array<bool, kMostOfVertex> used{};
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint32_t best = kMostOfVertex;
      double alike = kSameSide;
      for (std::uint32_t k = 0; k < kMostOfVertex; ++k) {
        if (!past[k] || used[k] || dot(past[k]->normal, kept[i]->meeting.normal) <= alike) continue;
        alike = dot(past[k]->normal, kept[i]->meeting.normal);
        best = k;
      }
      const ContactPoint* last = best < kMostOfVertex ? past[best] : nullptr;
      if (!last) best = static_cast<std::uint32_t>(std::find(used.begin(), used.end(), false) - used.begin());
      used[best] = true;
      keep({a.index, b.index, false, vertex, kept[i]->triangle, kept[i]->meeting, last},
           vertex_key(a.index, b.index, vertex, best), a.skin.vertex(vertex).x);
    }
  }

  // Of the triangles that a vertex is behind: the one that it came from, else the nearest if it is inside.
  std::optional<VertexMeeting> side_to_return_to(const Side& a, const Side& b,
                                                 std::span<const VertexMeeting> met) const {
    std::array<const dvec3*, kMostOfVertex> past;
    for (std::uint32_t k = 0; k < kMostOfVertex; ++k)
      past[k] = sides.find(vertex_key(a.index, b.index, met.front().vertex, k));
    const VertexMeeting* behind = nullptr;
    bool known = false;
    double in_front = 1e300;
    for (const VertexMeeting& m : met) {
      if (m.meeting.gap >= 0.0) {
        in_front = std::min(in_front, m.meeting.gap);
        continue;
      }
      const bool came = std::any_of(past.begin(), past.end(), [&](const dvec3* normal) {
        return normal && dot(*normal, m.meeting.normal) > kSameSide;
      });
      if (!came && began_inside() && !leads_out(a, b, m.meeting)) continue;
      if (!behind || (came && !known) || (came == known && m.meeting.gap > behind->meeting.gap)) behind = &m;
      known |= came;
    }
    if (!behind) return {};
    if (!known && !began_inside() && (in_front < -behind->meeting.gap || !inside(a, b, *behind))) return {};
    return *behind;
  }

  bool inside(const Side& a, const Side& b, const VertexMeeting& m) const {
    const double depth = -m.meeting.gap;
    if (a.index == b.index) return depth <= margin && in_front_at_rest(b.skin.mesh(), m);
    if ((a.sheet() || b.sheet()) && !enters(m.meeting)) return false;
    if (!b.skin.mesh().closed) return depth <= margin;  // far behind it is the open
    return b.skin.contains(a.skin.vertex(m.vertex).x, reach.behind);
  }
  // Through a thin part of a body its own far side looks like something that was entered.
  static bool in_front_at_rest(const Mesh& mesh, const VertexMeeting& m) {
    const uvec3 c = mesh.triangles[m.triangle];
    const vec3 n = cross(mesh.position(c.y) - mesh.position(c.x), mesh.position(c.z) - mesh.position(c.x));
    return dot(n, mesh.position(m.vertex) - mesh.position(c.x)) >= 0.0f;
  }

  // --- What was missed
  bool crosses(const Meeting& m) const { return m.crosses && m.end_gap < -kGraze * margin; }

  void take_missed_edges(const Side& a, std::uint32_t edge_a, const Side& b, std::uint32_t edge_b, const Meeting& m) {
    const std::uint64_t key = edge_key(a.index, b.index, edge_a, edge_b);
    if (!crosses(m) || sides.find(key)) return;
    if (a.sheet() && !meets_front(a.skin.edge_normal(edge_a), -m.normal, m, false)) return;
    if (b.sheet() && !meets_front(b.skin.edge_normal(edge_b), m.normal, m, false)) return;
    keep({a.index, b.index, true, edge_a, edge_b, m, memory.find(key)}, key,
         a.skin.point_on_edge(edge_a, m.along_a).position);
  }

  // The first triangle that a vertex crosses, under a key that is still free, unless find() saw it on that side.
  void take_missed_vertices(const Side& a, const Side& b, std::vector<VertexMeeting>& met) {
    std::sort(met.begin(), met.end(), [](const VertexMeeting& x, const VertexMeeting& y) {
      if (x.vertex != y.vertex) return x.vertex < y.vertex;
      return x.meeting.gap != y.meeting.gap ? x.meeting.gap < y.meeting.gap : x.triangle < y.triangle;
    });
    std::uint32_t done = kBorder;
    for (const VertexMeeting& m : met) {
      if (m.vertex == done || !crosses(m.meeting)) continue;
      const std::optional<std::uint64_t> key = free_key(a, b, m);
      if (!key) continue;
      done = m.vertex;
      keep({a.index, b.index, false, m.vertex, m.triangle, m.meeting, memory.find(*key)}, *key,
           a.skin.vertex(m.vertex).x);
    }
  }
  std::optional<std::uint64_t> free_key(const Side& a, const Side& b, const VertexMeeting& m) const {
    std::optional<std::uint64_t> free;
    for (std::uint32_t k = kMostOfVertex; k-- > 0;) {
      const std::uint64_t key = vertex_key(a.index, b.index, m.vertex, k);
      const dvec3* normal = sides.find(key);
      if (normal && dot(*normal, m.meeting.normal) > kSameSide) return {};
      if (!normal) free = key;
    }
    return free;
  }

  void keep(const Found& f, std::uint64_t key, dvec3 position) {
    const Meeting& m = f.meeting;
    if (!std::isfinite(m.gap + m.end_gap + dot(m.normal, position)))
      return;  // a body that has blown up touches nothing
    *deep = std::max({*deep, -m.gap, late ? -m.end_gap : 0.0});
    Candidate c{std::min(f.body_a, f.body_b), std::max(f.body_a, f.body_b), position};
    c.normal = f.body_a <= f.body_b ? -m.normal : m.normal;
    c.gap = m.gap;
    c.end_gap = m.end_gap;
    c.edge = edge_there(f);
    c.known = f.last != nullptr;
    c.key = key;
    c.source = static_cast<std::uint32_t>(found.size());
    found.push_back(f);
    candidates.push_back(c);
  }

  // [m] The mean edges tell how finely a skin is meshed; those of a slender bar are longer than it is wide.
  double edge_there(const Found& f) const {
    const Skin &a = skins[f.body_a], &b = skins[f.body_b];
    const double shortest = f.edges ? std::min(a.shortest_at_edge(f.feature_a), b.shortest_at_edge(f.feature_b))
                                    : std::min(a.shortest_at_vertex(f.feature_a), b.shortest_of_triangle(f.feature_b));
    return std::min({mean_edge[f.body_a], mean_edge[f.body_b], kSlender * shortest});
  }

  std::pair<SurfacePoint, SurfacePoint> points_of(const Found& f) const {
    const Skin &a = skins[f.body_a], &b = skins[f.body_b];
    if (f.edges)
      return {a.point_on_edge(f.feature_a, f.meeting.along_a), b.point_on_edge(f.feature_b, f.meeting.along_b)};
    return {a.point_at_vertex(f.feature_a), b.point_on_triangle(f.feature_b, f.meeting.barycentric)};
  }

  FeaturePair pair_of(const Found& f) const {
    return {skins[f.body_a], skins[f.body_b], f.edges, f.feature_a, f.feature_b, f.meeting.normal};
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
    c.foretold = look_ahead(pair, c);
    c.source = candidate.source;
    c.key = candidate.key;
    // A probe has no friction of its own: as on a yielding surface, what it touches says how it grips.
    const Body &first = a.kind == BodyKind::kProbe ? b : a, &second = b.kind == BodyKind::kProbe ? a : b;
    c.mu_static = std::sqrt(first.friction_static * second.friction_static);
    c.mu_sliding = std::sqrt(first.friction_sliding * second.friction_sliding);
    carry_over(f.last, c);
    c.joined = late || (f.last && f.last->joined && f.last->impulse.x > 0.0);
    if (c.foretold) find_turning(pair, c);
    return c;
  }

  // --- Bodies
  // Pair i, k (i <= k) with the reach that it needs in this step.
  void look_at(std::uint32_t i, std::uint32_t k) {
    margin = margin_between(i, k);
    const std::size_t pair = i * skins.size() + k;
    deep = &deepest[pair], way = &ways[pair];
    double most = i == k ? kDeepestWithin * margin : overlap(skins[i].whole(), skins[k].whole()) + margin;
    if (!late && i != k && std::isinf(*deep) && most > margin) {
      *way = shortest_way(skins[i], skins[k]).value_or(dvec3(0.0));
      if (!began_inside()) most = std::min(most, kDeepestWithin * margin);
    }
    if (!late && *deep <= margin) *way = dvec3(0.0);
    reach = late ? Reach{0.0, 0.0} : Reach{margin, std::max(margin, std::min(kDeeper * *deep, most))};
    if (!late) *deep = 0.0;
  }

  // [m] What find() saw moving within a margin of where it does now it has not missed.
  float least_strayed() const { return late ? static_cast<float>(margin) : -1.0f; }

  void find_between(const Side& a, const Side& b) {
    of_a.clear();
    of_b.clear();
    const RelativeSweep sweep(a.skin, b.skin, box_reach());
    for_each_pair(
        a.skin, b.skin, [&](std::uint32_t s, std::uint32_t t) { try_triangles(a, s, b, t, sweep); }, box_reach(),
        least_strayed());
    if (late) return take_missed_vertices(a, b, of_a), take_missed_vertices(b, a, of_b);
    take_vertices(a, b, of_a);
    take_vertices(b, a, of_b);
  }
  void find_within(const Side& a) {
    of_a.clear();
    const RelativeSweep sweep(box_reach());
    for_each_pair_within(
        a.skin, [&](std::uint32_t s, std::uint32_t t) { try_triangles(a, s, a, t, sweep); }, box_reach(),
        least_strayed());
    if (late) return take_missed_vertices(a, a, of_a);
    take_vertices(a, a, of_a);
  }

  void find(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::optional<double> given,
            std::vector<ContactPoint>& out) {
    ASSERT(bodies.size() == skins.size());
    late = false;
    margin_given = given;
    memory.take(out);
    found.clear();
    candidates.clear();
    for (std::size_t i = 0; i < bodies.size(); ++i) skins[i].refit(*bodies[i], T, 0.0);
    const auto count = static_cast<std::uint32_t>(bodies.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      const Side a{i, *bodies[i], skins[i]};
      if (a.body.self_collides) look_at(i, i), find_within(a);
      for (std::uint32_t k = i + 1; k < count; ++k) {
        if (!bodies[i]->meets(*bodies[k])) continue;
        look_at(i, k);
        find_between(a, {k, *bodies[k], skins[k]});
      }
    }
    sides.clear();
    remember_sides();
    out.clear();
    thinned = candidates;
    thin_contacts(candidates, {});
    keep_joined();
    for (const Candidate& c : candidates) out.push_back(contact_of(bodies, c));
  }

  // What joined in an earlier step stays for as long as it pushes: the same contacts, warm, step after step.
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

  double margin_between(std::uint32_t i, std::uint32_t k) const {
    return margin_given ? *margin_given : std::min(own_margin[i], own_margin[k]);
  }

  void remember_sides() {
    for (const Candidate& c : candidates) sides.add(c.key, found[c.source].meeting.normal);
    sides.sort();
  }

  // [m] Where the contact will be at the step's end, by its normal and the motion that the skins were swept with.
  double end_gap(const Found& f) const {
    const auto displacement = [](const Skin& skin, const SurfacePoint& point) {
      const std::array<Moving, 3> corner = skin.triangle(point.triangle);
      return point.barycentric.x * corner[0].d + point.barycentric.y * corner[1].d + point.barycentric.z * corner[2].d;
    };
    const auto [a, b] = points_of(f);
    return f.meeting.gap + dot(f.meeting.normal, displacement(skins[f.body_a], a) - displacement(skins[f.body_b], b));
  }

  // Candidates that thinning left out although those that it kept do not hold them: they sink in.
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

  // Whether what the bodies do now may bring together what find() saw apart: not where they move as they did then, or
  // hardly relative to each other.
  bool may_miss(std::uint32_t i, std::uint32_t k) const {
    const double changed = i == k ? 2.0 * skins[i].strayed_apart() : skins[i].strayed() + skins[k].strayed();
    const double moved = length(skins[i].drift() - skins[k].drift()) + skins[i].spread() + skins[k].spread();
    return std::min(changed, moved) > margin;
  }

  std::size_t find_missed(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                          std::vector<ContactPoint>& contacts) {
    late = true;
    candidates.clear();
    std::vector<dvec3> velocity;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (bodies[i]->size() == 0) continue;
      bodies[i]->move_skin(velocity);
      skins[i].sweep(*bodies[i], velocity, T);
    }
    const auto count = static_cast<std::uint32_t>(bodies.size());
    const auto takes_part = [&](std::uint32_t i) { return bodies[i]->solvable() && !yields[i]; };
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!takes_part(i)) continue;
      const Side a{i, *bodies[i], skins[i]};
      look_at(i, i);
      if (a.body.self_collides && may_miss(i, i)) skins[i].fit_swept(), find_within(a);
      for (std::uint32_t k = i + 1; k < count; ++k) {
        if (!bodies[i]->meets(*bodies[k]) || !takes_part(k)) continue;
        look_at(i, k);
        if (!may_miss(i, k)) continue;
        skins[i].fit_swept(), skins[k].fit_swept();
        find_between(a, {k, *bodies[k], skins[k]});
      }
    }
    remember_sides();
    const std::vector<Candidate> crossing = candidates;
    take_sinking(contacts);
    thinned.insert(thinned.end(), crossing.begin(), crossing.end());
    const std::size_t missed = candidates.size();
    thin_contacts(candidates, {});
    for (const Candidate& c : candidates) contacts.push_back(contact_of(bodies, c));
    return missed;
  }
};

Proximity::Proximity(const std::vector<std::unique_ptr<Body>>& bodies) : parts_(std::make_unique<Parts>()) {
  for (const auto& body : bodies) {
    parts_->skins.emplace_back(*body);
    parts_->mean_edge.push_back(static_cast<double>(body->skin->mean_edge));
    parts_->own_margin.push_back(margin_of(*body));
    parts_->yields.push_back(dynamic_cast<const YieldingBody*>(body.get()) != nullptr);
  }
  parts_->ways.assign(bodies.size() * bodies.size(), dvec3(0.0));
  parts_->deepest.assign(bodies.size() * bodies.size(), std::numeric_limits<double>::infinity());
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

std::size_t Proximity::find_missed(const std::vector<std::unique_ptr<Body>>& bodies, double T,
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
    bodies[i]->move_skin(velocity);
    p.skins[i].foretell(velocity, T);
  }
  bool any = false;
  for (ContactPoint& contact : contacts) {
    contact.again = contact.foretold && pliant::look_again(p.pair_of(p.found[contact.source]), contact);
    any |= contact.again;
  }
  return any;
}

}  // namespace pliant
