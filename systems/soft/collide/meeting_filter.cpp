#include "systems/soft/collide/meeting_filter.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace pliant {
namespace {

constexpr double kSameMeetingSide = 0.5;  // [1] cosine: the normal is on the same side as in the last step
constexpr double kOtherFace = 0.8;        // [1] cosine below which a vertex has a further contact (in a corner)
constexpr std::uint32_t kMostOfVertex = 3;
constexpr double kAtOnce = 4.0;   // [margins] plus kDeepens times the last depth:
constexpr double kDeepens = 2.0;  // [1] largest penetration that can develop in one step
constexpr double kComing = 1e-3;  // [margins] in a step: a slower vertex rests in a sheet rather than entering it
constexpr double kGraze = 0.3;    // [margins] smaller crossings are left to the next step

// Used by every filter of a pair's meetings.
struct PairFilter {
  const PairView& pair;
  std::vector<Found>& out;

  // Whether a feature that is pushed along `push` by an edge of a sheet is in front of it.
  bool meets_front(dvec3 front, dvec3 push, const Meeting& m, bool met) const {
    const double along = dot(front, push);
    return along >= 0.0 && (m.gap >= 0.0 || met || (along > kFacing && enters(m)));
  }
  // A sheet has no inside. A feature behind it without history that moves in was placed there, or passed in beside
  // others; one that moves out came from behind.
  bool enters(const Meeting& m) const { return m.gap >= -pair.margin && m.end_gap < m.gap - kComing * pair.margin; }
};

// Contacts of the beginning of a step.
struct MeetingFilter : PairFilter {
  void take_edges(const MeetingSide& a, std::uint32_t edge_a, const MeetingSide& b, std::uint32_t edge_b,
                  const Meeting& m) {
    const std::uint64_t key = edge_key(a.index, b.index, edge_a, edge_b);
    const ContactPoint* last = pair.memory.find(key);
    const bool met = came_from(pair.sides.find(key), m);
    // Deep edges without an earlier contact: other contacts support those bodies.
    if (m.gap < -pair.margin && !met && !(began_inside() && leads_out(a, b, m))) return;
    if (a.sheet() && !meets_front(a.collision_mesh.edge_normal(edge_a), -m.normal, m, met)) return;
    if (b.sheet() && !meets_front(b.collision_mesh.edge_normal(edge_b), m.normal, m, met)) return;
    out.push_back({a.index, b.index, true, edge_a, edge_b, m, last, key});
  }

  // Whether the last step saw it on this side. A penetration cannot become deep at once: if it did, the feature went
  // around a corner, and is deep behind a face that it left.
  bool came_from(const KnownSide* side, const Meeting& m) const {
    if (!side || dot(side->normal, m.normal) <= kSameMeetingSide) return false;
    return -m.gap <= kAtOnce * pair.margin + kDeepens * std::max(0.0, -side->gap);
  }

  bool began_inside() const { return pair.way != dvec3(0.0); }
  bool leads_out(const MeetingSide& a, const MeetingSide& b, const Meeting& m) const {
    return dot(a.index < b.index ? pair.way : -pair.way, m.normal) > kSameMeetingSide;
  }

  // Meetings of every vertex of body a with body b. In front, a vertex touches every triangle that it meets. Behind, it
  // touches the one that it came from: on the side of the last step, or without one the nearest, if it really is
  // inside.
  void take_vertices(const MeetingSide& a, const MeetingSide& b, std::vector<VertexMeeting>& met) {
    std::sort(met.begin(), met.end(), [](const VertexMeeting& x, const VertexMeeting& y) {
      return x.vertex != y.vertex ? x.vertex < y.vertex : x.triangle < y.triangle;
    });
    for (auto first = met.begin(); first != met.end();) {
      const auto last = std::find_if(first, met.end(), [&](const auto& m) { return m.vertex != first->vertex; });
      take_vertex(a, b, {&*first, static_cast<std::size_t>(last - first)});
      first = last;
    }
  }

