#include "systems/soft/collide/collision_mesh.h"

#include <algorithm>
#include <cmath>

#include "runtime/assert.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/collide/farthest_axis.h"

namespace pliant {
namespace {

constexpr double kNearEdges = 2.5;   // [mean edges] along the surface: closer neighbours never collide
constexpr double kFlatShare = 0.05;  // [rad] edges whose triangles are coplanar within this cannot touch
constexpr double kHollow = 0.98;     // [1] cosine across a concave edge: sharper ones are touched on their flanks
constexpr double kSmooth = 0.8;      // [1] cosine between a vertex's normal and its triangles': below it, it is sharp
constexpr double kBends = 0.02;      // [rad] over a mean edge: flatter meshes do not roll
constexpr double kTurnsFar = 0.95;   // [1] cosine of the rotation in a step
constexpr int kRigid = 6;            // degrees of freedom
constexpr float kRounding = 4e-7f;   // [1] of coordinates: boxes are single precision

Box grown(const Box& box, float by) {
  Box b = box;
  const float far = std::max({std::abs(b.min.x), std::abs(b.min.y), std::abs(b.min.z), std::abs(b.max.x),
                              std::abs(b.max.y), std::abs(b.max.z)});
  b.min -= vec3(by + kRounding * far);
  b.max += vec3(by + kRounding * far);
  return b;
}

// [m] Displacements over T: on arcs along a path, else straight.
void displace(const std::optional<RigidPath>& path, const std::vector<dvec3>& position,
              const std::vector<dvec3>& velocity, double T, std::vector<dvec3>& out) {
  if (!path || path->angular == dvec3(0.0)) {
    for (std::size_t v = 0; v < out.size(); ++v) out[v] = T * velocity[v];
    return;
  }
  const dmat3 turn = glm::mat3_cast(rotation_of(T * path->angular));
  for (std::size_t v = 0; v < out.size(); ++v) {
    const dvec3 r = position[v] - path->centre;
    out[v] = T * path->linear + (turn * r - r);
  }
}

dvec3 unit_or_zero(dvec3 n) {
  const double l = length(n);
  return l > 0.0 ? n / l : dvec3(0.0);
}

}  // namespace

CollisionMesh::CollisionMesh(const Body& body) : mesh_(body.collision_mesh), deforms_(body.size() > kRigid) {
  turns_ = body.last_path().has_value();
  fixed_ = body.size() == 0 && !body.yields() && !mesh_->triangles.empty();
  ASSERT(body.collision_mesh && body.surface_position.size() >= body.collision_mesh->vertex_count);
  find_edges();
  find_shortest();
  if (body.self_collides)
    neighbours_ =
        MeshNeighbours(*mesh_, kNearEdges * static_cast<double>(mesh_->mean_edge), triangles_first_, triangles_of_);
  position_.resize(mesh_->vertex_count, dvec3(0));
  displacement_.resize(mesh_->vertex_count, dvec3(0));
  free_ = displacement_;
  ahead_.resize(mesh_->vertex_count, dvec3(0));
  curvature_.resize(mesh_->vertex_count, 0.0);
  vertex_normal_.resize(mesh_->vertex_count);
  normal_.resize(mesh_->triangles.size());
  for (std::uint32_t v = 0; v < mesh_->vertex_count; ++v) position_[v] = dvec3(mesh_->position(v));
  find_normals();
  find_curvatures();
  rest_ = {normal_, vertex_normal_, smooth_, curvature_, shape_operators(*mesh_, edges_, vertex_normal_)};
  average_over_neighbours(edges_, smooth_, rest_.bend);
  const auto area = [&](std::uint32_t t) {
    const uvec3 c = mesh_->triangles[t];
    const dvec3 n = cross(position_[c.y] - position_[c.x], position_[c.z] - position_[c.x]);
    return dot(n, n);
  };
  for (std::uint32_t t = 1; t < mesh_->triangles.size(); ++t)
    if (area(t) > area(largest_)) largest_ = t;
  turns_ = turns_ && is_curved();
  closed_ = std::find(at_border_.begin(), at_border_.end(), true) == at_border_.end();
  if (turns_ || fixed_) smooth_shape_ = SmoothShape(*mesh_, edges_, smooth_);
  std::fill(position_.begin(), position_.end(), dvec3(0.0));
  triangle_box_.resize(mesh_->triangles.size());
  vertex_box_.resize(mesh_->vertex_count);
  vertex_strayed_.resize(mesh_->vertex_count);
  triangle_strayed_.resize(mesh_->triangles.size());
  for (const std::vector<Box>& level : mesh_->tree.levels) {
    boxes_.emplace_back(level.size());
    run_strayed_.emplace_back(level.size());
  }
  normal_boxes_ = boxes_;
}

void CollisionMesh::find_edges() {
  const std::vector<uvec3>& triangles = mesh_->triangles;
  edge_of_.assign(triangles.size(), {});
  owned_.assign(triangles.size(), 0);
  owner_.assign(mesh_->vertex_count, kBorder);
  triangles_first_.assign(mesh_->vertex_count + 1, 0);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = triangles[t][i], to = triangles[t][(i + 1) % 3], other = mesh_->across[t][i];
      ++triangles_first_[from + 1];
      if (owner_[from] == kBorder) {
        owner_[from] = t;
        owned_[t] |= static_cast<std::uint8_t>(1u << i);
      }
      std::uint32_t known = kBorder;
      if (other < t)
        for (int k = 0; k < 3; ++k)
          if (mesh_->across[other][k] == t && triangles[other][k] == to && triangles[other][(k + 1) % 3] == from)
            known = edge_of_[other][k];
      if (known == kBorder) {
        known = static_cast<std::uint32_t>(edges_.size());
        owned_[t] |= static_cast<std::uint8_t>(8u << i);
        edges_.push_back({from, to, {t, t}, {triangles[t][(i + 2) % 3], triangles[t][(i + 2) % 3]}});
      } else {
        edges_[known].triangle[1] = t;
        edges_[known].opposite[1] = triangles[t][(i + 2) % 3];
      }
      edge_of_[t][i] = known;
    }
  }
  at_border_.assign(mesh_->vertex_count, false);
  for (const CollisionEdge& edge : edges_)
    if (edge.triangle[0] == edge.triangle[1]) at_border_[edge.from] = at_border_[edge.to] = true;
  for (std::uint32_t v = 0; v < mesh_->vertex_count; ++v) triangles_first_[v + 1] += triangles_first_[v];
  edge_count_.assign(mesh_->vertex_count, 0.0);
  for (const CollisionEdge& edge : edges_) ++edge_count_[edge.from], ++edge_count_[edge.to];
  triangles_of_.resize(3 * triangles.size());
  std::vector<std::uint32_t> next(triangles_first_.begin(), triangles_first_.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) triangles_of_[next[triangles[t][i]]++] = t;
}

