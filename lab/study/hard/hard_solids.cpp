#include "lab/study/hard/hard_solids.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pliant {
namespace {

Primitive octahedron(double size) {
  Primitive p;
  for (const double s : {size, -size})
    for (int k = 0; k < 3; ++k) {
      dvec3 corner(0);
      corner[k] = s;
      p.position.push_back(vec3(corner));
    }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t x = i & 1 ? 3 : 0, y = i & 2 ? 4 : 1, z = i & 4 ? 5 : 2;
    const bool even = ((i & 1) + (i >> 1 & 1) + (i >> 2)) % 2 == 0;
    for (const std::uint32_t v : {x, even ? y : z, even ? z : y}) p.index.push_back(v);
  }
  return p;
}

}  // namespace

Solid box_solid() {
  const dvec3 low(-kHalfSolid, -2 * kHalfSolid, -kHalfSolid), high(kHalfSolid, 0, kHalfSolid);
  return {"box", scenes::slab(4, 2 * kHalfSolid, 2 * kHalfSolid), high, normalize(dvec3(1)),
          [=](dvec3 x) { return glm::clamp(x, low, high); }};
}

// |x| + |y| + |z| <= kHalfSolid: projection onto the simplex in the point's octant.
Solid octahedron_solid() {
  return {"octahedron", octahedron(kHalfSolid), {0, kHalfSolid, 0}, {0, 1, 0}, [](dvec3 x) {
            std::array<double, 3> sorted{std::abs(x.x), std::abs(x.y), std::abs(x.z)};
            std::sort(sorted.rbegin(), sorted.rend());
            double sum = 0.0, level = 0.0;
            for (int n = 1; n <= 3; ++n) {
              sum += sorted[static_cast<std::size_t>(n - 1)];
              if (const double next = (sum - kHalfSolid) / n; sorted[static_cast<std::size_t>(n - 1)] > next)
                level = next;
            }
            return glm::sign(x) * glm::max(glm::abs(x) - dvec3(level), dvec3(0));
          }};
}

Primitive cone(int sides, double radius, double height) {
  Primitive p;
  p.position = {vec3(0), vec3(0, -static_cast<float>(height), 0)};
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * M_PI * i / sides;
    p.position.push_back(vec3(dvec3(radius * std::sin(a), -height, radius * std::cos(a))));
  }
  for (int i = 0; i < sides; ++i) {
    const auto a = static_cast<std::uint32_t>(2 + i), b = static_cast<std::uint32_t>(2 + (i + 1) % sides);
    for (const std::uint32_t v : {0u, a, b, 1u, b, a}) p.index.push_back(v);
  }
  return p;
}

}  // namespace pliant