  void take_vertex(const MeetingSide& a, const MeetingSide& b, std::span<VertexMeeting> met) {
    const std::uint32_t vertex = met.front().vertex;
    std::array<const ContactPoint*, kMostOfVertex> past;
    for (std::uint32_t k = 0; k < kMostOfVertex; ++k)
      past[k] = pair.memory.find(vertex_key(a.index, b.index, vertex, k));
    const std::optional<VertexMeeting> behind = side_to_return_to(a, b, met);

    std::array<const VertexMeeting*, kMostOfVertex> kept{};
    std::uint32_t count = 0;
    if (behind) kept[count++] = &*behind;
    std::sort(met.begin(), met.end(), [](const VertexMeeting& x, const VertexMeeting& y) {
      return x.meeting.end_gap != y.meeting.end_gap ? x.meeting.end_gap < y.meeting.end_gap : x.triangle < y.triangle;
    });
    for (const VertexMeeting& m : met) {
      if (m.meeting.gap < 0.0 || count == kMostOfVertex) continue;
      if (behind && dot(behind->meeting.normal, m.meeting.normal) < 0.0) continue;  // far side of a thin body
      const bool alike = std::any_of(kept.begin(), kept.begin() + count, [&](const VertexMeeting* k) {
        return dot(k->meeting.normal, m.meeting.normal) > kOtherFace;
      });
      if (!alike) kept[count++] = &m;
    }

    // Each takes the past contact with the most similar normal; the others take the remaining ordinals.
    std::array<bool, kMostOfVertex> used{};
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint32_t best = kMostOfVertex;
      double alike = kSameMeetingSide;
      for (std::uint32_t k = 0; k < kMostOfVertex; ++k) {
        if (!past[k] || used[k] || dot(past[k]->normal, kept[i]->meeting.normal) <= alike) continue;
        alike = dot(past[k]->normal, kept[i]->meeting.normal);
        best = k;
      }
      const ContactPoint* last = best < kMostOfVertex ? past[best] : nullptr;
      if (!last) best = static_cast<std::uint32_t>(std::find(used.begin(), used.end(), false) - used.begin());
      used[best] = true;
      out.push_back({a.index, b.index, false, vertex, kept[i]->triangle, kept[i]->meeting, last,
                     vertex_key(a.index, b.index, vertex, best)});
    }
  }

  // Among the triangles that a vertex is behind: the one that it came from, else the nearest if it is inside.
  std::optional<VertexMeeting> side_to_return_to(const MeetingSide& a, const MeetingSide& b,
                                                 std::span<const VertexMeeting> met) const {
    std::array<const KnownSide*, kMostOfVertex> past;
    for (std::uint32_t k = 0; k < kMostOfVertex; ++k)
      past[k] = pair.sides.find(vertex_key(a.index, b.index, met.front().vertex, k));
    const VertexMeeting* behind = nullptr;
    bool known = false;
    double in_front = 1e300;
    for (const VertexMeeting& m : met) {
      if (m.meeting.gap >= 0.0) {
        in_front = std::min(in_front, m.meeting.gap);
        continue;
      }
      const bool came =
          std::any_of(past.begin(), past.end(), [&](const KnownSide* side) { return came_from(side, m.meeting); });
      if (!came && began_inside() && !leads_out(a, b, m.meeting)) continue;
      if (!behind || (came && !known) || (came == known && m.meeting.gap > behind->meeting.gap)) behind = &m;
      known |= came;
    }
    if (!behind) return {};
    if (!known && !began_inside() && (in_front < -behind->meeting.gap || !inside(a, b, *behind))) return {};
    return *behind;
  }

  bool inside(const MeetingSide& a, const MeetingSide& b, const VertexMeeting& m) const {
    const double depth = -m.meeting.gap;
    if (a.index == b.index) return depth <= pair.margin && in_front_at_rest(b.collision_mesh.mesh(), m);
    if ((a.sheet() || b.sheet()) && !enters(m.meeting)) return false;
    if (!b.collision_mesh.mesh().closed) return depth <= pair.margin;  // far behind it is outside
    return b.collision_mesh.contains(a.collision_mesh.vertex(m.vertex).x, pair.reach.behind);
  }
  // Through a thin part of a body, its far side looks like an entered surface.
  static bool in_front_at_rest(const Mesh& mesh, const VertexMeeting& m) {
    const uvec3 c = mesh.triangles[m.triangle];
    const vec3 n = cross(mesh.position(c.y) - mesh.position(c.x), mesh.position(c.z) - mesh.position(c.x));
    return dot(n, mesh.position(m.vertex) - mesh.position(c.x)) >= 0.0f;
  }
};

