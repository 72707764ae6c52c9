#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "content/author/hand.h"
#include "content/author/surface_nets.h"
#include "content/files/exr.h"
#include "content/generate/lattice_sphere.h"
#include "content/generate/levels.h"
#include "content/generate/sky.h"
#include "content/generate/strokes.h"
#include "content/generate/textures.h"
#include "content/level/script.h"
#include "content/level_file.h"
#include "content/mesh/mesh_build.h"

namespace pliant::generate {
namespace {

namespace fs = std::filesystem;
const fs::path kShipped = fs::path(PLIANT_SOURCE_DIR) / "content";

struct TemporaryFolder {
  fs::path path = fs::temp_directory_path() / ("pliant_generate_test_" + std::to_string(::getpid()));
  TemporaryFolder() { fs::create_directories(path); }
  ~TemporaryFolder() { fs::remove_all(path); }
};

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Generate, SurfaceIsClosedLiesOnItsSolidAndIsMadeOfEvenNearEquilateralTriangles) {
  const Solid solid = organ();
  const LatticeSphere sphere = cover(solid, 10, 1);
  EXPECT_EQ(sphere.triangles.size(), 8u * 20u * 20u);
  for (const dvec3& p : sphere.position) EXPECT_LT(std::abs(solid(p)), 1e-8);
  const Primitive primitive = to_primitive(sphere, solid);
  const Result<BuiltMesh> built = build_mesh("organ", {&primitive, 1}, mat4(1.0f));
  ASSERT_TRUE(built.ok());
  EXPECT_TRUE(built->mesh.closed);
  EXPECT_EQ(built->mesh.triangles.size(), sphere.triangles.size());
  std::vector<double> quality, area;
  for (const uvec3& t : built->mesh.triangles) {
    const dvec3 a(built->mesh.position(t.x)), b(built->mesh.position(t.y)), c(built->mesh.position(t.z));
    area.push_back(0.5 * length(cross(b - a, c - a)));
    quality.push_back(4.0 * std::sqrt(3.0) * area.back() / (dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c)));
  }
  std::sort(quality.begin(), quality.end());
  std::sort(area.begin(), area.end());
  EXPECT_GT(quality[quality.size() / 100], 0.6);  // 1 is equilateral
  EXPECT_GT(quality[quality.size() / 2], 0.9);
  EXPECT_LT(area[area.size() * 99 / 100], 4.0 * area[area.size() / 2]);
}

TEST(Generate, HandIsOneClosedSurfaceOnItsSolidWithFiveSeparateDigits) {
  const Solid solid = hand_solid();
  const Net net = cover_by_net(solid, hand_box(), 0.0042);
  double volume = 0.0, area = 0.0, facing = 0.0;
  for (const dvec3& p : net.position) EXPECT_LT(std::abs(solid(p)), 1e-8);
  for (const uvec3& t : net.triangles) {
    const dvec3 &a = net.position[t.x], &b = net.position[t.y], &c = net.position[t.z];
    const dvec3 spanned = 0.5 * cross(b - a, c - a);
    volume += dot(a, spanned) / 3.0;
    area += length(spanned);
    facing += dot(normal_at(solid, (a + b + c) / 3.0), spanned);
  }
  EXPECT_GT(volume, 1.0e-4);
  EXPECT_LT(volume, 3.0e-4);
  EXPECT_GT(facing, 0.98 * area) << "triangles do not face outward";
  const Primitive primitive = to_primitive(net, solid);
  const Result<BuiltMesh> built = build_mesh("hand", {&primitive, 1}, mat4(1.0f));
  ASSERT_TRUE(built.ok());
  EXPECT_TRUE(built->mesh.closed);
  EXPECT_EQ(built->mesh.triangles.size(), net.triangles.size());
  // Euler's formula: one piece without handles, so no digit has joined another.
  const std::size_t v = net.position.size(), f = net.triangles.size();
  EXPECT_EQ(v + f - 3 * f / 2, 2u);
}

