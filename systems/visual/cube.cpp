#include "systems/visual/cube.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr std::uint32_t kSmallestFace = 64, kLargestFace = 256;  // [pixels]
constexpr std::uint32_t kCubeSamples = 256;                      // directions averaged for a filtered pixel
constexpr float kLargestHalf = 65000.0f;

// One level of a cube map, in floats.
struct CubeLevel {
  std::uint32_t size = 0;
  std::vector<vec3> pixels;
  vec3& at(unsigned face, std::uint32_t x, std::uint32_t y) { return pixels[(face * size + y) * size + x]; }
  vec3 at(unsigned face, std::uint32_t x, std::uint32_t y) const { return pixels[(face * size + y) * size + x]; }
};

// Bilinear, periodic horizontally.
vec3 panorama_at(const Panorama& p, vec3 d) {
  const float x = (0.5f + std::atan2(d.x, -d.z) / (2 * kPi)) * static_cast<float>(p.width) - 0.5f;
  const float y = std::acos(glm::clamp(d.y, -1.0f, 1.0f)) / kPi * static_cast<float>(p.height) - 0.5f;
  const float fx = std::floor(x), fy = std::floor(y);
  auto pixel = [&](float i, float j) {
    const auto column = static_cast<std::uint32_t>(static_cast<std::int64_t>(i) + p.width) % p.width;
    const auto row = static_cast<std::uint32_t>(glm::clamp(j, 0.0f, static_cast<float>(p.height - 1)));
    const float* rgb = &p.rgb[3 * (std::size_t{row} * p.width + column)];
    return vec3(rgb[0], rgb[1], rgb[2]);
  };
  return glm::mix(glm::mix(pixel(fx, fy), pixel(fx + 1, fy), x - fx),
                  glm::mix(pixel(fx, fy + 1), pixel(fx + 1, fy + 1), x - fx), y - fy);
}

// Bilinear within a face.
vec3 cube_at(const CubeLevel& level, vec3 d) {
  const vec3 a = glm::abs(d);
  unsigned face = 0;
  float s = 0, t = 0, m = 1;
  if (a.x >= a.y && a.x >= a.z)
    face = d.x > 0 ? 0 : 1, m = a.x, s = d.x > 0 ? -d.z : d.z, t = -d.y;
  else if (a.y >= a.z)
    face = d.y > 0 ? 2 : 3, m = a.y, s = d.x, t = d.y > 0 ? d.z : -d.z;
  else
    face = d.z > 0 ? 4 : 5, m = a.z, s = d.z > 0 ? d.x : -d.x, t = -d.y;
  const float last = static_cast<float>(level.size - 1), half = 0.5f * static_cast<float>(level.size);
  const float x = glm::clamp((s / m + 1) * half - 0.5f, 0.0f, last),
              y = glm::clamp((t / m + 1) * half - 0.5f, 0.0f, last);
  const auto x0 = static_cast<std::uint32_t>(x), y0 = static_cast<std::uint32_t>(y);
  const std::uint32_t x1 = std::min(x0 + 1, level.size - 1), y1 = std::min(y0 + 1, level.size - 1);
  return glm::mix(glm::mix(level.at(face, x0, y0), level.at(face, x1, y0), x - static_cast<float>(x0)),
                  glm::mix(level.at(face, x0, y1), level.at(face, x1, y1), x - static_cast<float>(x0)),
                  y - static_cast<float>(y0));
}

// Calls paint(face, x, y) for every pixel.
template <class Paint>
void each_pixel(std::uint32_t size, const Paint& paint) {
  parallel_for(std::size_t{6} * size, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (std::uint32_t x = 0; x < size; ++x)
        paint(static_cast<unsigned>(row / size), x, static_cast<std::uint32_t>(row % size));
  });
}

// Level 0 from the panorama, four samples per pixel; then each level as the average of the previous one.
std::vector<CubeLevel> averaged(const Panorama& panorama, std::uint32_t face) {
  std::vector<CubeLevel> levels{{face, std::vector<vec3>(std::size_t{6} * face * face)}};
  each_pixel(face, [&](unsigned f, std::uint32_t x, std::uint32_t y) {
    vec3 sum(0);
    for (std::uint32_t k = 0; k < 4; ++k)
      sum += panorama_at(panorama, cube_direction(f, 2 * x + k % 2, 2 * y + k / 2, 2 * face));
    levels[0].at(f, x, y) = 0.25f * sum;
  });
  for (std::uint32_t size = face / 2; size >= 1; size /= 2) {
    CubeLevel level{size, std::vector<vec3>(std::size_t{6} * size * size)};
    const CubeLevel& fine = levels.back();
    for (unsigned f = 0; f < 6; ++f)
      for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x)
          level.at(f, x, y) = 0.25f * (fine.at(f, 2 * x, 2 * y) + fine.at(f, 2 * x + 1, 2 * y) +
                                       fine.at(f, 2 * x, 2 * y + 1) + fine.at(f, 2 * x + 1, 2 * y + 1));
    levels.push_back(std::move(level));
  }
  return levels;
}

struct Sample {
  vec3 way;         // [1] in a frame whose z is the coat's normal and the mirror direction
  float weight;     // [1]
  std::size_t lod;  // its pixels are about as large as the sample's share of the sphere
};

