// The surface to paint: a level's mesh, welded, with its creases, its triangle tree and the file vertices of each
// welded vertex. Built once per mesh, on any thread; immutable; used by every stroke.
//
// Surface frame: the mesh frame with the node's linear part applied, so that lengths are world lengths [m].
#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "components/mesh.h"
#include "content/level/level.h"
#include "content/mesh/mesh_surface.h"
#include "content/mesh/mesh_weld.h"
#include "runtime/result.h"

namespace pliant {

// A vertex of the file.
struct SourceVertex {
  std::uint32_t primitive, index;
  friend bool operator==(const SourceVertex&, const SourceVertex&) = default;
};

// A triangle of the file: its corners are index[3 * triangle ...] of the primitive.
struct SourceTriangle {
  std::uint32_t primitive, triangle;
};

// A point on the surface.
struct SurfaceHit {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t triangle = kNone;  // of PaintSurface::mesh()
  SourceTriangle source{kNone, kNone};
  dvec3 barycentric{1, 0, 0};  // [1] of the corners of mesh().triangles[triangle]
  dvec3 point{0};              // [m] surface frame
  dvec3 normal{0, 1, 0};       // [1] of the flat triangle: unit, outward
  bool back = false;           // seen from behind

  bool valid() const { return triangle != kNone; }
};

struct Ray {
  dvec3 origin{0};            // [m] surface frame
  dvec3 direction{0, 0, -1};  // of any length but 0
};

// Where painting stops. Paint never crosses a gap or the interior, whatever the mask.
struct PaintMask {
  bool creases = false;    // at creases
  bool primitive = false;  // at the border of the primitive; a stroke stays on its first one
  bool part = false;       // a stroke stays on its first connected part
};

struct ReachedVertex {
  std::uint32_t vertex;  // of PaintSurface::mesh()
  std::uint32_t node;    // of the topology that the mask asks for (PaintSurface::neighbours)
  float distance;        // [m] along the surface
};

// Working memory for marching. One per thread; for any surface.
class MarchWork {
  friend class PaintSurface;
  struct Item {
    float distance;  // [m]
    std::uint32_t node;
  };
  std::vector<float> distance_;         // [m] by node; infinity between calls
  std::vector<std::uint32_t> touched_;  // nodes with a distance
  std::vector<Item> heap_;
};

class PaintSurface {
 public:
  // `frame` is the linear part of the node's world matrix, or only its scale. Errors: those of build_mesh, and a
  // degenerate `frame`. Once `stop` is set it soon returns an error, which can be ignored.
  static Result<PaintSurface> make(const LevelMesh& mesh, const dmat3& frame, const std::atomic<bool>* stop = nullptr);

  const Mesh& mesh() const { return mesh_; }  // surface frame; without zones and painted factors
  const dmat3& frame() const { return frame_; }
  const MeshReport& report() const { return report_; }

  // The nearest front face along the ray, as drawn; if there is none, the nearest back face. `both_sides`: the nearest
  // face, as for a double-sided material. Invalid: no hit.
  SurfaceHit hit(const Ray& ray, bool both_sides = false) const;
  // The closest point at most `within` [m] away; invalid if there is none.
  SurfaceHit closest(dvec3 point, double within) const;

  // Welded vertices at most `radius` [m] from the hit along the surface, each once, roughly nearest first. Uses
  // `creases` and `primitive` of the mask.
  std::vector<ReachedVertex> footprint(const SurfaceHit& hit, double radius, const PaintMask& mask,
                                       MarchWork& work) const;
  // Triangles within reach of the hit: at least partly within `radius` in space, and connected to it along the surface.
  // Ascending.
  std::vector<std::uint32_t> triangles_under(const SurfaceHit& hit, double radius, MarchWork& work) const;

  // Welded vertices of all triangles connected to the hit's; ascending. Uses `creases` and `primitive` of the mask.
  std::vector<std::uint32_t> connected(const SurfaceHit& hit, const PaintMask& mask = {}) const;
  // Welded vertices of a primitive's triangles; ascending.
  std::vector<std::uint32_t> of_primitive(std::uint32_t primitive) const;
  // Welded vertices in a box (surface frame); if there are none, the nearest one. Ascending.
  std::vector<std::uint32_t> in_box(const Box& box) const;

  // File vertices of a welded vertex. A seam has several; painting applies to all.
  std::span<const SourceVertex> sources(std::uint32_t vertex) const {
    return {sources_.data() + source_first_[vertex], sources_.data() + source_first_[vertex + 1]};
  }
  // Empty: no touched triangle uses it.
  std::optional<std::uint32_t> welded(SourceVertex source) const;

  std::size_t primitive_count() const { return first_vertex_.size() - 1; }
  std::size_t vertices_of(std::uint32_t primitive) const {
    return first_vertex_[primitive + 1] - first_vertex_[primitive];
  }
  SourceTriangle source_triangle(std::uint32_t triangle) const { return source_triangle_[triangle]; }
  std::uint32_t part_count() const { return part_count_; }
  std::uint32_t part_of(std::uint32_t triangle) const { return part_[mesh_.triangles[triangle].x]; }  // < part_count

  // Calls visit(vertex) for the welded neighbours of a footprint's node, once per triangle and corner: twice inside the
  // surface, once on a border.
  template <class Visit>
  void neighbours(std::uint32_t node, const PaintMask& mask, Visit visit) const {
    const Topology& topology = topology_of(mask);
    for (std::uint32_t c = topology.corners.first[node]; c < topology.corners.first[node + 1]; ++c) {
      const uvec3 t = mesh_.triangles[topology.corners.corner[c] / 3];
      const auto i = static_cast<int>(topology.corners.corner[c] % 3);
      visit(t[(i + 1) % 3]);
      visit(t[(i + 2) % 3]);
    }
  }

 private:
  // Connectivity of the triangles. A node represents a welded vertex. If creases are borders, a vertex has one node for
  // each fan of triangles between creases.
  struct Topology {
    Corners corners;                    // of nodes
    std::vector<uvec3> triangle;        // nodes; empty: those of the mesh
    std::vector<std::uint32_t> vertex;  // of each node; empty: itself
  };

  static Topology split_at_creases(const Mesh& mesh, const Corners& corners);
  const Topology& topology_of(const PaintMask& mask) const {
    return mask.creases && !smooth_.triangle.empty() ? smooth_ : whole_;
  }
  const uvec3& nodes_of(const Topology& topology, std::uint32_t triangle) const {
    return topology.triangle.empty() ? mesh_.triangles[triangle] : topology.triangle[triangle];
  }
  void find_sources(const Gathered& gathered, const Welded& welded);
  void find_parts();
  SurfaceHit at(std::uint32_t triangle, const dvec3& barycentric) const;
  void march(const SurfaceHit& hit, double radius, const PaintMask& mask, MarchWork& work) const;

  Mesh mesh_;
  dmat3 frame_{1};
  MeshReport report_;
  Topology whole_, smooth_;                      // smooth_ is empty where the mesh has no creases
  std::vector<SourceTriangle> source_triangle_;  // of each triangle
  std::vector<std::uint32_t> first_vertex_;      // of each primitive in mesh_.of_source, and one past the last
  std::vector<std::uint32_t> source_first_;      // vertices + 1: run of each welded vertex in sources_
  std::vector<SourceVertex> sources_;
  std::vector<std::uint32_t> part_;  // of each welded vertex
  std::uint32_t part_count_ = 0;
};

}  // namespace pliant
