#include "content/generate/textures.h"

#include <cmath>

namespace pliant::generate {
namespace {

// A number in [-1, 1] for every integer point.
double lattice_value(int x, int y, int z) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^ static_cast<std::uint32_t>(y) * 0xd8163841u ^
                    static_cast<std::uint32_t>(z) * 0xcb1ab31fu;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  h ^= h >> 15;
  return static_cast<double>(h) / 2147483647.5 - 1.0;
}

// Value noise in [-1, 1], C2, of wavelength about 2 in units of its argument.
double noise(dvec3 p) {
  const dvec3 cell = glm::floor(p), f = p - cell, s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y), z = static_cast<int>(cell.z);
  double sum = 0.0;
  for (int c = 0; c < 8; ++c) {
    const int i = c & 1, j = c >> 1 & 1, k = c >> 2;
    sum += lattice_value(x + i, y + j, z + k) * (i ? s.x : 1.0 - s.x) * (j ? s.y : 1.0 - s.y) * (k ? s.z : 1.0 - s.z);
  }
  return sum;
}

double octaves(dvec3 p, int count) {
  double sum = 0.0, amplitude = 1.0;
  for (int i = 0; i < count; ++i, amplitude *= 0.5, p = p * 2.03 + 17.0) sum += amplitude * noise(p);
  return sum;
}

// [m] Height of the bumps over the surface.
double bumps(dvec3 p) {
  return 0.00007 * noise(p / 0.0022) + 0.00016 * noise(p / 0.0050 + 5.0);
}

// The surface point at these texture coordinates.
dvec3 point_at(const LatticeSphere& sphere, dvec2 uv) {
  const LatticePlace place = place_at(sphere.n, uv);
  dvec3 p(0);
  for (std::size_t i = 0; i < 3; ++i)
    p += place.weight[static_cast<int>(i)] * sphere.position[sphere.vertex.at(place.corner[i])];
  return p;
}

template <class Shade>  // vec3 color in [0, 1] at a texel's centre
Image painted(const char* name, std::uint32_t size, Shade shade) {
  Image image{name, size, size, {}};
  image.rgba.reserve(std::size_t{4} * size * size);
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const dvec3 color = glm::clamp(shade((dvec2(x, y) + 0.5) / double(size)), 0.0, 1.0);
      for (int i = 0; i < 3; ++i) image.rgba.push_back(static_cast<std::uint8_t>(std::lround(color[i] * 255.0)));
      image.rgba.push_back(255);
    }
  return image;
}

}  // namespace

Image organ_color(const LatticeSphere& sphere, std::uint32_t size) {
  return painted("organ_color", size, [&](dvec2 uv) {
    const dvec3 p = point_at(sphere, uv);
    const double patches = 0.5 + 0.5 * octaves(p / 0.018, 3), fine = octaves(p / 0.004 + 40.0, 2);
    const double veins = std::exp(-std::pow(octaves(p / 0.022 + 90.0, 2) / 0.09, 2.0));
    dvec3 color = glm::mix(dvec3(0.64, 0.31, 0.27), dvec3(0.78, 0.45, 0.38), glm::clamp(patches, 0.0, 1.0));
    color += 0.015 * fine;
    color = glm::mix(color, dvec3(0.50, 0.20, 0.22), 0.3 * veins);
    return glm::mix(color, dvec3(0.88, 0.70, 0.58), 0.5 * std::pow(groove(p), 2.0));
  });
}

Image organ_normals(const LatticeSphere& sphere, const Solid& solid, std::uint32_t size) {
  return painted("organ_normals", size, [&](dvec2 uv) {
    const dvec3 p = point_at(sphere, uv);
    const dvec3 n = normal_at(solid, p);
    // Tangents along u and v, by finite differences within the texel.
    const dvec2 du(0.25 / size, 0), dv(0, 0.25 / size);
    const dvec3 along_u = point_at(sphere, uv + du) - point_at(sphere, uv - du);
    const dvec3 along_v = point_at(sphere, uv + dv) - point_at(sphere, uv - dv);
    const dvec3 t = normalize(along_u - n * dot(n, along_u));
    const dvec3 b = cross(n, t) * (dot(cross(n, t), along_v) < 0.0 ? -1.0 : 1.0);
    // The slope of the bumps tilts the normal the other way.
    dvec3 slope;
    for (int i = 0; i < 3; ++i) {
      dvec3 step(0);
      step[i] = 1e-5;
      slope[i] = (bumps(p + step) - bumps(p - step)) / 2e-5;
    }
    const dvec3 bent = normalize(dvec3(-dot(slope, t), -dot(slope, b), 1.0));
    return bent * 0.5 + 0.5;
  });
}

}  // namespace pliant::generate
