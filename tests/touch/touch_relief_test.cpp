// Drawn relief that is felt (methods.md 1.11): the same heights for the eye and the hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "content/mesh/mesh_build.h"
#include "content/mesh/relief_map.h"
#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/model/relief.h"

namespace pliant {
namespace {

constexpr double kRound = 2 * std::numbers::pi;
constexpr double kSheet = 0.1;    // [m]
constexpr double kRipple = 1e-3;  // [m] amplitude
constexpr int kAlongU = 5, kAlongV = 3;

double ripple(double u, double v) {
  return kRipple * std::sin(kRound * (kAlongU * u + kAlongV * v) + 0.4);
}
dvec2 ripple_slope(double u, double v) {  // [m] by the coordinates
  return kRipple * kRound * std::cos(kRound * (kAlongU * u + kAlongV * v) + 0.4) * dvec2(kAlongU, kAlongV);
}

// A sheet whose coordinates are turned and, maybe, mirrored against its plane. [m] of the coordinates' unit: `size`.
Primitive mapped_sheet(bool mirrored, double tiles = 1.0) {
  Primitive out = scenes::sheet(20, kSheet);
  out.uv.clear();
  for (const vec3& p : out.position) {
    const double x = static_cast<double>(p.x) / kSheet + 0.5, z = static_cast<double>(p.z) / kSheet + 0.5;
    out.uv.push_back(vec2(tiles * (mirrored ? 1 - z : z), tiles * x));
  }
  out.normal.assign(out.position.size(), vec3(0, 1, 0));
  out.material = 0;
  return out;
}

Image normal_map(std::uint32_t size, dvec3 by_u, dvec3 by_v, const DrawVertex& vertex) {
  Image out{"n", size, size, {}};
  const dvec3 n(vertex.normal), t(vertex.tangent), b = static_cast<double>(vertex.tangent.w) * cross(n, t);
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const dvec2 slope = ripple_slope((x + 0.5) / size, (y + 0.5) / size);
      // The gradient over the surface, whose products with by_u and by_v are the slopes; those are orthogonal here.
      const dvec3 g = slope.x * by_u / dot(by_u, by_u) + slope.y * by_v / dot(by_v, by_v);
      const dvec3 m = normalize(dvec3(-dot(g, t), -dot(g, b), 1.0));
      for (int k = 0; k < 3; ++k) out.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * (0.5 + 0.5 * m[k]))));
      out.rgba.push_back(255);
    }
  return out;
}

// The slopes that bump.glsl makes of the map at (u, v): slopes along tangent and bitangent, bilinear, repeated.
dvec2 drawn_slope(const Image& image, double u, double v) {
  const double x = u * image.width - 0.5, y = v * image.height - 0.5;
  dvec3 m(0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double column = std::floor(x) + i, row = std::floor(y) + j;
      const double weight = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
      const auto wrap = [](double k, std::uint32_t n) { return static_cast<std::size_t>(k - n * std::floor(k / n)); };
      const std::size_t at = 4 * (wrap(row, image.height) * image.width + wrap(column, image.width));
      for (int k = 0; k < 3; ++k) m[k] += weight * (2 * image.rgba[at + static_cast<std::size_t>(k)] / 255.0 - 1);
    }
  return dvec2(-m.x / m.z, -m.y / m.z);
}

struct Rippled {
  BuiltMesh built;
  std::vector<Image> images;
  std::vector<Material> materials;
  ReliefMaps maps;
};
Rippled rippled(bool mirrored, bool as_heights) {
  const Primitive sheet = mapped_sheet(mirrored);
  Rippled out{*build_mesh("sheet", {&sheet, 1}, mat4(1)), {}, {Material{}}, {}};
  const std::vector<DrawVertex>& drawn = out.built.draw.vertices;
  const dvec3 by_u(0, 0, mirrored ? -kSheet : kSheet), by_v(kSheet, 0, 0);
  if (as_heights) {
    Image image{"h", 128, 128, {}};
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 128; ++x) {
        const double h = 0.5 + 0.5 * ripple((x + 0.5) / 128, (y + 0.5) / 128) / kRipple;
        for (int k = 0; k < 4; ++k) image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * h)));
      }
    out.images = {image};
    out.materials[0].height_texture = 0;
    out.materials[0].height_scale = static_cast<float>(2 * kRipple);
  } else {
    out.images = {normal_map(128, by_u, by_v, drawn.at(0))};
    out.materials[0].normal_texture = 0;
  }
  out.maps = relief_maps(out.built.mesh, out.built.draw, out.materials, out.images);
  return out;
}

