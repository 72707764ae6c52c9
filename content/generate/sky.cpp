#include "content/generate/sky.h"

#include <ImfRgbaFile.h>

#include <cmath>
#include <numbers>

namespace pliant::generate {
namespace {

double luminance(dvec3 c) {
  return dot(c, dvec3(0.2126, 0.7152, 0.0722));
}

dvec3 radiance(dvec3 d) {
  const dvec3 to_sun = normalize(dvec3(0.55, 0.62, 0.56));
  const dvec3 horizon(0.95, 0.93, 0.90), zenith(0.28, 0.45, 0.80), ground(0.30, 0.27, 0.24);
  const double up = glm::clamp(d.y, 0.0, 1.0), down = glm::clamp(-d.y, 0.0, 1.0);
  const dvec3 above = glm::mix(zenith, horizon, std::exp(-3.5 * up));
  const dvec3 below = glm::mix(ground, horizon * 0.7, std::exp(-7.0 * down));
  const dvec3 backdrop = glm::mix(below, above, glm::smoothstep(-0.03, 0.03, d.y));
  const double c = dot(d, to_sun), away = std::acos(glm::clamp(c, -1.0, 1.0));
  const double disc = 60.0 * (1.0 - glm::smoothstep(0.05, 0.09, away));  // [rad] soft rim, a few texels wide
  const double glow = 1.6 * std::exp(-away / 0.22) + 0.35 * std::exp(-away / 0.8);
  return backdrop + dvec3(1.0, 0.93, 0.80) * (disc + glow * glm::smoothstep(-0.2, 0.1, d.y));
}

// [0, 1] Cloud density in this direction: layered waves on a plane above, fading towards the horizon.
double cloud(dvec3 d) {
  if (d.y <= 0.0) return 0.0;
  const glm::dvec2 q = glm::dvec2(d.x, d.z) / (d.y + 0.12);
  double sum = 0.0, amplitude = 1.0, x = 1.3 * q.x + 0.4, z = 1.3 * q.y;
  for (int i = 0; i < 5; ++i, amplitude *= 0.55) {
    sum += amplitude * std::sin(x + 1.2 * std::sin(0.8 * z + i)) * std::cos(z + 1.1 * std::sin(0.9 * x - i));
    const double turned = 1.6 * x - 1.1 * z;
    z = 1.1 * x + 1.6 * z + 3.7;
    x = turned;
  }
  return glm::smoothstep(0.05, 0.75, sum) * glm::smoothstep(0.02, 0.25, d.y);
}

// Pale and dark stone tiles, faded where they are too small to resolve.
dvec3 floor_tiles(dvec3 d) {
  const glm::dvec2 q = glm::dvec2(d.x, d.z) / -d.y * 1.1;  // in tiles, from a point above the floor
  const double far = length(q), edge = std::min(0.9, 0.03 * (1.0 + 0.15 * far * far));
  auto wave = [&](double x) {
    const double s = std::sin(std::numbers::pi * (x + 0.5));
    return glm::smoothstep(-edge, edge, s) * 2.0 - 1.0;
  };
  const double tile = 0.5 + 0.5 * wave(q.x) * wave(q.y) * std::exp(-0.012 * far * far);
  return glm::mix(dvec3(0.10, 0.075, 0.065), dvec3(0.62, 0.55, 0.46), tile);
}

dvec3 terrace_radiance(dvec3 d) {
  const dvec3 open = radiance(d);
  if (d.y >= 0.0) return glm::mix(open, dvec3(1.25, 1.2, 1.15), 0.85 * cloud(d) * (luminance(open) < 4.0 ? 1.0 : 0.0));
  return glm::mix(floor_tiles(d), dvec3(0.75, 0.74, 0.74), std::exp(d.y / 0.035));
}

Panorama painted(const char* name, std::uint32_t width, dvec3 (*seen)(dvec3)) {
  Panorama panorama{name, width, width / 2, {}};
  for (std::uint32_t y = 0; y < panorama.height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const double azimuth = (x + 0.5) / width * 2.0 * std::numbers::pi;
      const double polar = (y + 0.5) / panorama.height * std::numbers::pi;
      const dvec3 d(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth));
      for (int i = 0; i < 3; ++i) panorama.rgb.push_back(static_cast<float>(seen(d)[i]));
    }
  return panorama;
}

}  // namespace

Panorama sky(std::uint32_t width) {
  return painted("sky", width, radiance);
}

Panorama terrace(std::uint32_t width) {
  return painted("terrace", width, terrace_radiance);
}

Status save_panorama(const Panorama& panorama, const std::filesystem::path& path) {
  std::vector<Imf::Rgba> pixels;
  for (std::size_t i = 0; i < panorama.rgb.size(); i += 3)
    pixels.emplace_back(panorama.rgb[i], panorama.rgb[i + 1], panorama.rgb[i + 2], 1.0f);
  try {
    Imf::RgbaOutputFile file(path.c_str(), static_cast<int>(panorama.width), static_cast<int>(panorama.height),
                             Imf::WRITE_RGB, 1.0f, Imath::V2f(0), 1.0f, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    file.setFrameBuffer(pixels.data(), 1, panorama.width);
    file.writePixels(static_cast<int>(panorama.height));
  } catch (const std::exception& e) {  // the library reports errors only by exceptions
    return Error{path.string(), std::string("cannot be written (") + e.what() + ")",
                 "check the folder and its permissions"};
  }
  return Done{};
}

}  // namespace pliant::generate
