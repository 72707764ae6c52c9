#include "player/verbs/panorama_preview.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr double kHalfTurn = 3.14159265358979323846;
constexpr double kMiddleGrey = 0.18;

// Position of a face in the cross, and its axes: centre, right and down.
struct Face {
  std::uint32_t column, row;
  dvec3 middle, right, down;
};
constexpr dvec3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};
const Face kFaces[6] = {{1, 0, kY, kX, kZ},   {0, 1, -kX, kZ, -kY},  {1, 1, kZ, kX, -kY},
                        {2, 1, kX, -kZ, -kY}, {3, 1, -kZ, -kX, -kY}, {1, 2, -kY, kX, -kZ}};

const float* pixel(const Panorama& panorama, std::int64_t x, std::int64_t y) {
  const std::int64_t w = panorama.width, h = panorama.height;
  x = (x % w + w) % w;
  y = std::clamp<std::int64_t>(y, 0, h - 1);
  return &panorama.rgb[static_cast<std::size_t>((y * w + x) * 3)];
}

// Bilinear, across the seam. The centre of the picture is the direction -Z.
dvec3 sample(const Panorama& panorama, dvec3 direction) {
  const dvec3 d = normalize(direction);
  const double u = 0.5 + std::atan2(d.x, -d.z) / (2 * kHalfTurn), v = std::acos(std::clamp(d.y, -1.0, 1.0)) / kHalfTurn;
  const double x = u * panorama.width - 0.5, y = v * panorama.height - 0.5;
  const auto x0 = static_cast<std::int64_t>(std::floor(x)), y0 = static_cast<std::int64_t>(std::floor(y));
  const double fx = x - static_cast<double>(x0), fy = y - static_cast<double>(y0);
  dvec3 sum(0);
  for (int i = 0; i < 4; ++i) {
    const float* p = pixel(panorama, x0 + (i & 1), y0 + (i >> 1));
    sum += dvec3(p[0], p[1], p[2]) * ((i & 1 ? fx : 1 - fx) * (i >> 1 ? fy : 1 - fy));
  }
  return sum;
}

double luminance(dvec3 c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

std::uint8_t encode(double linear) {
  const double x = linear / (1.0 + linear);
  const double s = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(std::clamp(s, 0.0, 1.0) * 255.0));
}

// Mean over the sphere: rows are weighted by the sine of their polar angle.
double mean_luminance(const Panorama& panorama) {
  double sum = 0.0, weight = 0.0;
  for (std::uint32_t y = 0; y < panorama.height; ++y) {
    const double w = std::sin(kHalfTurn * (y + 0.5) / panorama.height);
    for (std::uint32_t x = 0; x < panorama.width; ++x) {
      const float* p = pixel(panorama, x, y);
      sum += w * luminance(dvec3(p[0], p[1], p[2]));
    }
    weight += w * panorama.width;
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

}  // namespace

Image cube_cross(const Panorama& panorama, std::uint32_t face) {
  Image image{panorama.name, 4 * face, 3 * face, {}};
  image.rgba.assign(std::size_t{4} * image.width * image.height, 0);
  const double mean = mean_luminance(panorama);
  const double exposure = mean > 0.0 ? kMiddleGrey / mean : 1.0;
  for (const Face& f : kFaces) {
    for (std::uint32_t y = 0; y < face; ++y) {
      for (std::uint32_t x = 0; x < face; ++x) {
        const double right = 2 * (x + 0.5) / face - 1, down = 2 * (y + 0.5) / face - 1;
        const dvec3 color = exposure * sample(panorama, f.middle + right * f.right + down * f.down);
        std::uint8_t* out = &image.rgba[4 * ((f.row * face + y) * std::size_t{image.width} + f.column * face + x)];
        for (int i = 0; i < 3; ++i) out[i] = encode(color[i]);
        out[3] = 255;
      }
    }
  }
  return image;
}

}  // namespace pliant
