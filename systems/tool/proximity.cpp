// From skins to contacts: pairs of features that meet (meeting.h), which of them to believe, and how few are enough.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "runtime/assert.h"
#include "systems/tool/contact_geometry.h"
#include "systems/tool/contact_memory.h"
#include "systems/tool/contact_point.h"
#include "systems/tool/contact_thinning.h"
#include "systems/tool/skin.h"
#include "systems/tool/skin_pairs.h"

namespace pliant {
namespace {

constexpr double kSameSide = 0.5;   // [1] cosine: a normal that is still the one of the last step
constexpr double kOtherFace = 0.8;  // [1] cosine below which a vertex has a further contact (in a corner)
constexpr std::uint32_t kMostOfVertex = 3;
constexpr double kSlender = 2.0;  // [1] of a mean edge to the shortest one there: beyond, the shortest one counts
constexpr double kComing = 1e-3;  // [margins] in a step: slower, and it does not go into a sheet but lies in it
constexpr double kDeepestInMargins = 10.0;  // [1] no penetration is followed farther than this

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

bool boxes_meet(const Box& a, const Box& b, const RelativeSweep& sweep, float reach) {
  Box wide = b;
  wide.min -= vec3(reach);
  wide.max += vec3(reach);
  return sweep.meet(a, wide);
}

}  // namespace

struct Proximity::Parts {
  std::vector<Skin> skins;
  std::vector<double> mean_edge;  // [m] per body
  ContactMemory memory;
  SideMemory sides;  // of the last step
  Reach reach;
  double margin = 0.0;
  double deepest = 0.0;                   // [m] >= 0: penetration of the last step's contacts, as found
  std::vector<VertexMeeting> of_a, of_b;  // vertices of the pair's first body, of its second
  std::vector<Found> found;
  std::vector<Candidate> candidates;

  // --- Features of two triangles
  void try_vertex(const Side& a, std::uint32_t vertex, const Side& b, std::uint32_t triangle,
                  const RelativeSweep& sweep, std::vector<VertexMeeting>& out) const {
    if (dot(a.skin.vertex_normal(vertex), b.skin.normal(triangle)) > facing(a, vertex)) return;
    if (!boxes_meet(a.skin.vertex_box(vertex), b.skin.box(triangle), sweep, box_reach())) return;
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
    if (!boxes_meet(box_a, box_b, sweep, 2.0f * box_reach())) return;
    if (a.index == b.index && (a.skin.near(ea.from, eb.from) || a.skin.near(ea.from, eb.to) ||
                               a.skin.near(ea.to, eb.from) || a.skin.near(ea.to, eb.to)))
      return;
    const auto m = meet_edge(a.skin.edge(edge_a), a.skin.edge_shape(edge_a), b.skin.edge(edge_b),
                             b.skin.edge_shape(edge_b), reach);
    if (m) take_edges(a, edge_a, b, edge_b, *m);
  }

  void try_triangles(const Side& a, std::uint32_t s, const Side& b, std::uint32_t t, const RelativeSweep& sweep) {
    const unsigned of_s = a.skin.live(s), of_t = b.skin.live(t);
    const RelativeSweep back = sweep.reversed();
    for (int i = 0; i < 3; ++i) {
      if (of_s & 1u << i) try_vertex(a, a.skin.mesh().triangles[s][i], b, t, sweep, of_a);
      if (of_t & 1u << i) try_vertex(b, b.skin.mesh().triangles[t][i], a, s, back, a.index == b.index ? of_a : of_b);
    }
    if (of_s < 8u || of_t < 8u) return;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3 && (of_s & 8u << i); ++k)
        if (of_t & 8u << k) try_edges(a, a.skin.edge_of(s, i), b, b.skin.edge_of(t, k), sweep);
  }

  float box_reach() const { return static_cast<float>(0.5 * std::max(reach.front, reach.behind)); }