TEST(Generate, UnfoldedSquareAndSurfaceAreInversesOfEachOther) {
  const LatticeSphere sphere = cover(pad(), 6, 0);
  for (const auto& t : sphere.triangles) {
    dvec2 uv(0);
    dvec3 middle(0);
    for (const auto& corner : t) {
      uv += dvec2(corner.uv) / 3.0;
      middle += sphere.position[corner.vertex] / 3.0;
    }
    const LatticePlace place = place_at(sphere.n, uv);
    dvec3 found(0);
    for (std::size_t i = 0; i < 3; ++i)
      found += place.weight[static_cast<int>(i)] * sphere.position[sphere.vertex.at(place.corner[i])];
    EXPECT_LT(length(found - middle), 1e-7);
  }
}

TEST(Generate, StrokeKeepsItsDepthAlongTheNormalWhileSlidingAndStaysClearBeforeAndAfter) {
  const Solid solid = [](dvec3 p) { return length(p) - 0.05; };
  const Stroke stroke{4.0, 0.003, 0.02, 0.006, 0.5, 1.0, 3.0, 3.5, {{0, 0.05, 0.01}, {0.03, 0.05, 0}}, {1.0, 3.0}};
  const Path path = trace(solid, stroke);
  ASSERT_EQ(path.rows.size(), 401u);
  for (const PathRow& row : path.rows) {
    const double tip = solid(row.position) - stroke.radius;
    if (row.time <= 0.5 || row.time >= 3.5) {
      EXPECT_NEAR(tip, 0.02, 1e-9);
    }
    if (row.time >= 1.0 && row.time <= 3.0) {
      EXPECT_NEAR(tip, -0.006, 1e-9);
    }
  }
}

TEST(Generate, SkyIsReadBackAsItWasWrittenToHalfPrecision) {
  const TemporaryFolder folder;
  const Panorama made = sky(64);
  ASSERT_TRUE(save_panorama(made, folder.path / "sky.exr").ok());
  const Result<Panorama> read = load_panorama(folder.path / "sky.exr");
  ASSERT_TRUE(read.ok()) << read.error().message();
  ASSERT_EQ(read->rgb.size(), made.rgb.size());
  for (std::size_t i = 0; i < made.rgb.size(); ++i) EXPECT_NEAR(read->rgb[i], made.rgb[i], 0.001f * made.rgb[i]);
}

