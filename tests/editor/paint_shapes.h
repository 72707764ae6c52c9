// Surfaces whose geodesics have a closed form.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "editor/paint/paint_surface.h"
#include "tests/content/mesh_shapes.h"

namespace pliant::test {

inline PaintSurface surface_of(const LevelMesh& mesh, const dmat3& frame = dmat3(1)) {
  Result<PaintSurface> made = PaintSurface::make(mesh, frame);
  EXPECT_TRUE(made.ok()) << made.error().message();
  return std::move(*made);
}
inline PaintSurface surface_of(Primitive primitive, const dmat3& frame = dmat3(1)) {
  return surface_of(LevelMesh{"mesh", {std::move(primitive)}}, frame);
}

// A sheet over [0,1]^2 mapped isometrically: creased along x = fold, with the part beyond it rotated by `turn` [rad].
inline vec3 folded(vec3 p, double fold, double turn) {
  if (double(p.x) <= fold) return p;
  const double beyond = double(p.x) - fold;
  return vec3(dvec3(fold + beyond * std::cos(turn), double(p.y), beyond * std::sin(turn)));
}

// Interior vertices moved at random by up to `most` of a square's side: triangles of every shape, many obtuse.
inline Primitive uneven_sheet(std::uint32_t n, float most) {
  Primitive p = sheet(n);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> by(-most / float(n), most / float(n));
  for (vec3& x : p.position) {
    const vec2 moved = vec2(x) + vec2(by(random), by(random));
    if (x.x > 0 && x.x < 1) x.x = moved.x;
    if (x.y > 0 && x.y < 1) x.y = moved.y;
  }
  return p;
}

// The cube [-1,1]^3 of six grids with corners of their own; faces -x, +x, -y, ...
inline Primitive grid_cube(std::uint32_t n) {
  Primitive cube;
  const Primitive face = sheet(n);
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const auto first = static_cast<std::uint32_t>(cube.position.size());
      for (const vec3& x : face.position) {
        vec3 p(0);
        p[axis] = float(side);
        p[(axis + 1) % 3] = 2 * x.x - 1;
        p[(axis + 2) % 3] = (2 * x.y - 1) * float(side);
        cube.position.push_back(p);
      }
      for (const std::uint32_t v : face.index) cube.index.push_back(first + v);
    }
  return cube;
}

// The worst difference of a footprint's distances from exact ones, as a share of the radius; also fails where a vertex
// is in it though it is clearly beyond the radius, or left out though it is clearly within.
inline double worst_distance(const PaintSurface& surface, const SurfaceHit& hit, double radius,
                             const std::function<double(vec3)>& exact, const PaintMask& mask = {}) {
  MarchWork work;
  std::vector<double> found(surface.mesh().vertex_count, INFINITY);
  for (const ReachedVertex& reached : surface.footprint(hit, radius, mask, work)) {
    EXPECT_EQ(found[reached.vertex], INFINITY) << "a vertex was returned twice";
    found[reached.vertex] = double(reached.distance);
  }
  double worst = 0.0;
  for (std::uint32_t v = 0; v < found.size(); ++v) {
    const double truth = exact(surface.mesh().position(v));
    if (found[v] < INFINITY)
      worst = std::max(worst, std::abs(found[v] - truth) / radius);
    else if (truth < radius)
      worst = std::max(worst, (radius - truth) / radius);
  }
  return worst;
}

}  // namespace pliant::test
