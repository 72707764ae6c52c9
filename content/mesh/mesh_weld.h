// First half of mesh_build: one vertex per position, no degenerate or duplicate triangles, both along the Hilbert
// curve. Copies of a position share a key, so the sort that orders vertices also finds the copies. Triangles with the
// same corners share a centroid, so the sort that orders them also finds duplicates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "content/mesh/mesh_build.h"

namespace pliant {

inline constexpr std::uint32_t kNoVertex = 0xffffffffu;

// All primitives of a mesh in sequence, object frame. A "source" vertex or triangle is one of these.
struct Gathered {
  std::vector<vec3> position;               // [m] -0 is replaced by +0
  std::vector<uvec3> triangle;              // source vertices, winding already flipped where the frame mirrors
  std::vector<std::uint32_t> primitive;     // of each triangle
  std::vector<std::uint32_t> first_vertex;  // of each primitive, and one past the last
  std::vector<std::uint8_t> turned_normal;  // per vertex: the file's normal points inward; empty: none does
};
Result<Gathered> gather(const std::string& name, std::span<const Primitive> primitives, const mat4& to_object);

struct Welded {
  std::vector<vec3> position;                  // [m] touch vertices, Hilbert order
  std::vector<uvec3> triangle;                 // touch triangles, Hilbert order
  std::vector<std::uint32_t> source_triangle;  // of each touch triangle
  std::vector<std::uint32_t> backs;         // source triangles that are a touch triangle reversed: drawn, not touched
  std::vector<std::uint32_t> touch_vertex;  // of each source vertex, kNoVertex: not used
  std::vector<std::uint32_t> sources;       // used source vertices, by touch vertex, then by source
};
// `touched`: without walls at which parts are flush (flush_walls.h).
Welded weld(const Gathered& gathered, bool touched, MeshReport& report);

}  // namespace pliant