void CollisionMesh::find_shortest() {
  shortest_at_vertex_.assign(mesh_->vertex_count, 1e300);
  for (const uvec3& t : mesh_->triangles) {
    double shortest = 1e300;
    for (int i = 0; i < 3; ++i)
      shortest = std::min(shortest, length(dvec3(mesh_->position(t[(i + 1) % 3])) - dvec3(mesh_->position(t[i]))));
    shortest_.push_back(shortest);
    for (int i = 0; i < 3; ++i) shortest_at_vertex_[t[i]] = std::min(shortest_at_vertex_[t[i]], shortest);
  }
}

SurfacePoint CollisionMesh::point_at_vertex(std::uint32_t v) const {
  SurfacePoint p{owner_[v], dvec3(0), position_[v]};
  for (int i = 0; i < 3; ++i)
    if (mesh_->triangles[p.triangle][i] == v) p.barycentric[i] = 1.0;
  return p;
}
SurfacePoint CollisionMesh::point_on_edge(std::uint32_t e, double along) const {
  const CollisionEdge& edge = edges_[e];
  SurfacePoint p{edge.triangle[0], dvec3(0), (1.0 - along) * position_[edge.from] + along * position_[edge.to]};
  for (int i = 0; i < 3; ++i) {
    if (mesh_->triangles[p.triangle][i] == edge.from) p.barycentric[i] = 1.0 - along;
    if (mesh_->triangles[p.triangle][i] == edge.to) p.barycentric[i] = along;
  }
  return p;
}
SurfacePoint CollisionMesh::point_on_triangle(std::uint32_t t, dvec3 w) const {
  const uvec3 c = mesh_->triangles[t];
  return {t, w, w.x * position_[c.x] + w.y * position_[c.y] + w.z * position_[c.z]};
}

