#include "systems/visual/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "systems/visual/coat.h"
#include "systems/visual/cube.h"
#include "systems/visual/viewpoint.h"

namespace pliant {
namespace {

constexpr std::uint32_t kWidest = 1024;              // [pixels] of the panorama: as sharp as the cube's faces
constexpr std::uint32_t kWidestForIrradiance = 256;  // [pixels]
constexpr float kSunClip = 20.0f;  // [1] of the mean: a brighter sun would make nine coefficients ring
constexpr float kPiOfSky = std::numbers::pi_v<float>;

float luminance(vec3 c) {
  return dot(c, vec3(0.2126f, 0.7152f, 0.0722f));
}

vec3 pixel(const Panorama& p, std::uint32_t x, std::uint32_t y) {
  const float* rgb = &p.rgb[3 * (std::size_t{y} * p.width + x)];
  return {rgb[0], rgb[1], rgb[2]};
}

// Unit direction through the middle of a pixel.
vec3 direction(const Panorama& p, std::uint32_t x, std::uint32_t y) {
  const float azimuth = 2 * kPiOfSky * ((static_cast<float>(x) + 0.5f) / static_cast<float>(p.width) - 0.5f);
  const float polar = kPiOfSky * (static_cast<float>(y) + 0.5f) / static_cast<float>(p.height);
  return {std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)};
}

// [sr] that a pixel of row y covers.
float solid_angle(const Panorama& p, std::uint32_t y) {
  const float step = kPiOfSky / static_cast<float>(p.height), top = step * static_cast<float>(y);
  return (std::cos(top) - std::cos(top + step)) * 2 * kPiOfSky / static_cast<float>(p.width);
}

// [1] Visibility of a soft, round-cornered light of angular size `size` [rad] about `center` in direction d.
float soft_box(vec3 d, vec3 center, float size) {
  return glm::smoothstep(std::cos(1.15f * size), std::cos(0.85f * size), dot(d, normalize(center)));
}

// A neutral studio: bright overhead, dark floor, a large soft light from the left and a small one behind on the right.
// Their reflections make curvature visible.
Panorama studio() {
  Panorama p{.name = "studio", .width = 256, .height = 128, .rgb = {}};
  const vec3 zenith(0.52f, 0.58f, 0.68f), horizon(0.36f, 0.37f, 0.40f), floor(0.07f, 0.072f, 0.085f);
  for (std::uint32_t y = 0; y < p.height; ++y)
    for (std::uint32_t x = 0; x < p.width; ++x) {
      const vec3 d = direction(p, x, y);
      vec3 c = d.y > 0 ? glm::mix(horizon, zenith, std::sqrt(d.y)) : glm::mix(horizon, floor, std::sqrt(-d.y));
      c += soft_box(d, {-0.8f, 0.62f, 0.30f}, 0.33f) * vec3(4.2f, 4.0f, 3.7f);
      c += soft_box(d, {0.75f, 0.55f, -0.55f}, 0.17f) * vec3(2.6f, 3.0f, 3.6f);
      p.rgb.insert(p.rgb.end(), {c.r, c.g, c.b});
    }
  return p;
}

// The direction of most light: the polynomial's linear part. Never from below, so that shapes are legible.
vec3 dominant_direction(const std::array<vec4, 9>& c, float rotation) {
  const vec3 p(luminance(c[3]), luminance(c[1]), luminance(c[2]));
  const float cosine = std::cos(rotation), sine = std::sin(rotation);
  vec3 d(cosine * p.x + sine * p.z, p.y, -sine * p.x + cosine * p.z);
  const float flat = length(vec2(d.x, d.z));
  // A sky without a dominant side: light from the left, low enough to show relief.
  if (flat < 0.2f * std::abs(d.y) || length(d) < 1e-6f) return normalize(vec3(-0.8f, 0.62f, 0.25f));
  d.y = glm::clamp(d.y, 0.6f * flat, 1.2f * flat);
  return normalize(d);
}

LampConstants lamp_of(const Light& light, const mat4& m) {
  const vec3 backward = normalize(vec3(m[2]));
  const bool placed = light.kind != Light::Kind::kDirectional;
  LampConstants lamp;
  lamp.place = placed ? vec4(vec3(m[3]), 1) : vec4(backward, 0);
  lamp.color = vec4(light.color * light.intensity, placed ? light.range : 0.0f);
  if (light.kind == Light::Kind::kSpot) {
    const float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
    const float scale = 1 / std::max(inner - outer, 1e-3f);
    lamp.axis = vec4(-backward, scale);
    lamp.more.x = -outer * scale;
  }
  return lamp;
}

// The level's lights, up to the GPU's limit; one that can cast a shadow first.
std::vector<LampConstants> level_lamps(const World& world) {
  std::vector<LampConstants> lamps;
  bool casts = false;
  for (auto [entity, light] : world.registry.view<Light>()) {
    const WorldTransform* transform = world.registry.find<WorldTransform>(entity);
    const LampConstants lamp = lamp_of(light, transform ? transform->matrix : mat4(1));
    const bool first = !casts && light.kind != Light::Kind::kPoint;
    casts = casts || first;
    lamps.insert(first ? lamps.begin() : lamps.end(), lamp);
  }
  if (lamps.size() > kMaxLamps) lamps.resize(kMaxLamps);
  return lamps;
}

}  // namespace

