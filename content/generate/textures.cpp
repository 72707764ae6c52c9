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

Image ball_color(const LatticeSphere& sphere, std::uint32_t size) {
  return painted("ball_color", size, [&](dvec2 uv) {
    const dvec3 p = point_at(sphere, uv);
    const double s = std::hypot(p.x, p.z) / length(p), turn = std::atan2(p.x, p.z);
    const double ridge = glm::smoothstep(0.35, 0.75, std::pow(s, 6.0) * std::cos(6.0 * turn));
    const double ring = std::exp(-std::pow(std::remainder(p.y, 0.015) / 0.0007, 2.0));
    const dvec3 pale = std::abs(turn) < 0.5 ? dvec3(0.45, 0.72, 0.62) : dvec3(0.93, 0.82, 0.70);
    const dvec3 clay = dvec3(0.74, 0.47, 0.38) + 0.03 * octaves(p / 0.008, 3);
    return glm::mix(glm::mix(clay, pale, ridge), dvec3(0.50, 0.28, 0.22), 0.45 * ring);
  });
}

Image skin_color(const LatticeSphere& sphere, std::uint32_t size) {
  return painted("skin_color", size, [&](dvec2 uv) {
    const dvec3 p = point_at(sphere, uv);
    const dvec3 winding = p + 0.004 * dvec3(noise(p / 0.009), 0.0, noise(p / 0.009 + 50.0));
    const double veins = std::exp(-std::pow(octaves(winding / 0.040 + 31.0, 2) / 0.10, 2.0));
    const double flush = glm::smoothstep(-0.3, 1.0, octaves(p / 0.025 + 70.0, 3));
    dvec3 color = dvec3(0.89, 0.72, 0.63) + dvec3(0.020, 0.016, 0.014) * octaves(p / 0.004, 2);
    color = glm::mix(color, dvec3(0.86, 0.56, 0.50), 0.45 * flush);
    return glm::mix(color, dvec3(0.60, 0.58, 0.66), 0.22 * veins);
  });
}

double pad_hardness(double x, double z) {
  return std::exp(-(std::pow(x - 0.038, 2.0) + std::pow(z - 0.004, 2.0)) / (0.013 * 0.013));
}

Image pad_section(dvec2 half, std::uint32_t size) {
  return painted("pad_section", size, [&](dvec2 uv) {
    const dvec3 p((2.0 * uv.x - 1.0) * half.x, (1.0 - 2.0 * uv.y) * half.y, 0.0);
    const double below = half.y - p.y + 0.0008 * noise(p / 0.006);  // [m] under the skin
    const double lobules = std::exp(-std::pow(octaves(p / 0.005, 2) / 0.16, 2.0));
    const double fibres = 0.5 + 0.5 * noise(dvec3(p.x / 0.02, p.y / 0.0012, 3.0));
    const dvec3 fat = glm::mix(dvec3(0.95, 0.83, 0.52), dvec3(0.84, 0.66, 0.38), 0.6 * lobules);
    const dvec3 muscle = glm::mix(dvec3(0.60, 0.20, 0.19), dvec3(0.74, 0.33, 0.30), fibres);
    const dvec3 color = below < 0.0025 ? dvec3(0.87, 0.62, 0.54) : below < 0.016 ? fat : muscle;
    const double spot = pad_hardness(p.x, 0.004) * std::exp(-std::pow((below - 0.009) / 0.006, 2.0));
    return glm::mix(color, dvec3(0.96, 0.96, 0.93), glm::smoothstep(0.35, 0.5, spot));
  });
}

}  // namespace pliant::generate
