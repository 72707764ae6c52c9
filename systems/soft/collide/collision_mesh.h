// A body's surface for the contact search: its edges and neighbours, and in every step the boxes swept by its
// triangles. The tree is the mesh's (components/mesh.h): only boxes are refitted.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "systems/soft/body/body.h"
#include "systems/soft/collide/meeting.h"
#include "systems/soft/collide/mesh_neighbours.h"
#include "systems/soft/collide/smooth_shape.h"

namespace pliant {

// [1] cosine: outward normals of touching features are approximately opposed.
inline constexpr double kFacing = 0.3;

struct CollisionEdge {
  std::uint32_t from = 0, to = 0;           // vertices
  std::array<std::uint32_t, 2> triangle{};  // adjacent; the same twice at a border
  std::array<std::uint32_t, 2> opposite{};  // their third vertices
};

class CollisionMesh {
 public:
  explicit CollisionMesh(const Body& body);

  // Updates from the body's collision mesh for a step of T [s]; boxes grow by `reach` [m]. Fixed collision meshes that
  // have not moved are unchanged.
  void refit(const Body& body, double T, double reach);

  // The same step with `velocity` [m/s, per vertex] instead of the body's free one: displacements. fit_swept() then
  // updates the boxes; it does nothing if they are up to date.
  void sweep(const Body& body, const std::vector<dvec3>& velocity, double T);
  void fit_swept();

  // --- Topology
  const Mesh& mesh() const { return *mesh_; }
  const std::vector<CollisionEdge>& edges() const { return edges_; }
  // Every vertex and every edge is tested with one triangle only: bits 0-2 of its corners, 3-5 of its edges (edge i
  // goes from corner i to corner i+1).
  std::uint8_t owned(std::uint32_t triangle) const { return owned_[triangle]; }
  std::uint32_t edge_of(std::uint32_t triangle, int i) const { return edge_of_[triangle][i]; }
  // The same for this step, without edges that cannot touch: on a plane the vertices touch instead, and a concave edge
  // cannot touch.
  std::uint8_t live(std::uint32_t triangle) const { return live_[triangle]; }
  // Edges as in live(), of the same triangles. `sharp`: live, and sharper than 37 degrees. `supple`: not live, but of a
  // deformable collision mesh that bends around a sharp edge pressed into it between its vertices.
  std::uint8_t sharp(std::uint32_t triangle) const { return sharp_[triangle]; }
  std::uint8_t supple(std::uint32_t triangle) const { return supple_[triangle]; }
  // [m] at rest: the shortest edge of the triangles around a vertex, beside an edge, of a triangle.
  double shortest_at_vertex(std::uint32_t v) const { return shortest_at_vertex_[v]; }
  double shortest_at_edge(std::uint32_t e) const {
    return std::min(shortest_[edges_[e].triangle[0]], shortest_[edges_[e].triangle[1]]);
  }
  double shortest_of_triangle(std::uint32_t t) const { return shortest_[t]; }
  bool at_border(std::uint32_t v) const { return at_border_[v]; }
  SurfacePoint point_at_vertex(std::uint32_t vertex) const;
  SurfacePoint point_on_edge(std::uint32_t edge, double along) const;
  SurfacePoint point_on_triangle(std::uint32_t triangle, dvec3 barycentric) const;
  const MeshNeighbours& neighbours() const { return neighbours_; }  // only of self-colliding meshes