  // --- Which meetings to believe
  void take_edges(const Side& a, std::uint32_t edge_a, const Side& b, std::uint32_t edge_b, const Meeting& m) {
    const std::uint64_t key = edge_key(a.index, b.index, edge_a, edge_b);
    const ContactPoint* last = memory.find(key);
    const bool met = sides.find(key) != nullptr;
    if (m.gap < -margin && !met) return;  // edges deep below each other that never met: others hold those bodies
    if (a.sheet() && !meets_front(a.skin.edge_normal(edge_a), -m.normal, m, met)) return;
    if (b.sheet() && !meets_front(b.skin.edge_normal(edge_b), m.normal, m, met)) return;
    keep({a.index, b.index, true, edge_a, edge_b, m, last}, key, a.skin.point_on_edge(edge_a, m.along_a).position);
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
      if (!behind || (came && !known) || (came == known && m.meeting.gap > behind->meeting.gap)) behind = &m;
      known |= came;
    }
    if (!behind) return {};
    if (!known && (in_front < -behind->meeting.gap || !inside(a, b, *behind))) return {};
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

  void keep(const Found& f, std::uint64_t key, dvec3 position) {
    const Meeting& m = f.meeting;
    if (!std::isfinite(m.gap + m.end_gap + dot(m.normal, position)))
      return;  // a body that has blown up touches nothing
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

  FeaturePair pair_of(const Found& f) const {
    return {skins[f.body_a], skins[f.body_b], f.edges, f.feature_a, f.feature_b, f.meeting.normal};
  }

  ContactPoint contact_of(const std::vector<std::unique_ptr<Body>>& bodies, const Candidate& candidate) const {
    const Found& f = found[candidate.source];
    const Body &a = *bodies[f.body_a], &b = *bodies[f.body_b];
    const Skin &on_a = skins[f.body_a], &on_b = skins[f.body_b];
    ContactPoint c;
    c.body_a = f.body_a;
    c.body_b = f.body_b;
    c.a = f.edges ? on_a.point_on_edge(f.feature_a, f.meeting.along_a) : on_a.point_at_vertex(f.feature_a);
    c.b = f.edges ? on_b.point_on_edge(f.feature_b, f.meeting.along_b)
                  : on_b.point_on_triangle(f.feature_b, f.meeting.barycentric);
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
    if (c.foretold) find_turning(pair, c);
    return c;
  }

  // --- Bodies
  void find_between(const Side& a, const Side& b) {
    of_a.clear();
    of_b.clear();
    const RelativeSweep sweep(a.skin, b.skin);
    for_each_pair(a.skin, b.skin, [&](std::uint32_t s, std::uint32_t t) { try_triangles(a, s, b, t, sweep); });
    take_vertices(a, b, of_a);
    take_vertices(b, a, of_b);
  }
  void find_within(const Side& a) {
    of_a.clear();
    for_each_pair_within(a.skin, [&](std::uint32_t s, std::uint32_t t) { try_triangles(a, s, a, t, {}); });
    take_vertices(a, a, of_a);
  }
};

Proximity::Proximity(const std::vector<std::unique_ptr<Body>>& bodies) : parts_(std::make_unique<Parts>()) {
  for (const auto& body : bodies) {
    parts_->skins.emplace_back(*body);
    parts_->mean_edge.push_back(static_cast<double>(body->skin->mean_edge));
  }
}
Proximity::~Proximity() = default;

void Proximity::find(const std::vector<std::unique_ptr<Body>>& bodies, double T, double margin,
                     std::vector<ContactPoint>& out) {
  Parts& p = *parts_;
  ASSERT(bodies.size() == p.skins.size() && margin > 0.0);
  p.memory.take(out);
  p.margin = margin;
  p.reach = {margin, std::clamp(1.5 * p.deepest, margin, kDeepestInMargins * margin)};
  p.found.clear();
  p.candidates.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) p.skins[i].refit(*bodies[i], T, static_cast<double>(p.box_reach()));

  const auto side = [&](std::size_t i) { return Side{static_cast<std::uint32_t>(i), *bodies[i], p.skins[i]}; };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i]->self_collides) p.find_within(side(i));
    for (std::size_t k = i + 1; k < bodies.size(); ++k)
      if (bodies[i]->meets(*bodies[k])) p.find_between(side(i), side(k));
  }
  p.sides.clear();
  for (const Candidate& c : p.candidates) p.sides.add(c.key, p.found[c.source].meeting.normal);
  p.sides.sort();
  out.clear();
  thin_contacts(p.candidates, {});
  p.deepest = 0.0;
  for (const Candidate& c : p.candidates) {
    out.push_back(p.contact_of(bodies, c));
    p.deepest = std::max(p.deepest, out.back().depth);
  }
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
