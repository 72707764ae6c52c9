#include "content/generate/lattice_sphere.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pliant::generate {
namespace {

constexpr double kMargin = 6.0 / 512.0;  // [1] of the square: empty border around the unfolded lattice

// Relaxation sweeps per level: many on coarse levels, where they are cheap and reach far. The finest level only removes
// the unevenness left by splitting.
int sweeps(int n) {
  return n < 30 ? 60 : 16;
}

int sign(int x) {
  return x < 0 ? -1 : 1;
}

// The lattice point's place in the square, seen from the octant (sx, sy, .). The octant matters only on the seams.
vec2 unfold(LatticePoint p, int sx, int sy, int n) {
  dvec2 q(p[0], p[1]);
  if (p[2] < 0) q = dvec2(sx * (n - std::abs(p[1])), sy * (n - std::abs(p[0])));
  return vec2(dvec2(0.5) + (0.5 - kMargin) * q / double(n));
}

std::uint32_t vertex_at(LatticeSphere& sphere, LatticePoint p) {
  const auto [place, fresh] = sphere.vertex.try_emplace(p, static_cast<std::uint32_t>(sphere.position.size()));
  if (fresh) sphere.position.emplace_back(0);
  return place->second;
}

// The triangles of one octant, from its lattice rows.
void add_octant(LatticeSphere& sphere, int sx, int sy, int sz) {
  const int n = sphere.n;
  const auto corner = [&](int i, int j) {
    const LatticePoint p{sx * i, sy * j, sz * (n - i - j)};
    return LatticeSphere::Corner{vertex_at(sphere, p), unfold({p[0], p[1], sz * (n - i - j)}, sx, sy, n)};
  };
  const auto add = [&](LatticeSphere::Corner a, LatticeSphere::Corner b, LatticeSphere::Corner c) {
    if (sx * sy * sz < 0) std::swap(b, c);
    sphere.triangles.push_back({a, b, c});
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      add(corner(i, j), corner(i + 1, j), corner(i, j + 1));
      if (i + j + 1 < n) add(corner(i + 1, j + 1), corner(i, j + 1), corner(i + 1, j));
    }
}

LatticeSphere lattice(int n) {
  LatticeSphere sphere;
  sphere.n = n;
  for (const int sz : {1, -1})
    for (const int sy : {1, -1})
      for (const int sx : {1, -1}) add_octant(sphere, sx, sy, sz);
  return sphere;
}

// Tangential smoothing that evens out areas: each vertex moves towards the area-weighted mean of its triangles' centres
// and is projected back onto the surface.
void relax(LatticeSphere& sphere, const Solid& solid) {
  std::vector<dvec3> sum(sphere.position.size());
  std::vector<double> area(sphere.position.size());
  for (int iteration = 0; iteration < sweeps(sphere.n); ++iteration) {
    std::fill(sum.begin(), sum.end(), dvec3(0));
    std::fill(area.begin(), area.end(), 0.0);
    for (const auto& t : sphere.triangles) {
      const dvec3 a = sphere.position[t[0].vertex], b = sphere.position[t[1].vertex], c = sphere.position[t[2].vertex];
      const double w = length(cross(b - a, c - a));
      for (const auto& corner : t) {
        sum[corner.vertex] += (a + b + c) * (w / 3.0);
        area[corner.vertex] += w;
      }
    }
    for (std::size_t v = 0; v < sum.size(); ++v) {
      const dvec3 p = sphere.position[v], n = normal_at(solid, p), step = sum[v] / area[v] - p;
      sphere.position[v] = project(solid, p + step - n * dot(n, step));
    }
  }
}

// The lattice refined by two: old points, and midpoints of old edges.
LatticeSphere refined(const LatticeSphere& coarse, const Solid& solid) {
  LatticeSphere fine = lattice(2 * coarse.n);
  for (const auto& [p, v] : fine.vertex) {
    LatticePoint a{p[0] / 2, p[1] / 2, p[2] / 2}, b = a;  // rounded towards zero
    bool a_rounds_up = true;
    for (std::size_t i = 0; i < 3; ++i) {
      if (p[i] % 2 == 0) continue;
      (a_rounds_up ? a : b)[i] += sign(p[i]);
      a_rounds_up = false;
    }
    fine.position[v] =
        project(solid, 0.5 * (coarse.position[coarse.vertex.at(a)] + coarse.position[coarse.vertex.at(b)]));
  }
  return fine;
}

}  // namespace

LatticeSphere cover(const Solid& solid, int coarse, int doublings) {
  // Start on a large octahedral sphere and move inwards along rays until the surface is reached.
  LatticeSphere sphere = lattice(coarse);
  for (const auto& [p, v] : sphere.vertex) {
    const dvec3 direction = normalize(dvec3(p[0], p[1], p[2]));
    double r = 0.3;
    while (r > 0.0 && solid(direction * r) > 0.0) r -= 1e-4;
    sphere.position[v] = project(solid, direction * r);
  }
  relax(sphere, solid);
  for (int i = 0; i < doublings; ++i) {
    sphere = refined(sphere, solid);
    relax(sphere, solid);
  }
  return sphere;
}

LatticePlace place_at(int n, dvec2 uv) {
  // Remove the margin; beyond the square's border, reflect at the fold.
  dvec2 q = (uv - 0.5) / (0.5 - kMargin);
  if (std::abs(q.x) > 1.0) q = {std::copysign(2.0 - std::abs(q.x), q.x), -q.y};
  if (std::abs(q.y) > 1.0) q = {-q.x, std::copysign(2.0 - std::abs(q.y), q.y)};
  const int sx = q.x < 0.0 ? -1 : 1, sy = q.y < 0.0 ? -1 : 1;
  double x = std::abs(q.x), y = std::abs(q.y);
  const int sz = x + y > 1.0 ? -1 : 1;
  if (sz < 0) {
    std::swap(x, y);
    x = 1.0 - x;
    y = 1.0 - y;
  }
  // The lattice triangle within that octant.
  const int i = std::min(static_cast<int>(x * n), n - 1), j = std::min(static_cast<int>(y * n), n - 1 - i);
  const double fx = x * n - i, fy = y * n - j;
  const auto point = [&](int a, int b) { return LatticePoint{sx * a, sy * b, sz * (n - a - b)}; };
  if (fx + fy <= 1.0 || i + j + 1 >= n)
    return {{point(i, j), point(i + 1, j), point(i, j + 1)}, {1.0 - fx - fy, fx, fy}};
  return {{point(i + 1, j + 1), point(i, j + 1), point(i + 1, j)}, {fx + fy - 1.0, 1.0 - fx, 1.0 - fy}};
}

Primitive to_primitive(const LatticeSphere& sphere, const Solid& solid) {
  Primitive primitive;
  std::map<std::array<float, 3>, std::uint32_t> known;  // (vertex, uv)
  for (const auto& t : sphere.triangles)
    for (const auto& corner : t) {
      const auto next = static_cast<std::uint32_t>(primitive.position.size());
      const auto [place, fresh] =
          known.try_emplace({static_cast<float>(corner.vertex), corner.uv.x, corner.uv.y}, next);
      if (fresh) {
        const dvec3 p = sphere.position[corner.vertex];
        primitive.position.emplace_back(p);
        primitive.normal.emplace_back(normal_at(solid, p));
        primitive.uv.push_back(corner.uv);
      }
      primitive.index.push_back(place->second);
    }
  return primitive;
}

}  // namespace pliant::generate