  // --- This step
  Moving vertex(std::uint32_t v) const { return {position_[v], displacement_[v]}; }
  // [m] Position at the end of the step, extrapolated from the last step: includes contacts, which displacements do
  // not.
  dvec3 ahead(std::uint32_t v) const { return ahead_[v]; }
  // Extrapolates with the body's current velocity, [m/s] per vertex, over T [s]: updates ahead(), and the normals and
  // curvatures there. Everything else is unchanged.
  void predict(const Body& body, const std::vector<dvec3>& velocity, double T);
  // Of a rigid body that is not a tool: vertices move on arcs. last_path() and `step` [s] gave ahead(); rotation from
  // the normals to those of ahead().
  bool turns() const { return turns_; }
  bool fixed() const { return fixed_; }  // nor does it yield
  bool closed() const { return closed_; }
  const RigidPath& last_path() const { return last_path_; }
  double step() const { return last_step_; }
  const dmat3& turn_ahead() const { return turn_ahead_; }
  dmat3 normals_to_ahead() const { return predicted_ ? dmat3(1.0) : turn_ahead_; }
  // Of a turning or fixed body: its rotation from the object frame at the beginning, or at ahead().
  dmat3 turn_from_rest(bool at_ahead) const { return at_ahead ? turn_ahead_ * turn_ : turn_; }
  const SmoothShape& smooth_shape() const { return smooth_shape_; }  // of a turning or fixed body, else empty
  double bulge() const { return turns_ && closed_ ? smooth_shape_.bulge : 0.0; }
  std::array<Moving, 3> triangle(std::uint32_t t) const;
  std::array<Moving, 2> edge(std::uint32_t e) const { return {vertex(edges_[e].from), vertex(edges_[e].to)}; }
  EdgeShape edge_shape(std::uint32_t e) const;
  dvec3 normal(std::uint32_t t) const { return normal_[t]; }                // [1] unit (zero where it has no area)
  dvec3 vertex_normal(std::uint32_t v) const { return vertex_normal_[v]; }  // [1] unit
  bool smooth(std::uint32_t v) const {
    return smooth_[v] != 0;
  }                                                                  // no triangle around it deviates by over 37
                                                                     // degrees
  double curvature(std::uint32_t v) const { return curvature_[v]; }  // [1/m] mean; > 0: bulges
  // The shape at rest, object frame.
  struct Shape {
    std::vector<dvec3> normal, vertex_normal;
    std::vector<std::uint8_t> smooth;
    std::vector<double> curvature;
    std::vector<dmat3> bend;  // [1/m] per vertex: shape operator, the normal changes by bend dx; symmetric
  };
  const Shape& rest() const { return rest_; }
  dmat3 turn(std::uint32_t t) const;         // rotation of a triangle from rest
  dvec3 drift() const { return drift_; }     // [m] mean displacement; boxes contain the motion relative to it
  double spread() const { return spread_; }  // [m] largest deviation of a vertex's displacement from the mean
  // Of triangle runs as in Mesh::tree, level 0 the leaves.
  const std::vector<std::vector<Box>>& boxes() const { return boxes_; }
  // [m] Largest deviation of the sweep() displacements from the free motion: anywhere, in a run as in boxes(), of a
  // triangle.
  double strayed() const { return strayed_; }
  double strayed_apart() const { return strayed_apart_; }  // [m] without the mean deviation
  float strayed(std::size_t level, std::uint32_t i) const { return run_strayed_[level][i]; }
  float strayed(std::uint32_t t) const { return triangle_strayed_[t]; }
  Box whole() const { return boxes_.empty() ? Box() : boxes_.back()[0]; }
  const Box& box(std::uint32_t t) const { return triangle_box_[t]; }
  const Box& vertex_box(std::uint32_t v) const { return vertex_box_[v]; }  // without reach
  // Of the same runs: all outward normals of their triangles, vertices and edges.
  const std::vector<std::vector<Box>>& normal_boxes() const { return normal_boxes_; }
  dvec3 edge_normal(std::uint32_t e) const {  // [1] mean of the two beside it
    return 0.5 * (normal_[edges_[e].triangle[0]] + normal_[edges_[e].triangle[1]]);
  }
  // Whether a point is inside, by the nearest feature within `reach` [m] and its pseudonormal (Baerentzen & Aanaes
  // 2005).
  bool contains(dvec3 p, double reach) const;

 private:
  void find_edges();
  void find_shortest();
  void fit_boxes(double reach);
  bool is_curved() const;
  std::optional<RigidPath> path_of(const Body& body) const;  // none: vertices move straight
  void find_turns(const Body& body, double T);
  void find_drift();
  void find_normals();
  void find_curvatures();
  void find_live_edges();

  const Mesh* mesh_;
  std::vector<CollisionEdge> edges_;
  std::vector<std::array<std::uint32_t, 3>> edge_of_;
  std::vector<std::uint8_t> owned_, live_, sharp_, supple_;
  bool deforms_ = false, turns_ = false, fixed_ = false, closed_ = false;
  RigidPath last_path_;
  dmat3 turn_{1}, turn_ahead_{1};
  std::uint32_t largest_ = 0;  // triangle
  SmoothShape smooth_shape_;
  std::vector<bool> at_border_;
  std::vector<double> shortest_, shortest_at_vertex_;
  std::vector<std::uint32_t> owner_;                           // of each vertex: one of its triangles
  std::vector<std::uint32_t> triangles_first_, triangles_of_;  // around each vertex
  MeshNeighbours neighbours_;
  std::vector<dvec3> position_, displacement_, free_, ahead_;  // free_: displacements of the free motion
  Shape rest_;
  std::vector<dvec3> normal_, vertex_normal_;
  std::vector<std::uint8_t> smooth_;
  std::vector<double> curvature_, edge_count_;
  double last_step_ = 0.0;  // [s]
  dvec3 drift_{0};
  double spread_ = 0.0, strayed_ = 0.0, strayed_apart_ = 0.0;
  bool swept_ = false;  // boxes are out of date
  std::vector<float> vertex_strayed_, triangle_strayed_;
  std::vector<std::vector<float>> run_strayed_;
  double reach_ = -1.0;
  bool still_ = false;      // nothing moved in the last step
  bool predicted_ = false;  // normals are those of ahead()
  std::vector<Box> vertex_box_, triangle_box_;
  std::vector<std::vector<Box>> boxes_, normal_boxes_;
};

}  // namespace pliant