TEST(Generate, ShippedFilesAreWhatTheGeneratorMakes) {
  const TemporaryFolder folder;
  const Status done = generate(folder.path);
  ASSERT_TRUE(done.ok()) << done.error().message();
  // Text and plain binaries are compared by bytes; compressed files (whose libraries may differ) by content.
  for (const char* name : {"minimal.gltf",
                           "minimal.bin",
                           "minimal.csv",
                           "three_probes_a.csv",
                           "three_probes_b.csv",
                           "three_probes_c.csv",
                           "inclusion_a.csv",
                           "inclusion_b.csv",
                           "glass_heart_a.csv",
                           "glass_heart_b.csv",
                           "glass_heart_c.csv",
                           "chrome_cushion_a.csv",
                           "chrome_cushion_b.csv",
                           "turning_ball_a.csv",
                           "hand.csv",
                           "hand_crowd.csv",
                           "hand_squeeze.csv",
                           "stack_stylus.csv",
                           "instrument_stylus.csv",
                           "instrument_finger.csv",
                           "effects_a.csv",
                           "effects_b.csv",
                           "effects_c.csv",
                           "effects_d.csv",
                           "effects_e.csv",
                           "effects_f.csv",
                           "fields_finger.csv",
                           "fields_rail.csv",
                           "layers_needle.csv",
                           "layers_finger.csv",
                           "palpation.csv",
                           "grasp.csv",
                           "forceps.csv",
                           "hand_grip.csv"})
    EXPECT_EQ(bytes_of(folder.path / "levels" / name), bytes_of(kShipped / "levels" / name)) << name;
  for (const char* name :
       {"three_probes.glb", "inclusion.glb", "glass_heart.glb", "chrome_cushion.glb", "turning_ball.glb", "hand.glb",
        "hand_crowd.glb", "hand_squeeze.glb", "stack.glb", "instrument.glb", "effects.glb", "fields.glb", "layers.glb",
        "palpation.glb", "grasp.glb", "forceps.glb", "hand_grip.glb"}) {
    const Result<Level> made = load_level(folder.path / "levels" / name),
                        shipped = load_level(kShipped / "levels" / name);
    ASSERT_TRUE(made.ok()) << made.error().message();
    ASSERT_TRUE(shipped.ok()) << shipped.error().message();
    ASSERT_EQ(made->meshes.size(), shipped->meshes.size());
    for (std::size_t m = 0; m < made->meshes.size(); ++m) {
      const Primitive &a = made->meshes[m].primitives.at(0), &b = shipped->meshes[m].primitives.at(0);
      EXPECT_EQ(a.position, b.position) << name;
      EXPECT_EQ(a.uv, b.uv) << name;
      EXPECT_EQ(a.stiffness, b.stiffness) << name;
      EXPECT_EQ(a.index, b.index) << name;
    }
    ASSERT_EQ(made->images.size(), shipped->images.size());
    for (std::size_t i = 0; i < made->images.size(); ++i)
      EXPECT_EQ(made->images[i].rgba, shipped->images[i].rgba) << name;
    ASSERT_EQ(made->nodes.size(), shipped->nodes.size());
    for (std::size_t n = 0; n < made->nodes.size(); ++n) EXPECT_EQ(made->nodes[n].name, shipped->nodes[n].name);
  }
  for (const char* name : {"sky.exr", "terrace.exr"}) {
    const Result<Panorama> made = load_panorama(folder.path / "environments" / name);
    const Result<Panorama> shipped = load_panorama(kShipped / "environments" / name);
    ASSERT_TRUE(made.ok() && shipped.ok());
    EXPECT_EQ(made->rgb, shipped->rgb) << name;
  }
}

TEST(Generate, EveryShippedLevelSpawnsWithItsProbesAndEveryStrokeReachesTheSurface) {
  const std::pair<const char*, std::size_t> levels[] = {{"three_probes.glb", 3},   {"inclusion.glb", 2},
                                                        {"minimal.gltf", 1},       {"glass_heart.glb", 3},
                                                        {"chrome_cushion.glb", 2}, {"turning_ball.glb", 1}};
  for (const auto& [name, probes] : levels) {
    const Result<Level> level = load_level(kShipped / "levels" / name);
    ASSERT_TRUE(level.ok()) << level.error().message();
    Result<World> world = spawn(*level);
    ASSERT_TRUE(world.ok()) << world.error().message();
    std::size_t count = 0;
    for (auto [entity, probe] : world->registry.view<Probe>()) {
      ++count;
      ASSERT_NE(probe.device, kNoEntity) << name;
      const Path& path = world->paths[world->registry.get<HapticDevice>(probe.device).path];
      // Nearest touch vertex over the script: about the depth below the surface, by brute force.
      double nearest = 1.0;
      for (auto [object, deformable] : world->registry.view<Deformable>()) {
        const Mesh& mesh = world->meshes[deformable.mesh];
        for (const PathRow& row : path.rows)
          if (std::lround(row.time * 100.0) % 50 == 0)
            for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
              nearest =
                  std::min(nearest, dot(row.position - dvec3(mesh.position(v)), dvec3(mesh.normal(v))) - probe.radius +
                                        10.0 * std::max(0.0, length(row.position - dvec3(mesh.position(v))) - 0.012));
      }
      EXPECT_LT(nearest, -0.003) << name;
      EXPECT_GT(nearest, -0.012) << name;
    }
    EXPECT_EQ(count, probes) << name;
  }
}

}  // namespace
}  // namespace pliant::generate
