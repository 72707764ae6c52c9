// Heights of a map: slopes integrated by a Fourier transform, and levels of half the texels (relief_map.h).
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "content/mesh/relief_map.h"
#include "runtime/long_work.h"

namespace pliant {
namespace {

constexpr double kFeltShare = 0.05;  // [1] of a relief's r.m.s.: what a hand does not miss

using Complex = std::complex<double>;

// Radix 2, in place, over a stride (Cooley & Tukey 1965). `back`: the inverse without its factor.
void fourier(Complex* x, std::size_t n, std::size_t stride, bool back) {
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i * stride], x[j * stride]);
  }
  for (std::size_t length = 2; length <= n; length <<= 1) {
    const double angle = (back ? 2 : -2) * std::numbers::pi / static_cast<double>(length);
    std::vector<Complex> turn(length / 2);
    for (std::size_t k = 0; k < turn.size(); ++k)
      turn[k] = {std::cos(angle * static_cast<double>(k)), std::sin(angle * static_cast<double>(k))};
    for (std::size_t i = 0; i < n; i += length)
      for (std::size_t k = 0; k < length / 2; ++k) {
        Complex &a = x[(i + k) * stride], &b = x[(i + k + length / 2) * stride];
        const Complex low = a, high = b * turn[k];
        a = low + high;
        b = low - high;
      }
  }
}

void fourier_2d(std::vector<Complex>& x, std::size_t width, std::size_t height, bool back) {
  for (std::size_t row = 0; row < height; ++row) fourier(&x[row * width], width, 1, back);
  for (std::size_t column = 0; column < width; ++column) fourier(&x[column], height, width, back);
}

}  // namespace

std::vector<float> integrate_slopes(std::uint32_t width, std::uint32_t height, const std::vector<vec2>& slope,
                                    bool repeats) {
  const std::size_t w = repeats ? width : 2 * std::size_t{width}, h = repeats ? height : 2 * std::size_t{height};
  // The differences that are wanted between a texel and the next: the mean of both slopes; mirrored, they change sign.
  const auto at = [&](std::size_t x, std::size_t y) {
    const bool turned_x = x >= width, turned_y = y >= height;
    const vec2 s = slope[(turned_y ? h - 1 - y : y) * width + (turned_x ? w - 1 - x : x)];
    return dvec2(turned_x ? -s.x : s.x, turned_y ? -s.y : s.y);
  };
  const auto rise = [&](std::size_t x, std::size_t y) {
    const dvec2 here = at(x, y);
    return dvec2(0.5 * (here.x + at((x + 1) % w, y).x), 0.5 * (here.y + at(x, (y + 1) % h).y));
  };
  std::vector<Complex> field(w * h);
  for (std::size_t y = 0; y < h; ++y)
    for (std::size_t x = 0; x < w; ++x)
      field[y * w + x] = rise(x, y).x - rise((x + w - 1) % w, y).x + rise(x, y).y - rise(x, (y + h - 1) % h).y;
  check_in();
  fourier_2d(field, w, h, false);
  check_in();
  for (std::size_t y = 0; y < h; ++y)
    for (std::size_t x = 0; x < w; ++x) {
      const auto part = [](std::size_t k, std::size_t n) {
        return 2 - 2 * std::cos(2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
      };
      const double divisor = part(x, w) + part(y, h);
      field[y * w + x] = x + y == 0 ? Complex(0) : -field[y * w + x] / (divisor * static_cast<double>(w * h));
    }
  fourier_2d(field, w, h, true);
  check_in();
  std::vector<float> out(std::size_t{width} * height);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) out[y * width + x] = static_cast<float>(field[y * w + x].real());
  return out;
}