// Directions in which the coat's microfacets reflect an eye straight above it (Walter et al. 2007, eq. 35),
// low-discrepancy. Each reads a level as coarse as its density is low, which prevents fireflies from a small sun
// (Krivanek and Colbert, 2008).
std::vector<Sample> gathered(float roughness, std::uint32_t face, std::size_t levels) {
  std::vector<Sample> samples;
  const float alpha2 = std::pow(roughness, 4.0f);
  const float pixel = 4 * kPi / (6.0f * static_cast<float>(face) * static_cast<float>(face));  // [sr]
  for (std::uint32_t i = 0; i < kCubeSamples; ++i) {
    std::uint32_t bits = i;  // van der Corput: the bits of i, reversed behind the binary point
    float u = 0;
    for (float digit = 0.5f; bits; bits >>= 1, digit *= 0.5f) u += static_cast<float>(bits & 1u) * digit;
    const float phi = 2 * kPi * (static_cast<float>(i) + 0.5f) / static_cast<float>(kCubeSamples);
    const float cosine = std::sqrt((1 - u) / (1 + (alpha2 - 1) * u)),
                sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const vec3 h(sine * std::cos(phi), sine * std::sin(phi), cosine);
    const vec3 way = 2 * h.z * h - vec3(0, 0, 1);
    if (way.z <= 0) continue;
    const float d = cosine * cosine * (alpha2 - 1) + 1, density = alpha2 / (kPi * d * d) / 4;  // [1/sr]
    const float share = 1 / (static_cast<float>(kCubeSamples) * density);
    const float lod = std::round(std::max(0.0f, 0.5f * std::log2(share / pixel)));
    samples.push_back({way, way.z, std::min(static_cast<std::size_t>(lod), levels - 1)});
  }
  return samples;
}

CubeLevel filtered(const std::vector<CubeLevel>& levels, std::uint32_t size, float roughness) {
  const std::vector<Sample> samples = gathered(roughness, levels[0].size, levels.size());
  CubeLevel out{size, std::vector<vec3>(std::size_t{6} * size * size)};
  each_pixel(size, [&](unsigned face, std::uint32_t px, std::uint32_t py) {
    const vec3 z = cube_direction(face, px, py, size);
    const vec3 x = normalize(cross(std::abs(z.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0), z)), y = cross(z, x);
    vec3 sum(0);
    float weight = 0;
    for (const Sample& s : samples) {
      sum += s.weight * cube_at(levels[s.lod], s.way.x * x + s.way.y * y + s.way.z * z);
      weight += s.weight;
    }
    out.at(face, px, py) = sum / weight;
  });
  return out;
}

}  // namespace

std::size_t cube_size(std::uint32_t face) {
  std::size_t count = 0;
  for (std::uint32_t k = 0; k < kCubeLevels; ++k) count += std::size_t{18} * (face >> k) * (face >> k);
  return count;
}

vec3 cube_direction(unsigned face, std::uint32_t x, std::uint32_t y, std::uint32_t size) {
  const float s = (2 * static_cast<float>(x) + 1) / static_cast<float>(size) - 1;
  const float t = (2 * static_cast<float>(y) + 1) / static_cast<float>(size) - 1;
  const vec3 ways[6] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
  return normalize(ways[face]);
}

Panorama scaled_down(const Panorama& p, std::uint32_t widest) {
  const std::uint32_t block = (p.width + widest - 1) / widest;
  if (block <= 1) return p;
  Panorama small{.name = p.name, .width = p.width / block, .height = std::max(1u, p.height / block), .rgb = {}};
  small.rgb.reserve(std::size_t{3} * small.width * small.height);
  for (std::uint32_t y = 0; y < small.height; ++y)
    for (std::uint32_t x = 0; x < small.width; ++x) {
      vec3 sum(0);
      for (std::uint32_t j = 0; j < block; ++j)
        for (std::uint32_t i = 0; i < block; ++i) {
          const float* rgb = &p.rgb[3 * (std::size_t{std::min(y * block + j, p.height - 1)} * p.width + x * block + i)];
          sum += vec3(rgb[0], rgb[1], rgb[2]);
        }
      sum /= static_cast<float>(block * block);
      small.rgb.insert(small.rgb.end(), {sum.r, sum.g, sum.b});
    }
  return small;
}

Cube filtered_cube(const Panorama& panorama) {
  Cube cube;
  cube.face = std::bit_floor(std::clamp(panorama.width / 4, kSmallestFace, kLargestFace));
  const std::vector<CubeLevel> levels = averaged(scaled_down(panorama, 4 * kLargestFace), cube.face);
  cube.rgb.reserve(cube_size(cube.face));
  for (std::uint32_t k = 0; k < kCubeLevels; ++k) {
    const CubeLevel level = k ? filtered(levels, cube.face >> k, static_cast<float>(k) / (kCubeLevels - 1)) : levels[0];
    for (const vec3& c : level.pixels)
      for (int i = 0; i < 3; ++i) cube.rgb.push_back(glm::packHalf1x16(glm::clamp(c[i], 0.0f, kLargestHalf)));
  }
  return cube;
}

}  // namespace pliant
