// The filtered environment: against closed forms and a brute-force reference, and its cache on disk.
#include "systems/visual/cube.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "systems/visual/gpu/staging.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
constexpr double kPi = std::numbers::pi;

dvec3 panorama_direction(const Panorama& p, std::uint32_t x, std::uint32_t y) {
  const double azimuth = 2 * kPi * ((x + 0.5) / p.width - 0.5), polar = kPi * (y + 0.5) / p.height;
  return {std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)};
}

template <class Radiance>
Panorama panorama_of(std::uint32_t width, Radiance radiance) {
  Panorama p{.name = "made", .width = width, .height = width / 2, .rgb = {}};
  for (std::uint32_t y = 0; y < p.height; ++y)
    for (std::uint32_t x = 0; x < p.width; ++x) {
      const dvec3 c = radiance(panorama_direction(p, x, y));
      for (int i = 0; i < 3; ++i) p.rgb.push_back(static_cast<float>(c[i]));
    }
  return p;
}

// A bright lobe low on the right and a dim one behind, over a gradient.
dvec3 lobes(dvec3 d) {
  const double a = std::exp(-12 * (1 - dot(d, normalize(dvec3(0.8, 0.3, -0.4)))));
  const double b = std::exp(-6 * (1 - dot(d, normalize(dvec3(-0.5, -0.2, 0.8)))));
  return dvec3(0.3 + 0.2 * d.y) + 4.0 * a * dvec3(1, 0.8, 0.5) + b * dvec3(0.2, 0.4, 1.0);
}

vec3 pixel_of(const Cube& cube, std::uint32_t level, unsigned face, std::uint32_t x, std::uint32_t y) {
  std::size_t first = 0;
  for (std::uint32_t k = 0; k < level; ++k) first += std::size_t{18} * (cube.face >> k) * (cube.face >> k);
  const std::uint32_t size = cube.face >> level;
  const std::uint16_t* rgb = &cube.rgb[first + 3 * ((std::size_t{face} * size + y) * size + x)];
  return {glm::unpackHalf1x16(rgb[0]), glm::unpackHalf1x16(rgb[1]), glm::unpackHalf1x16(rgb[2])};
}

TEST(Cube, SharpestLevelIsThePanorama) {
  const Cube cube = filtered_cube(panorama_of(512, lobes));
  ASSERT_EQ(cube.face, 128u);
  ASSERT_EQ(cube.rgb.size(), cube_size(cube.face));
  for (unsigned face = 0; face < 6; ++face)
    for (std::uint32_t y = 1; y < cube.face; y += 21)
      for (std::uint32_t x = 2; x < cube.face; x += 21) {
        const dvec3 expected = lobes(cube_direction(face, x, y, cube.face));
        EXPECT_LT(length(dvec3(pixel_of(cube, 0, face, x, y)) - expected), 0.01 * length(expected) + 0.01);
      }
}

TEST(Cube, EvenSurroundingsStayEvenAtEveryRoughness) {
  const Cube cube = filtered_cube(panorama_of(64, [](dvec3) { return dvec3(1, 0.5, 0.25); }));
  for (std::size_t i = 0; i < cube.rgb.size(); ++i)
    ASSERT_NEAR(glm::unpackHalf1x16(cube.rgb[i]), i % 3 == 0 ? 1.0f : i % 3 == 1 ? 0.5f : 0.25f, 1e-3f) << i;
}

TEST(Cube, EveryLevelIsTheIntegralOverTheCoatsLobe) {
  const Panorama panorama = panorama_of(256, lobes);
  const Cube cube = filtered_cube(panorama);
  for (std::uint32_t level = 2; level < kCubeLevels; ++level) {
    const double roughness = double(level) / (kCubeLevels - 1), alpha2 = std::pow(roughness, 4.0);
    const std::uint32_t size = cube.face >> level;
    for (unsigned face = 0; face < 6; ++face) {
      const dvec3 n = cube_direction(face, size / 2, size / 3, size);
      // Over every pixel of the panorama: radiance times the lobe's density times n.l, eye right above.
      dvec3 sum(0);
      double weight = 0;
      for (std::uint32_t y = 0; y < panorama.height; ++y)
        for (std::uint32_t x = 0; x < panorama.width; ++x) {
          const dvec3 l = panorama_direction(panorama, x, y);
          const double n_l = dot(n, l);
          if (n_l <= 0) continue;
          const double n_h = dot(n, normalize(n + l)), d = n_h * n_h * (alpha2 - 1) + 1;
          const double w = n_l * alpha2 / (d * d) * std::sin(kPi * (y + 0.5) / panorama.height);
          sum += w * lobes(l);
          weight += w;
        }
      const dvec3 expected = sum / weight, found(pixel_of(cube, level, face, size / 2, size / 3));
      EXPECT_LT(length(found - expected), 0.06 * length(expected)) << level << ' ' << face;
    }
  }
}

