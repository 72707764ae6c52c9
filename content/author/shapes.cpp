#include "content/author/shapes.h"

#include <array>
#include <cmath>
#include <functional>

namespace pliant {

namespace {

constexpr std::array<SimpleShape, 4> kShapes{{{ShapeKind::kSphere, "sphere", "a ball of even triangles"},
                                              {ShapeKind::kBox, "box", "a cube with sharp edges"},
                                              {ShapeKind::kPlate, "plate", "a flat square slab: a table, a pad"},
                                              {ShapeKind::kTorus, "torus", "a ring that lies flat"}}};

// A grid of points and normals, (columns + 1) x (rows + 1), counter-clockwise as seen from where u goes right and v up.
struct GridPoint {
  dvec3 position, normal;
};
void add_grid(Primitive& out, int columns, int rows, const std::function<GridPoint(int, int)>& at) {
  const auto first = static_cast<std::uint32_t>(out.position.size()), wide = static_cast<std::uint32_t>(columns) + 1;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const GridPoint point = at(i, j);
      out.position.push_back(vec3(point.position));
      out.normal.push_back(vec3(point.normal));
      out.uv.push_back(vec2(double(i) / columns, 1.0 - double(j) / rows));
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t a = first + static_cast<std::uint32_t>(j) * wide + static_cast<std::uint32_t>(i);
      out.index.insert(out.index.end(), {a, a + 1, a + wide + 1, a, a + wide + 1, a + wide});
    }
}

// The six faces of a lattice of `cells`; `at`: the point of a lattice point in [-1, 1]^3 on the face with that normal.
Primitive faces(glm::ivec3 cells, const std::function<GridPoint(dvec3 p, dvec3 face)>& at) {
  Primitive out;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const int u = (axis + (side > 0 ? 1 : 2)) % 3, v = (axis + (side > 0 ? 2 : 1)) % 3;
      add_grid(out, cells[u], cells[v], [&](int i, int j) {
        dvec3 p(0), face(0);
        face[axis] = p[axis] = side;
        p[u] = 2.0 * i / cells[u] - 1.0;
        p[v] = 2.0 * j / cells[v] - 1.0;
        return at(p, face);
      });
    }
  return out;
}

Primitive slab(glm::ivec3 cells, dvec3 half) {
  return faces(cells, [half](dvec3 p, dvec3 face) { return GridPoint{p * half, face}; });
}

Primitive ball(double radius) {
  constexpr int kCells = 16;
  return faces(glm::ivec3(kCells), [radius](dvec3 p, dvec3) {
    const dvec3 n = glm::normalize(glm::tan(0.25 * glm::pi<double>() * p));  // cells of nearly equal size
    return GridPoint{radius * n, n};
  });
}

Primitive ring(double size) {
  constexpr int kAround = 64, kTube = 32;
  const double tube = size / 6.0, radius = 2.0 * tube;
  Primitive out;
  add_grid(out, kAround, kTube, [=](int i, int j) {
    const double a = 2.0 * glm::pi<double>() * (i % kAround) / kAround,
                 b = 2.0 * glm::pi<double>() * (j % kTube) / kTube;
    const dvec3 n(std::cos(b) * std::cos(a), std::sin(b), -std::cos(b) * std::sin(a));
    return GridPoint{dvec3(radius * std::cos(a), 0.0, -radius * std::sin(a)) + tube * n, n};
  });
  return out;
}

}  // namespace

std::span<const SimpleShape> shapes() {
  return kShapes;
}

Primitive shape_of(ShapeKind kind, double size) {
  switch (kind) {
    case ShapeKind::kBox:
      return slab({10, 10, 10}, dvec3(0.5 * size));
    case ShapeKind::kPlate:
      return slab({20, 2, 20}, 0.5 * size * dvec3(1.0, 0.1, 1.0));
    case ShapeKind::kTorus:
      return ring(size);
    case ShapeKind::kSphere:
      break;
  }
  return ball(0.5 * size);
}

}  // namespace pliant