std::array<Moving, 3> CollisionMesh::triangle(std::uint32_t t) const {
  const uvec3 c = mesh_->triangles[t];
  return {vertex(c.x), vertex(c.y), vertex(c.z)};
}

EdgeShape CollisionMesh::edge_shape(std::uint32_t e) const {
  const CollisionEdge& edge = edges_[e];
  const auto inward = [&](int i, double time) {
    const dvec3 from = vertex(edge.from).at(time), side = vertex(edge.opposite[i]).at(time) - from;
    const dvec3 along = unit_or_zero(vertex(edge.to).at(time) - from);
    return unit_or_zero(side - dot(side, along) * along);
  };
  EdgeShape shape;
  for (int i = 0; i < 2; ++i) {
    shape.inward[i] = inward(i, 0.0);
    shape.turning[i] = inward(i, 1.0) - shape.inward[i];
    shape.outward += normal_[edge.triangle[i]];
  }
  return shape;
}

dmat3 CollisionMesh::turn(std::uint32_t t) const {
  const uvec3 c = mesh_->triangles[t];
  const auto frame = [](dvec3 along, dvec3 normal) {
    const dvec3 x = unit_or_zero(along);
    return dmat3(x, normal, cross(x, normal));
  };
  const dvec3 rest = dvec3(mesh_->position(c.y)) - dvec3(mesh_->position(c.x));
  return frame(position_[c.y] - position_[c.x], normal_[t]) * glm::transpose(frame(rest, rest_.normal[t]));
}

void CollisionMesh::predict(const Body& body, const std::vector<dvec3>& velocity, double T) {
  displace(path_of(body), position_, velocity, T, ahead_);
  for (std::size_t v = 0; v < ahead_.size(); ++v) ahead_[v] = position_[v] + ahead_[v];
  if (const std::optional<RigidPath> now = path_of(body)) turn_ahead_ = glm::mat3_cast(rotation_of(T * now->angular));
  position_.swap(ahead_);
  find_normals();
  find_curvatures();
  position_.swap(ahead_);
  predicted_ = true;
}

void CollisionMesh::refit(const Body& body, double T, double reach) {
  const std::uint32_t count = mesh_->vertex_count;
  const bool still = body.size() == 0 && std::all_of(body.surface_velocity.begin(), body.surface_velocity.end(),
                                                     [](const dvec3& v) { return v == dvec3(0); });
  const bool same = std::equal(position_.begin(), position_.end(), body.surface_position.begin());
  if (still && still_ && same && reach == reach_ && !predicted_) return;
  swept_ = false;
  still_ = still && same, predicted_ = false;  // a body that has just stopped is extrapolated once more
  const double again = last_step_ > 0.0 ? T / last_step_ : 0.0;
  last_step_ = T;
  for (std::uint32_t v = 0; v < count; ++v) {
    const dvec3 went = body.surface_position[v] - position_[v];
    position_[v] = body.surface_position[v];
    ahead_[v] = position_[v] + again * went;
  }
  displace(path_of(body), position_, body.surface_velocity, T, displacement_);
  free_ = displacement_;
  find_drift();
  find_normals();
  find_turns(body, T);
  find_curvatures();
  find_live_edges();
  fit_boxes(reach);
}

