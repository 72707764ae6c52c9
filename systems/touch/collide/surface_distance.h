// Distance along the surface instead of the chord (Distance::kSurface; methods.md 1.3): correct where the surface folds
// within reach. Each vertex within reach gets its offset from the contact: a tangent vector. Its length is the distance
// along the surface, its direction that in which the shortest path arrives. The field is the same shape, evaluated at
// that offset instead of the chord.
//
// Two ways to the offsets, chosen by the place of the contact alone:
// - Where the surface is smooth, the arc over the chord c between two tangent planes (arc_offsets). A shortest path of
//   constant curvature and torsion is a helix. With a and b the chord's parts along the normals at its ends,
//   q = (2 a^2 + 2 b^2 - a b) / 5 from the cubic between the tangents, and w the square of the normals' difference,
//   arc^2 = c^2 + q (4 / w^2) (acos^2(1 - w / 2) - w) = c^2 + q (1/3 + 2 w / 45 + w^2 / 140 + 2 w^3 / 1575 + ...):
//   exact on planes, spheres and cylinders. arc_reach.h tells where that agrees with the march.
// - Elsewhere, marching (Kimmel & Sethian 1998) with the source unfolded into each triangle's plane, so that a flat
//   surface is exact. Two corners' distances are radii of circles that intersect at S, the source's image in the
//   triangle's plane. The third corner's distance is |v - S| if that line passes between the two corners.
#pragma once

#include <array>
#include <vector>

#include "components/mesh.h"
#include "systems/touch/model/field_kernels.h"

namespace pliant {

// The edge opposite to a corner of a triangle: its length, and the corner's place over it, from the next corner on. [m]
struct TriangleSide {
  float length, foot, height;
};
// Of each corner: 3 * triangle + corner.
std::vector<TriangleSide> sides_of(const Mesh& mesh);

// Data on a mesh for both ways; made at preparation.
struct SurfaceWays {
  std::vector<TriangleSide> sides;
  std::vector<float> arc_reach;     // [m] per vertex: arc_reach.h
  std::vector<std::uint32_t> hubs;  // per triangle: the one whose chart serves it, or kBorder
};
// Groups of small, nearly flat triangles.
std::vector<std::uint32_t> chart_hubs(const Mesh& mesh, double reach);

// Working memory of a march; nothing allocates after size().
struct MarchItem {
  float distance;
  std::uint32_t vertex;
  std::uint32_t triangle;  // one triangle at the vertex
};
struct March {
  std::vector<float> distance;         // [m] per vertex; kFar: not reached
  std::vector<vec2> image;             // [m] per reached vertex: unfolded into the plane of the start
  std::vector<std::uint32_t> from;     // per reached vertex: 3 * triangle + corner of its last arrival
  std::vector<std::uint32_t> reached;  // vertices, each once
  std::vector<MarchItem> heap;
  void size(const Mesh& mesh);
  void clear();
};

// A surface unfolded around a place in a triangle: where a vertex lies in the triangle's plane if the shortest path to
// it is made straight, and that plane's first axis carried along the path. Seen from another place near the start
// the vertex lies at the difference of the images.
struct alignas(32) ZoneChart {
  std::array<float, kZoneSize> ix, iy;  // [m] kFar: not reached
  std::array<float, kZoneSize> ex, ey, ez;
};
struct Chart {
  std::uint32_t triangle = kBorder;
  float reach = 0;                    // [m]
  vec3 origin{0}, x{1, 0, 0}, y{0};   // [m], [1] object frame
  std::vector<ZoneChart> zones;       // all
  std::vector<std::uint8_t> has;      // per zone: it has vertices
  std::vector<std::uint32_t> filled;  // those zones; capacity: all
  void size(const Mesh& mesh);
};

// Distances and images of the vertices nearer than `reach` to the chart's origin. The march must be clear.
void march_from(const Mesh& mesh, const std::vector<TriangleSide>& sides, const Chart& chart, float reach,
                March& march);
// The chart of a triangle around a place in it.
void march_chart(const Mesh& mesh, const std::vector<TriangleSide>& sides, std::uint32_t triangle, vec3 origin,
                 float reach, March& march, Chart& chart);
// Fills the offsets of a zone's vertices from a place in the chart's plane; kFar from the source's reach on.
void chart_offsets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, vec2 place, const Chart& chart,
                   Offsets& offset);
// Fills the offsets of a zone's vertices by the closed form; kFar where the normals differ by more than 75 degrees.
void arc_offsets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, Offsets& offset);
// One or the other, as the triangle and the reach demand. `zones`: within reach. True: the closed form.
bool fill_offsets(const Mesh& mesh, const SurfaceWays& ways, std::uint32_t triangle, const FieldSource& source,
                  const std::vector<std::uint32_t>& zones, March& march, Chart& chart, Offsets& offset);
void clear_offsets(const std::vector<std::uint32_t>& zones, Offsets& offset);

vec4 target_at_offset(const FieldSource& source, vec3 offset, vec3 normal);

}  // namespace pliant