TEST(ReliefMap, SlopesBecomeTheHeightsTheyAreOfWhetherTheMapRepeatsOrNot) {
  for (const bool repeats : {true, false}) {
    constexpr std::uint32_t kWide = 128, kHigh = 64;
    const auto height = [&](double x, double y) {
      if (repeats) return std::sin(kRound * 4 * x) * std::cos(kRound * 2 * y);
      return std::exp(-30 * ((x - 0.2) * (x - 0.2) + (y - 0.7) * (y - 0.7))) + 0.5 * x;
    };
    std::vector<vec2> slope;
    for (std::uint32_t j = 0; j < kHigh; ++j)
      for (std::uint32_t i = 0; i < kWide; ++i) {
        const double x = (i + 0.5) / kWide, y = (j + 0.5) / kHigh, e = 1e-6;
        slope.push_back(vec2(static_cast<float>((height(x + e, y) - height(x - e, y)) / (2 * e) / kWide),
                             static_cast<float>((height(x, y + e) - height(x, y - e)) / (2 * e) / kHigh)));
      }
    const std::vector<float> found = integrate_slopes(kWide, kHigh, slope, repeats);
    double mean = 0.0;
    for (std::uint32_t i = 0; i < found.size(); ++i)
      mean += height((i % kWide + 0.5) / kWide, (i / kWide + 0.5) / kHigh) / static_cast<double>(found.size());
    for (std::uint32_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(static_cast<double>(found[i]), height((i % kWide + 0.5) / kWide, (i / kWide + 0.5) / kHigh) - mean,
                  0.01);
  }
}

TEST(ReliefMap, IsC1AndPassesThroughItsHeights) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(0, 1e-3f);
  std::vector<float> heights(32 * 16);
  for (float& h : heights) h = u(random);
  for (const bool repeats : {true, false}) {
    const HeightMap map = height_levels(32, 16, heights, repeats, 1e-4).front();
    const double offset = map.at({0.5 / 32, 0.5 / 16}).height - static_cast<double>(heights[0]);
    for (std::uint32_t i = 0; i < heights.size(); ++i)
      EXPECT_NEAR(map.at({(i % 32 + 0.5) / 32, (i / 32 + 0.5) / 16}).height, static_cast<double>(heights[i]) + offset,
                  2e-5);
    for (int n = 0; n < 200; ++n) {
      const dvec2 at(static_cast<double>(u(random)) * 2e3 - 0.5, static_cast<double>(u(random)) * 2e3 - 0.5);
      const HeightMap::Sample s = map.at(at);
      EXPECT_LE(s.height, 1e-12);
      EXPECT_NEAR(s.slope.x, (map.at(at + dvec2(1e-7, 0)).height - map.at(at - dvec2(1e-7, 0)).height) / 2e-7, 1e-5);
      EXPECT_NEAR(s.slope.y, (map.at(at + dvec2(0, 1e-7)).height - map.at(at - dvec2(0, 1e-7)).height) / 2e-7, 1e-5);
    }
    for (const double border : {5.0 / 32, 16.0 / 32})
      EXPECT_NEAR(map.at({border - 1e-9, 0.3}).slope.x, map.at({border + 1e-9, 0.3}).slope.x, 1e-6);
  }
}

TEST(ReliefMap, TheHandFeelsTheSlopesThatTheEyeSees) {
  for (const bool mirrored : {false, true})
    for (const bool as_heights : {false, true}) {
      const Rippled r = rippled(mirrored, as_heights);
      ASSERT_TRUE(r.maps.relief);
      EXPECT_EQ(r.maps.faded, 0.0);
      const HeightMap& map = r.maps.relief->maps.at(0).at(0);
      // Eight bits are 3 % of the steepest slope between two texels of a height map, 1 % in a normal map.
      const double steepest = kRipple * kRound * kAlongU;
      std::mt19937 random(1);
      std::uniform_real_distribution<double> u(0.1, 0.9);
      const dvec3 by_u(0, 0, mirrored ? -kSheet : kSheet), by_v(kSheet, 0, 0);
      const DrawVertex& vertex = r.built.draw.vertices[0];
      const dvec3 n(vertex.normal), t(vertex.tangent), b = static_cast<double>(vertex.tangent.w) * cross(n, t);
      for (int i = 0; i < 300; ++i) {
        const dvec2 at(u(random), u(random));
        const HeightMap::Sample felt = map.at(at);
        EXPECT_LT(length(felt.slope - ripple_slope(at.x, at.y)), (as_heights ? 0.06 : 0.03) * steepest)
            << mirrored << as_heights;
        if (as_heights) continue;
        const dvec2 drawn = drawn_slope(r.images[0], at.x, at.y);
        const dvec3 seen = drawn.x * t + drawn.y * b;
        EXPECT_LT(length(felt.slope - dvec2(dot(seen, by_u), dot(seen, by_v))), 0.04 * steepest);
      }
    }
}