void CollisionMesh::sweep(const Body& body, const std::vector<dvec3>& velocity, double T) {
  dvec3 mean(0.0);
  displace(path_of(body), position_, velocity, T, displacement_);
  for (std::size_t v = 0; v < displacement_.size(); ++v) mean += displacement_[v] - free_[v];
  mean /= static_cast<double>(std::max<std::size_t>(displacement_.size(), 1));
  strayed_ = strayed_apart_ = 0.0;
  for (std::size_t v = 0; v < displacement_.size(); ++v) {
    const dvec3 strayed = displacement_[v] - free_[v];
    vertex_strayed_[v] = static_cast<float>(length(strayed));
    strayed_ = std::max(strayed_, length(strayed));
    strayed_apart_ = std::max(strayed_apart_, length(strayed - mean));
  }
  swept_ = true;
  find_drift();
}

void CollisionMesh::fit_swept() {
  if (!swept_) return;
  swept_ = false;
  fit_boxes(reach_);
  for (std::uint32_t t = 0; t < triangle_strayed_.size(); ++t) {
    const uvec3 c = mesh_->triangles[t];
    triangle_strayed_[t] = std::max({vertex_strayed_[c.x], vertex_strayed_[c.y], vertex_strayed_[c.z]});
  }
  const std::vector<float>* below = &triangle_strayed_;
  for (std::size_t level = 0; level < run_strayed_.size(); ++level) {
    const std::uint32_t width = level == 0 ? kLeafSize : kTreeWidth;
    std::vector<float>& runs = run_strayed_[level];
    std::fill(runs.begin(), runs.end(), 0.0f);
    for (std::size_t k = 0; k < below->size(); ++k) runs[k / width] = std::max(runs[k / width], (*below)[k]);
    below = &runs;
  }
}

// A polyhedron rolls over its edges, as its mesh does.
bool CollisionMesh::is_curved() const {
  for (std::uint32_t v = 0; v < mesh_->vertex_count; ++v)
    if (smooth_[v] && curvature_[v] * static_cast<double>(mesh_->mean_edge) > kBends) return true;
  return false;
}

std::optional<RigidPath> CollisionMesh::path_of(const Body& body) const {
  return turns_ ? body.path() : std::nullopt;
}

void CollisionMesh::find_turns(const Body& body, double T) {
  turn_ahead_ = dmat3(1.0);
  if (!turns_ && !fixed_) return;
  turn_ = turn(largest_);
  const std::optional<RigidPath> last = body.last_path();
  if (!last) return;
  last_path_ = *last;
  if (last->angular == dvec3(0.0)) return;
  displace(last, position_, {}, T, ahead_);
  for (std::size_t v = 0; v < ahead_.size(); ++v) ahead_[v] += position_[v];
  turn_ahead_ = glm::mat3_cast(rotation_of(T * last->angular));
}

void CollisionMesh::find_drift() {
  drift_ = dvec3(0.0);
  for (const dvec3& d : displacement_) drift_ += d;
  drift_ /= static_cast<double>(std::max<std::size_t>(displacement_.size(), 1));
  double most = 0.0;
  for (const dvec3& d : displacement_) most = std::max(most, dot(d - drift_, d - drift_));
  spread_ = std::sqrt(most);
}

void CollisionMesh::find_normals() {
  std::fill(vertex_normal_.begin(), vertex_normal_.end(), dvec3(0.0));
  for (std::uint32_t t = 0; t < normal_.size(); ++t) {
    const uvec3 c = mesh_->triangles[t];
    const dvec3 n = cross(position_[c.y] - position_[c.x], position_[c.z] - position_[c.x]);
    for (int i = 0; i < 3; ++i) vertex_normal_[c[i]] += n;
    normal_[t] = unit_or_zero(n);
  }
  for (dvec3& n : vertex_normal_) n = unit_or_zero(n);
  smooth_.assign(vertex_normal_.size(), 1);
  for (std::uint32_t t = 0; t < normal_.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh_->triangles[t][i];
      if (dot(vertex_normal_[v], normal_[t]) < kSmooth) smooth_[v] = 0;
    }
  for (const CollisionEdge& edge : edges_) {
    const dvec3 across = position_[edge.opposite[1]] - position_[edge.from];
    const bool hollow = dot(normal_[edge.triangle[0]], across) > 0.0;
    if (hollow && dot(normal_[edge.triangle[0]], normal_[edge.triangle[1]]) < kHollow)
      smooth_[edge.from] = smooth_[edge.to] = 0;
  }
}