std::vector<HeightMap> height_levels(std::uint32_t width, std::uint32_t height, std::vector<float> heights,
                                     bool repeats, double texel) {
  const auto neighbour = [repeats](std::uint32_t i, int step, std::uint32_t n) {
    const std::int64_t k = static_cast<std::int64_t>(i) + step;
    return static_cast<std::uint32_t>(repeats ? (k + 8 * std::int64_t{n}) % n : std::clamp<std::int64_t>(k, 0, n - 1));
  };
  std::vector<HeightMap> levels;
  float highest = 0.0f;  // of the spline of the finest: the coarser are below
  for (;;) {
    HeightMap map;
    map.width = width;
    map.height = height;
    map.repeats_u = map.repeats_v = repeats;
    map.wavelength = 2 * texel;
    // The coefficients whose spline passes through the heights: the spline's matrix is near the identity.
    map.coefficient = heights;
    std::vector<float> across(heights.size());
    for (int pass = 0; pass < 16; ++pass) {
      const std::vector<float>& c = map.coefficient;
      for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
          const std::size_t row = std::size_t{y} * width;
          across[row + x] =
              0.75f * c[row + x] + 0.125f * (c[row + neighbour(x, -1, width)] + c[row + neighbour(x, 1, width)]);
        }
      for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
          const std::size_t i = std::size_t{y} * width + x;
          const float value = 0.75f * across[i] + 0.125f * (across[std::size_t{neighbour(y, -1, height)} * width + x] +
                                                            across[std::size_t{neighbour(y, 1, height)} * width + x]);
          map.coefficient[i] += heights[i] - value;
        }
      check_in();
    }
    if (levels.empty()) highest = *std::max_element(map.coefficient.begin(), map.coefficient.end());
    levels.push_back(std::move(map));
    if (width % 2 != 0 || height % 2 != 0 || std::min(width, height) <= 4) break;
    // The next level: Lanczos' kernel of two lobes, both ways. It keeps what the level can hold, and little aliases.
    constexpr std::array<double, 8> kWeight{-0.0089, -0.0420, 0.1164, 0.4345, 0.4345, 0.1164, -0.0420, -0.0089};
    std::vector<float> half(std::size_t{width / 2} * (height / 2));
    for (std::uint32_t y = 0; y < height / 2; ++y)
      for (std::uint32_t x = 0; x < width / 2; ++x) {
        double sum = 0.0;
        for (int j = 0; j < 8; ++j) {
          const float* const row = &heights[std::size_t{neighbour(2 * y, j - 3, height)} * width];
          for (int i = 0; i < 8; ++i)
            sum += kWeight[static_cast<std::size_t>(j)] * kWeight[static_cast<std::size_t>(i)] *
                   static_cast<double>(row[neighbour(2 * x, i - 3, width)]);
        }
        half[std::size_t{y} * (width / 2) + x] = static_cast<float>(sum);
      }
    heights = std::move(half);
    width /= 2;
    height /= 2;
    texel *= 2;
  }
  // The part of the level before it that a level lacks, against the whole relief.
  for (std::size_t n = 0; n + 1 < levels.size(); ++n) {
    double lacks = 0.0, mean = 0.0, squares = 0.0;
    constexpr std::size_t kPlaces = 64;  // a side
    for (std::size_t i = 0; i < kPlaces * kPlaces; ++i) {
      const dvec2 uv((static_cast<double>(i % kPlaces) + 0.3) / kPlaces,
                     (static_cast<double>(i / kPlaces) + 0.7) / kPlaces);
      const double fine = levels[n].at(uv).height, difference = fine - levels[n + 1].at(uv).height;
      lacks += difference * difference;
      mean += fine / (kPlaces * kPlaces);
      squares += fine * fine / (kPlaces * kPlaces);
    }
    const double whole = squares - mean * mean;
    levels[n].finer = lacks / (kPlaces * kPlaces) > kFeltShare * kFeltShare * whole;
  }
  for (HeightMap& map : levels)
    for (float& c : map.coefficient) c -= highest;
  return levels;
}

}  // namespace pliant
