#include "content/generate/sky.h"

#include <ImfRgbaFile.h>

#include <cmath>
#include <numbers>

namespace pliant::generate {
namespace {

dvec3 radiance(dvec3 d) {
  const dvec3 to_sun = normalize(dvec3(0.55, 0.62, 0.56));
  const dvec3 horizon(0.95, 0.93, 0.90), zenith(0.28, 0.45, 0.80), ground(0.30, 0.27, 0.24);
  const double up = glm::clamp(d.y, 0.0, 1.0), down = glm::clamp(-d.y, 0.0, 1.0);
  const dvec3 above = glm::mix(zenith, horizon, std::exp(-3.5 * up));
  const dvec3 below = glm::mix(ground, horizon * 0.7, std::exp(-7.0 * down));
  const dvec3 backdrop = glm::mix(below, above, glm::smoothstep(-0.03, 0.03, d.y));
  const double c = dot(d, to_sun), away = std::acos(glm::clamp(c, -1.0, 1.0));
  const double disc = 60.0 * (1.0 - glm::smoothstep(0.05, 0.09, away));  // [rad] soft rim: few texels wide
  const double glow = 1.6 * std::exp(-away / 0.22) + 0.35 * std::exp(-away / 0.8);
  return backdrop + dvec3(1.0, 0.93, 0.80) * (disc + glow * glm::smoothstep(-0.2, 0.1, d.y));
}

}  // namespace

Panorama sky(std::uint32_t width) {
  Panorama panorama{"sky", width, width / 2, {}};
  for (std::uint32_t y = 0; y < panorama.height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const double azimuth = (x + 0.5) / width * 2.0 * std::numbers::pi;
      const double polar = (y + 0.5) / panorama.height * std::numbers::pi;
      const dvec3 d(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth));
      for (int i = 0; i < 3; ++i) panorama.rgb.push_back(static_cast<float>(radiance(d)[i]));
    }
  return panorama;
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
  } catch (const std::exception& e) {  // the library's only way to fail
    return Error{path.string(),
                 std::string("cannot be written (") + e.what() + "); check the folder and its permissions"};
  }
  return Done{};
}

}  // namespace pliant::generate