// Normal curvature along every edge at a vertex, dn . dx / dx^2, averaged.
void CollisionMesh::find_curvatures() {
  std::fill(curvature_.begin(), curvature_.end(), 0.0);
  for (const CollisionEdge& edge : edges_) {
    const dvec3 d = position_[edge.to] - position_[edge.from];
    const double dd = dot(d, d);
    const double k = dd > 0.0 ? dot(vertex_normal_[edge.to] - vertex_normal_[edge.from], d) / dd : 0.0;
    curvature_[edge.from] += k / edge_count_[edge.from];
    curvature_[edge.to] += k / edge_count_[edge.to];
  }
}

// Depth lost by omitting a flat edge: at most kFlatShare / 4 of its length.
void CollisionMesh::find_live_edges() {
  live_ = owned_;
  sharp_.assign(live_.size(), 0), supple_.assign(live_.size(), 0);
  const double flat = std::cos(kFlatShare);
  for (std::uint32_t t = 0; t < live_.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      if (!(owned_[t] & 8u << i)) continue;
      const CollisionEdge& edge = edges_[edge_of_[t][i]];
      if (edge.triangle[0] == edge.triangle[1]) continue;
      const dvec3 across = position_[edge.opposite[1]] - position_[edge.from];
      const bool convex = dot(normal_[edge.triangle[0]], across) < 0.0;
      const double alike = dot(normal_[edge.triangle[0]], normal_[edge.triangle[1]]);
      const auto bit = static_cast<std::uint8_t>(8u << i);
      if (convex && alike < kSmooth) sharp_[t] |= bit;
      if (convex && alike <= flat) continue;
      live_[t] = static_cast<std::uint8_t>(live_[t] & ~bit);
      if (deforms_) supple_[t] |= bit;
    }
}

void CollisionMesh::fit_boxes(double reach) {
  reach_ = reach;
  if (boxes_.empty()) return;
  for (std::uint32_t v = 0; v < vertex_box_.size(); ++v) {
    const vec3 from(position_[v]), to(position_[v] + displacement_[v] - drift_);
    vertex_box_[v].min = glm::min(from, to);
    vertex_box_[v].max = glm::max(from, to);
  }
  std::vector<Box>& leaf_normals = normal_boxes_[0];
  // A vertex of a fast rolling ball may come round within the step.
  const bool far = turns_ && turn_ahead_[0][0] + turn_ahead_[1][1] + turn_ahead_[2][2] < 1.0 + 2.0 * kTurnsFar;
  std::fill(leaf_normals.begin(), leaf_normals.end(), Box());
  for (std::uint32_t t = 0; t < triangle_box_.size(); ++t) {
    Box box;
    Box& normals = leaf_normals[t / kLeafSize];
    normals.add(vec3(normal_[t]));
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh_->triangles[t][i];
      box.add(vertex_box_[v]);
      normals.add(vec3(vertex_normal_[v]));
      if (far) normals.add(vec3(turn_ahead_ * vertex_normal_[v]));
      if (live_[t] & 8u << i) normals.add(vec3(edge_normal(edge_of_[t][i])));
    }
    triangle_box_[t] = grown(box, static_cast<float>(reach));
  }
  const auto gather = [](const std::vector<Box>& from, std::vector<Box>& to, std::uint32_t width) {
    for (std::size_t i = 0; i < to.size(); ++i) {
      to[i] = Box();
      for (std::size_t k = i * width; k < std::min(from.size(), (i + 1) * width); ++k) to[i].add(from[k]);
    }
  };
  gather(triangle_box_, boxes_[0], kLeafSize);
  for (std::size_t level = 1; level < boxes_.size(); ++level) {
    gather(boxes_[level - 1], boxes_[level], kTreeWidth);
    gather(normal_boxes_[level - 1], normal_boxes_[level], kTreeWidth);
  }
}

}  // namespace pliant
