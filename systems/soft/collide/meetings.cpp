#include "systems/soft/collide/meetings.h"

#include <algorithm>

#include "systems/soft/collide/mesh_pairs.h"

namespace pliant {
namespace {

// [1] Largest dot product of the normals of a vertex and of the triangle that it touches. A sheet is touched from its
// front, at its border also from the side.
double facing(const MeetingSide& a, std::uint32_t vertex) {
  if (!a.sheet()) return kFacing;
  return a.collision_mesh.at_border(vertex) ? 0.0 : -kFacing;
}

struct MeetingSearch {
  Reach reach;
  Meetings& out;

  void try_vertex(const MeetingSide& a, std::uint32_t vertex, const MeetingSide& b, std::uint32_t triangle,
                  const RelativeSweep& sweep, std::vector<VertexMeeting>& of_vertices) const {
    const dvec3 towards = b.collision_mesh.normal(triangle), outward = a.collision_mesh.vertex_normal(vertex);
    if (dot(outward, towards) > facing(a, vertex) &&
        (!a.collision_mesh.turns() || !b.collision_mesh.closed() ||
         dot(a.collision_mesh.turn_ahead() * outward, towards) > facing(a, vertex)))
      return;
    if (!sweep.meet(a.collision_mesh.vertex_box(vertex), b.collision_mesh.box(triangle))) return;
    if (a.index == b.index) {
      const uvec3 c = b.collision_mesh.mesh().triangles[triangle];
      const MeshNeighbours& of = a.collision_mesh.neighbours();
      if (of.near(vertex, c.x) || of.near(vertex, c.y) || of.near(vertex, c.z)) return;
    }
    if (const auto m = meet_triangle(a.collision_mesh.vertex(vertex), b.collision_mesh.triangle(triangle), reach))
      of_vertices.push_back({vertex, triangle, *m});
  }

  void try_edges(const MeetingSide& a, std::uint32_t edge_a, const MeetingSide& b, std::uint32_t edge_b,
                 const RelativeSweep& sweep) {
    if (dot(a.collision_mesh.edge_normal(edge_a), b.collision_mesh.edge_normal(edge_b)) > kFacing) return;
    const CollisionEdge& ea = a.collision_mesh.edges()[edge_a];
    const CollisionEdge& eb = b.collision_mesh.edges()[edge_b];
    Box box_a = a.collision_mesh.vertex_box(ea.from), box_b = b.collision_mesh.vertex_box(eb.from);
    box_a.add(a.collision_mesh.vertex_box(ea.to));
    box_b.add(b.collision_mesh.vertex_box(eb.to));
    if (!sweep.meet(box_a, box_b)) return;
    if (a.index == b.index) {
      const MeshNeighbours& of = a.collision_mesh.neighbours();
      if (of.near(ea.from, eb.from) || of.near(ea.from, eb.to) || of.near(ea.to, eb.from) || of.near(ea.to, eb.to))
        return;
    }
    const auto m = meet_edge(a.collision_mesh.edge(edge_a), a.collision_mesh.edge_shape(edge_a),
                             b.collision_mesh.edge(edge_b), b.collision_mesh.edge_shape(edge_b), reach);
    if (m) out.edges.push_back({edge_a, edge_b, *m});
  }

  void try_triangles(const MeetingSide& a, std::uint32_t s, const MeetingSide& b, std::uint32_t t,
                     const RelativeSweep& sweep) {
    const unsigned of_s = a.collision_mesh.live(s), of_t = b.collision_mesh.live(t);
    const RelativeSweep back = sweep.reversed();
    for (int i = 0; i < 3; ++i) {
      if (of_s & 1u << i) try_vertex(a, a.collision_mesh.mesh().triangles[s][i], b, t, sweep, out.of_a);
      if (of_t & 1u << i)
        try_vertex(b, b.collision_mesh.mesh().triangles[t][i], a, s, back, a.index == b.index ? out.of_a : out.of_b);
    }
    // Of two edges one is live; the other must be too, unless a sharp one is pressed into a deformable mesh.
    const unsigned edges_s = of_s | a.collision_mesh.supple(s), edges_t = of_t | b.collision_mesh.supple(t);
    if (edges_s < 8u || edges_t < 8u || (of_s < 8u && of_t < 8u)) return;
    for (int i = 0; i < 3; ++i) {
      const unsigned bit_s = 8u << i;
      const unsigned others = of_s & bit_s
                                  ? of_t | (a.collision_mesh.sharp(s) & bit_s ? b.collision_mesh.supple(t) : 0u)
                                  : (a.collision_mesh.supple(s) & bit_s ? b.collision_mesh.sharp(t) : 0u);
      for (int k = 0; k < 3; ++k)
        if (others & 8u << k) try_edges(a, a.collision_mesh.edge_of(s, i), b, b.collision_mesh.edge_of(t, k), sweep);
    }
  }
};

}  // namespace

void find_meetings(const MeetingSide& a, const MeetingSide& b, const Reach& reach, float strayed, Meetings& out) {
  out.edges.clear(), out.of_a.clear(), out.of_b.clear();
  MeetingSearch search{reach, out};
  const auto box_reach = static_cast<float>(std::max(reach.front, reach.behind));
  if (a.index == b.index) {
    const RelativeSweep sweep(box_reach);
    const auto look = [&](std::uint32_t s, std::uint32_t t) { search.try_triangles(a, s, a, t, sweep); };
    return for_each_pair_within(a.collision_mesh, look, box_reach, strayed);
  }
  const RelativeSweep sweep(a.collision_mesh, b.collision_mesh, box_reach);
  const auto look = [&](std::uint32_t s, std::uint32_t t) { search.try_triangles(a, s, b, t, sweep); };
  for_each_pair(a.collision_mesh, b.collision_mesh, look, box_reach, strayed);
}

}  // namespace pliant