// Contacts that begin within a step.
struct MissedFilter : PairFilter {
  Crossings crossings{};

  bool crosses(const Meeting& m) const { return m.crosses && m.end_gap < -kGraze * pair.margin; }
  // An existing contact has a linear law: it may be satisfied while the surface curves away under it.
  bool slips(const Meeting& m) const { return m.crosses && m.end_gap < -pair.margin; }
  void count(const Meeting& m) { crossings.add({1, m.when}); }

  void take_edges(const MeetingSide& a, std::uint32_t edge_a, const MeetingSide& b, std::uint32_t edge_b,
                  const Meeting& m) {
    const std::uint64_t key = edge_key(a.index, b.index, edge_a, edge_b);
    if (!crosses(m)) return;
    if (pair.sides.find(key)) {
      if (slips(m)) count(m);
      return;
    }
    if (a.sheet() && !meets_front(a.collision_mesh.edge_normal(edge_a), -m.normal, m, false)) return;
    if (b.sheet() && !meets_front(b.collision_mesh.edge_normal(edge_b), m.normal, m, false)) return;
    count(m);
    out.push_back({a.index, b.index, true, edge_a, edge_b, m, pair.memory.find(key), key});
  }

  // The first triangle that a vertex crosses, under a free key, unless find() saw it on that side.
  void take_vertices(const MeetingSide& a, const MeetingSide& b, std::vector<VertexMeeting>& met) {
    std::sort(met.begin(), met.end(), [](const VertexMeeting& x, const VertexMeeting& y) {
      if (x.vertex != y.vertex) return x.vertex < y.vertex;
      return x.meeting.gap != y.meeting.gap ? x.meeting.gap < y.meeting.gap : x.triangle < y.triangle;
    });
    std::uint32_t done = kBorder;
    for (const VertexMeeting& m : met) {
      if (m.vertex == done || !crosses(m.meeting)) continue;
      const std::optional<std::uint64_t> key = free_key(a, b, m);
      if (!key && slips(m.meeting)) count(m.meeting);
      if (!key) continue;
      done = m.vertex;
      count(m.meeting);
      out.push_back({a.index, b.index, false, m.vertex, m.triangle, m.meeting, pair.memory.find(*key), *key});
    }
  }
  std::optional<std::uint64_t> free_key(const MeetingSide& a, const MeetingSide& b, const VertexMeeting& m) const {
    std::optional<std::uint64_t> free;
    for (std::uint32_t k = kMostOfVertex; k-- > 0;) {
      const std::uint64_t key = vertex_key(a.index, b.index, m.vertex, k);
      const KnownSide* side = pair.sides.find(key);
      if (side && dot(side->normal, m.meeting.normal) > kSameMeetingSide) return {};
      if (!side) free = key;
    }
    return free;
  }
};

}  // namespace

void take_contacts(const PairView& pair, const MeetingSide& a, const MeetingSide& b, Meetings& meetings,
                   std::vector<Found>& out) {
  MeetingFilter filter{{pair, out}};
  for (const EdgeMeeting& m : meetings.edges) filter.take_edges(a, m.edge_a, b, m.edge_b, m.meeting);
  filter.take_vertices(a, b, meetings.of_a);
  filter.take_vertices(b, a, meetings.of_b);
}

Crossings take_missed(const PairView& pair, const MeetingSide& a, const MeetingSide& b, Meetings& meetings,
                      std::vector<Found>& out) {
  MissedFilter filter{{pair, out}};
  for (const EdgeMeeting& m : meetings.edges) filter.take_edges(a, m.edge_a, b, m.edge_b, m.meeting);
  filter.take_vertices(a, b, meetings.of_a);
  filter.take_vertices(b, a, meetings.of_b);
  return filter.crossings;
}

}  // namespace pliant