class CubeCache : public testing::Test {
 protected:
  CubeCache() : folder_(fs::path(testing::TempDir()) / ("pliant_cube_cache_" + std::to_string(::getpid()))) {
    const char* before = std::getenv("XDG_CACHE_HOME");
    had_ = before != nullptr;
    if (before) before_ = before;
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  }
  ~CubeCache() override {
    if (had_)
      setenv("XDG_CACHE_HOME", before_.c_str(), 1);
    else
      unsetenv("XDG_CACHE_HOME");
    fs::remove_all(folder_);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    if (fs::exists(folder_ / "pliant"))
      for (const auto& entry : fs::directory_iterator(folder_ / "pliant")) found.push_back(entry.path());
    return found;
  }
  fs::path folder_;
  std::string before_;
  bool had_ = false;
};

TEST_F(CubeCache, WhatIsKeptIsWhatWasMadeAndIsReadTheNextTime) {
  const Panorama panorama = panorama_of(64, lobes);
  const Cube made = cached_cube(panorama);
  EXPECT_EQ(made.rgb, filtered_cube(panorama).rgb);
  ASSERT_EQ(files().size(), 1u);  // and no partial file beside it
  const auto written = fs::last_write_time(files()[0]);
  EXPECT_EQ(cached_cube(panorama).rgb, made.rgb);
  EXPECT_EQ(fs::last_write_time(files()[0]), written);
  cached_cube(panorama_of(64, [](dvec3) { return dvec3(1); }));
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(CubeCache, AFileThatIsCutChangedOrForeignIsMadeAgain) {
  const Panorama panorama = panorama_of(64, lobes);
  const Cube made = cached_cube(panorama);
  ASSERT_EQ(files().size(), 1u);
  const fs::path path = files()[0];
  const auto size = fs::file_size(path);
  for (const std::uintmax_t kept : {std::uintmax_t{0}, std::uintmax_t{20}, std::uintmax_t{32}, size - 1, size + 1}) {
    fs::resize_file(path, kept);
    EXPECT_EQ(cached_cube(panorama).rgb, made.rgb) << kept;
    EXPECT_EQ(fs::file_size(path), size);
  }
  for (const std::streamoff at : {0, 8, 12, 16, 24, 40, 5000}) {
    {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      file.seekg(at);
      const char other = static_cast<char>(file.get() ^ 0x5a);
      file.seekp(at);
      file.put(other);
    }
    EXPECT_EQ(cached_cube(panorama).rgb, made.rgb) << at;
  }
}

TEST_F(CubeCache, WithoutAPlaceToWriteItIsMadeEveryTime) {
  const Panorama panorama = panorama_of(64, lobes);
  std::ofstream(folder_ / "pliant") << "a file where the folder should be";
  EXPECT_EQ(cached_cube(panorama).rgb, filtered_cube(panorama).rgb);
}

TEST(Staging, WhatIsLargerThanItsPartsArrivesWholeAndInOrder) {
  NEEDS_A_CONTEXT();
  constexpr std::size_t kBytes = 1000;
  const gpu::Buffer target = gpu::Buffer::writable(nullptr, kBytes);
  gpu::Staging staging(64);
  std::vector<std::uint8_t> expected(kBytes);
  for (std::size_t turn = 0; turn < 9; ++turn) {
    const std::size_t first = 37 * turn, count = kBytes - 2 * first;
    for (std::size_t i = 0; i < count; ++i) expected[first + i] = static_cast<std::uint8_t>(i * 7 + turn);
    EXPECT_EQ(staging.send(target, first, &expected[first], count), count);
    staging.finish();
  }
  std::vector<std::uint8_t> found(kBytes);
  glGetNamedBufferSubData(target.id(), 0, kBytes, found.data());
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace pliant