std::array<vec4, 9> irradiance_of(const Panorama& p) {
  double total = 0, sphere = 0;
  for (std::uint32_t y = 0; y < p.height; ++y)
    for (std::uint32_t x = 0; x < p.width; ++x) {
      total += luminance(pixel(p, x, y)) * solid_angle(p, y);
      sphere += solid_angle(p, y);
    }
  const float clip = kSunClip * static_cast<float>(total / sphere);

  // Projection on the real spherical harmonics of degree 0 to 2, each written without its constant.
  std::array<dvec3, 9> sums{};
  for (std::uint32_t y = 0; y < p.height; ++y)
    for (std::uint32_t x = 0; x < p.width; ++x) {
      const vec3 d = direction(p, x, y), radiance = pixel(p, x, y);
      const float bright = luminance(radiance);
      const dvec3 weighted = dvec3(radiance * (bright > clip ? clip / bright : 1.0f) * solid_angle(p, y));
      const double basis[9] = {
          1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
      for (int i = 0; i < 9; ++i) sums[i] += weighted * basis[i];
    }
  // Both factors of the harmonics' constants, times the cosine lobe's pi, 2 pi / 3, pi / 4 by degree.
  constexpr double pi = std::numbers::pi;
  const double a0 = pi / (4 * pi), a1 = 2 * pi / 3 * 3 / (4 * pi), a2 = pi / 4 * 15 / (4 * pi);
  const double factors[9] = {a0, a1, a1, a1, a2, a2, a2 / 12, a2, a2 / 4};
  std::array<vec4, 9> coefficients;
  for (int i = 0; i < 9; ++i) coefficients[i] = vec4(vec3(sums[i] * factors[i]), 0);
  return coefficients;
}

vec3 irradiance_on(const std::array<vec4, 9>& c, vec3 n) {
  return vec3(c[0] + c[1] * n.y + c[2] * n.z + c[3] * n.x + c[4] * (n.x * n.y) + c[5] * (n.y * n.z) +
              c[6] * (3 * n.z * n.z - 1) + c[7] * (n.x * n.z) + c[8] * (n.x * n.x - n.y * n.y));
}

Surroundings Surroundings::make(const World& world) {
  const Environment& environment = world.environment;
  const bool own = environment.panorama.width > 0 && environment.panorama.height > 0;
  const Panorama panorama = own ? scaled_down(environment.panorama, kWidest) : studio();
  const float intensity = own ? environment.intensity : 1.0f, rotation = own ? environment.rotation : 0.0f;

  Surroundings made;
  const Cube cube = cached_cube(panorama);
  constexpr int kCoatSize = 32;
  made.coat_ = gpu::Texture::from_table(coat_table(kCoatSize), kCoatSize);
  made.cube_ = gpu::Texture::from_cube(cube.rgb, static_cast<int>(cube.face), static_cast<int>(kCubeLevels));
  FrameConstants& frame = made.constants_;
  frame.irradiance = irradiance_of(scaled_down(panorama, kWidestForIrradiance));
  frame.surroundings = vec4(std::cos(rotation), std::sin(rotation), intensity, kCubeLevels - 1);
  // A studio is dimmed and out of focus, so that the scene is prominent. The level's surroundings are shown unchanged.
  frame.picture.y = own ? 1.0f : 0.6f;
  frame.picture.w = own ? 0.0f : 0.3f;

  // Without lights in the level, a key light is placed at the surroundings' brightest side; the surroundings provide
  // the fill light.
  const float ambient = std::max(0.0f, intensity * luminance(frame.irradiance[0]));
  std::vector<LampConstants> lamps = level_lamps(world);
  if (lamps.empty()) {
    lamps.emplace_back();
    lamps[0].place = vec4(dominant_direction(frame.irradiance, rotation), 0);
    lamps[0].color = vec4(vec3(1.0f, 0.96f, 0.9f) * std::max(2.6f * ambient, 1e-3f), 0);
  }
  std::copy(lamps.begin(), lamps.end(), frame.lamps.begin());
  frame.modes.x = static_cast<std::uint32_t>(lamps.size());

  // Exposed for a white sheet in the middle of the scene facing the key light.
  const Box box = drawn_box(world, false);
  const LampConstants& key = frame.lamps[0];
  const vec3 way = vec3(key.place) - (box.empty() ? vec3(0) : box.center());
  const float lux = luminance(vec3(key.color)) / (key.place.w > 0 ? std::max(dot(way, way), 1e-8f) : 1.0f);
  frame.picture.x = 0.7f * kPiOfSky / std::max(lux + ambient, 1e-6f);
  return made;
}

void Surroundings::light(FrameConstants& frame) const {
  frame.lamps = constants_.lamps;
  frame.irradiance = constants_.irradiance;
  frame.surroundings = constants_.surroundings;
  frame.picture = constants_.picture;
  frame.modes.x = constants_.modes.x;
}

}  // namespace pliant