TEST(ReliefMap, FadesOnASeamOfTheCoordinates) {
  Primitive sheet = mapped_sheet(false);
  for (std::size_t v = 0; v < sheet.position.size(); ++v)
    if (sheet.position[v].x > 0.0f) sheet.uv[v] += vec2(0.1f, 0.0f);  // torn from the other half along its edge
  Primitive other = sheet;
  // Split: the triangles right of the middle have their own copies of the vertices there.
  std::vector<std::uint32_t> copy(sheet.position.size(), 0);
  for (std::size_t i = 0; i + 2 < other.index.size(); i += 3) {
    bool right = false;
    for (std::size_t k = 0; k < 3; ++k) right = right || sheet.position[other.index[i + k]].x > 1e-6f;
    for (std::size_t k = 0; right && k < 3; ++k) {
      const std::uint32_t v = other.index[i + k];
      if (v >= sheet.position.size() || sheet.position[v].x > 1e-6f) continue;
      if (copy[v] == 0) {
        copy[v] = static_cast<std::uint32_t>(other.position.size());
        other.position.push_back(sheet.position[v]);
        other.normal.push_back(sheet.normal[v]);
        other.uv.push_back(sheet.uv[v] + vec2(0.1f, 0.0f));
      }
      other.index[i + k] = copy[v];
    }
  }
  const BuiltMesh built = *build_mesh("sheet", {&other, 1}, mat4(1));
  const Rippled r = rippled(false, true);
  const ReliefMaps maps = relief_maps(built.mesh, built.draw, r.materials, r.images);
  ASSERT_TRUE(maps.relief);
  EXPECT_NEAR(maps.faded, 0.05, 0.02);  // half of two columns of twenty
  int seams = 0;
  for (std::size_t t = 0; t < built.mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const bool on = std::abs(built.mesh.position(built.mesh.triangles[t][k]).x) < 1e-6f;
      EXPECT_EQ(maps.relief->strength[t][static_cast<std::size_t>(k)], on ? 0.0f : 1.0f);
      seams += on;
    }
  EXPECT_GT(seams, 20);
}

TEST(ReliefMap, ItsForceIsMinusTheGradientOfTheStoredEnergyAndFadesWithSpeed) {
  const Rippled r = rippled(true, false);
  Stage stage;
  Deformable d = frictionless();
  d.relief = 1.0;
  const Entity sheet = stage.add(mapped_sheet(true), d);
  Mesh& mesh = stage.world.meshes[stage.world.registry.get<Deformable>(sheet).mesh];
  ASSERT_EQ(mesh.triangles.size(), r.built.mesh.triangles.size());
  mesh.relief = r.maps.relief;
  const Entity probe = stage.add_probe({0, 0.02, 0}, 0.001);
  stage.prepare();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(-0.03, 0.03);
  dvec3 at(0, 0.02, 0);
  double across = 0.0;
  for (int n = 0; n < 8; ++n) {
    const dvec3 x(u(random), -0.004, u(random));
    for (int s = 1; s <= 400; ++s) {
      stage.place(probe, at + (x - at) * (s / 400.0));
      stage.tick();
    }
    at = x;
    stage.wait(0.6);
    dvec3 gradient(0);
    for (int k = 0; k < 3; ++k) {
      dvec3 e(0);
      e[k] = 1e-6;
      stage.place(probe, x + e);
      stage.tick();
      const double up = stored(stage);
      stage.place(probe, x - e);
      stage.tick();
      gradient[k] = (up - stored(stage)) / 2e-6;
    }
    stage.place(probe, x);
    stage.tick();
    const dvec3 f = raw_force(stage, probe);
    EXPECT_LT(length(f + gradient), 2e-4 * std::max(0.5, length(f))) << n;
    across = std::max(across, std::hypot(f.x, f.z));
  }
  EXPECT_GT(across, 0.02);
  EXPECT_EQ(stage.world.dropped, 0u);
  // Left-out detail is said where there is some: the map has finer texels than its ripples need.
  stage.move(probe, {0.03, -0.004, at.z}, length(at - dvec3(0.03, -0.004, at.z)) / 0.7);  // texels at 450 Hz
  EXPECT_EQ(stage.world.dropped, 0u);
  stage.move(probe, {-0.03, -0.004, at.z}, 0.06 / 5.0);  // ripples at 167 to 280 Hz
  EXPECT_EQ(stage.world.dropped, std::uint32_t{kDroppedDetail});
}

}  // namespace
}  // namespace pliant
