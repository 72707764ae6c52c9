#include "systems/soft/collide/meetings.h"

#include <algorithm>

#include "systems/soft/collide/skin_pairs.h"

namespace pliant {
namespace {

// [1] What the normals of a vertex and of the triangle that it touches may have in common at most. A sheet is touched
// from its front, at its border from the side, too.
double facing(const Side& a, std::uint32_t vertex) {
  if (!a.sheet()) return kFacing;
  return a.skin.at_border(vertex) ? 0.0 : -kFacing;
}

struct MeetingSearch {
  Reach reach;
  Meetings& out;

  void try_vertex(const Side& a, std::uint32_t vertex, const Side& b, std::uint32_t triangle,
                  const RelativeSweep& sweep, std::vector<VertexMeeting>& of_vertices) const {
    if (dot(a.skin.vertex_normal(vertex), b.skin.normal(triangle)) > facing(a, vertex)) return;
    if (!sweep.meet(a.skin.vertex_box(vertex), b.skin.box(triangle))) return;
    if (a.index == b.index) {
      const uvec3 c = b.skin.mesh().triangles[triangle];
      const SkinNeighbours& of = a.skin.neighbours();
      if (of.near(vertex, c.x) || of.near(vertex, c.y) || of.near(vertex, c.z)) return;
    }
    if (const auto m = meet_triangle(a.skin.vertex(vertex), b.skin.triangle(triangle), reach))
      of_vertices.push_back({vertex, triangle, *m});
  }

  void try_edges(const Side& a, std::uint32_t edge_a, const Side& b, std::uint32_t edge_b, const RelativeSweep& sweep) {
    if (dot(a.skin.edge_normal(edge_a), b.skin.edge_normal(edge_b)) > kFacing) return;
    const SkinEdge& ea = a.skin.edges()[edge_a];
    const SkinEdge& eb = b.skin.edges()[edge_b];
    Box box_a = a.skin.vertex_box(ea.from), box_b = b.skin.vertex_box(eb.from);
    box_a.add(a.skin.vertex_box(ea.to));
    box_b.add(b.skin.vertex_box(eb.to));
    if (!sweep.meet(box_a, box_b)) return;
    if (a.index == b.index) {
      const SkinNeighbours& of = a.skin.neighbours();
      if (of.near(ea.from, eb.from) || of.near(ea.from, eb.to) || of.near(ea.to, eb.from) || of.near(ea.to, eb.to))
        return;
    }
    const auto m = meet_edge(a.skin.edge(edge_a), a.skin.edge_shape(edge_a), b.skin.edge(edge_b),
                             b.skin.edge_shape(edge_b), reach);
    if (m) out.edges.push_back({edge_a, edge_b, *m});
  }

  void try_triangles(const Side& a, std::uint32_t s, const Side& b, std::uint32_t t, const RelativeSweep& sweep) {
    const unsigned of_s = a.skin.live(s), of_t = b.skin.live(t);
    const RelativeSweep back = sweep.reversed();
    for (int i = 0; i < 3; ++i) {
      if (of_s & 1u << i) try_vertex(a, a.skin.mesh().triangles[s][i], b, t, sweep, out.of_a);
      if (of_t & 1u << i)
        try_vertex(b, b.skin.mesh().triangles[t][i], a, s, back, a.index == b.index ? out.of_a : out.of_b);
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
};

}  // namespace

void find_meetings(const Side& a, const Side& b, const Reach& reach, float strayed, Meetings& out) {
  out.edges.clear(), out.of_a.clear(), out.of_b.clear();
  MeetingSearch search{reach, out};
  const auto box_reach = static_cast<float>(std::max(reach.front, reach.behind));
  if (a.index == b.index) {
    const RelativeSweep sweep(box_reach);
    const auto look = [&](std::uint32_t s, std::uint32_t t) { search.try_triangles(a, s, a, t, sweep); };
    return for_each_pair_within(a.skin, look, box_reach, strayed);
  }
  const RelativeSweep sweep(a.skin, b.skin, box_reach);
  const auto look = [&](std::uint32_t s, std::uint32_t t) { search.try_triangles(a, s, b, t, sweep); };
  for_each_pair(a.skin, b.skin, look, box_reach, strayed);
}

}  // namespace pliant
