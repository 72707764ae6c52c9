#include "systems/touch/collide/inner_walls.h"

#include <algorithm>

#include "systems/touch/collide/seams.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

constexpr double kOpposite = -0.76;  // [1] cosine of the least angle between normals of walls that face each other
constexpr double kBehind = -0.3;     // [1] sine of the least angle between a wall and the surface that ends at its seam
constexpr double kInward = 0.02;     // [1] of the way to the centroid: corners are examined a little inside

dvec3 wall_corner(const Mesh& mesh, std::uint32_t t, std::uint32_t corner) {
  return dvec3(mesh.position(mesh.triangles[t][static_cast<int>(corner % 3)]));
}

// The surface across a crack, in the frame of the object.
struct Across {
  const Mesh& mesh;
  Pose pose;
  double wide;  // [m]
  // Whether it has a triangle that faces a wall with normal n at x.
  bool faces(dvec3 x, dvec3 n) const {
    const dvec3 there = pose.to_local(x), normal = glm::conjugate(pose.rotation) * n;
    bool found = false;
    visit_near(
        mesh, there, [&] { return wide; },
        [&](std::uint32_t t) {
          found = found || (dot(facet_normal(mesh, t), normal) < kOpposite &&
                            closest_on_triangle(mesh, t, there).distance2 <= wide * wide);
        });
    return found;
  }
  bool covers(const Mesh& own, std::uint32_t t) const {
    const dvec3 n = facet_normal(own, t),
                middle = (wall_corner(own, t, 0) + wall_corner(own, t, 1) + wall_corner(own, t, 2)) / 3.0;
    if (!faces(middle, n)) return false;
    for (std::uint32_t i = 0; i < 3; ++i)
      if (!faces(glm::mix(wall_corner(own, t, i), middle, kInward), n)) return false;
    return true;
  }
};

// The triangles around each vertex: first[v] to first[v + 1].
struct Around {
  std::vector<std::uint32_t> first, triangle;
};
Around triangles_around(const Mesh& mesh) {
  Around around;
  around.first.assign(mesh.vertex_count + 1, 0);
  for (const uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) ++around.first[t[i] + 1];
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) around.first[v + 1] += around.first[v];
  around.triangle.resize(3 * mesh.triangles.size());
  std::vector<std::uint32_t> next(around.first.begin(), around.first.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) around.triangle[next[mesh.triangles[t][i]]++] = t;
  return around;
}

}  // namespace

void find_inner_walls(const World& world, TouchState& touch, std::uint32_t slot) {
  ObjectState& object = touch.objects[slot];
  const Mesh& mesh = touch_mesh(world, object);
  if (object.found.seams.empty()) return;
  const Around around = triangles_around(mesh);
  std::vector<std::uint8_t> seen;
  std::vector<std::uint32_t> open;
  const auto find = [&](std::uint32_t bond, const Across& across) {
    seen.assign(mesh.triangles.size(), 0);
    const auto add = [&](std::uint32_t t) {
      if (seen[t]) return;
      seen[t] = 1;
      if (!across.covers(mesh, t)) return;
      object.found.inner_walls.push_back({t, bond});
      open.push_back(t);
    };
    for (const Seam& seam : object.found.seams) {
      if (seam.bond != bond) continue;
      const std::uint32_t t = seam.edge / 3, e = seam.edge % 3;
      const dvec3 n = facet_normal(mesh, t);
      // The other triangles at the edge, whether they are connected there or only touch.
      const std::uint32_t from = mesh.triangles[t][static_cast<int>(e)];
      for (std::uint32_t k = around.first[from]; k < around.first[from + 1]; ++k) {
        const std::uint32_t other = around.triangle[k];
        const dvec3 middle =
                        (wall_corner(mesh, other, 0) + wall_corner(mesh, other, 1) + wall_corner(mesh, other, 2)) / 3.0,
                    way = middle - dvec3(mesh.position(from));
        if (dot(way, n) < kBehind * length(way)) add(other);
      }
    }
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t v = mesh.triangles[t][i];
        for (std::uint32_t k = around.first[v]; k < around.first[v + 1]; ++k) add(around.triangle[k]);
      }
    }
  };
  const double wide = crack_of(mesh);
  if (std::any_of(object.found.seams.begin(), object.found.seams.end(),
                  [](const Seam& seam) { return seam.bond == Seam::kCrack; }))
    find(Seam::kCrack, {mesh, Pose{}, wide});
  for (const std::uint32_t b : object.found.bonds) {
    const Bond& bond = touch.bonds[b];
    const bool is_first = bond.first == slot;
    find(b, {touch_mesh(world, touch.objects[is_first ? bond.second : bond.first]),
             is_first ? bond.relative : relative_pose(bond.relative, Pose{}), wide});
  }
  std::sort(object.found.inner_walls.begin(), object.found.inner_walls.end());
}

bool is_inner_wall(const ObjectState& object, std::uint32_t triangle) {
  return std::binary_search(object.inner_walls.begin(), object.inner_walls.end(), triangle);
}

}  // namespace pliant
