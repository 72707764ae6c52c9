// Seams: nodes so near that a probe feels one surface (methods.md 1.5).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/feed/publish.h"

namespace pliant {
namespace {

// Heights of a surface by where its vertices are in the world; seams have two at one place.
void add_heights(Stage& stage, Entity surface, std::map<std::pair<int, int>, std::vector<float>>& heights) {
  const Mesh& mesh = stage.mesh(surface);
  const Pose& pose = stage.world.registry.get<Pose>(surface);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const dvec3 x = pose.to_world(dvec3(mesh.position(v)));
    heights[{static_cast<int>(std::lround(x.x * 1e5)), static_cast<int>(std::lround(x.z * 1e5))}].push_back(
        stage.field(surface).stream[v].w);
  }
}

// Two nodes side by side, a crack in one mesh, or nothing between them: pressed, slid over and left, all look the same.
TEST(TouchSeam, ADentGoesOnOverASeamAsIfThereWereNone) {
  constexpr int kCells = 24;
  constexpr double kSize = 0.12;
  const Primitive half = scenes::sheet(kCells, kSize);
  Primitive both = half;
  for (const vec3& x : half.position) both.position.push_back(x + vec3(kSize, 0, 0));
  for (const std::uint32_t i : half.index) both.index.push_back(i + static_cast<std::uint32_t>(half.position.size()));
  Primitive cracked = both;
  for (std::size_t v = half.position.size(); v < cracked.position.size(); ++v)
    cracked.position[v].x += static_cast<float>(0.01 * kSize / kCells);
  for (const SpringLaw law :
       {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kStandardLinearSolid, SpringLaw::kQuasiLinearCubic}) {
    Deformable d = frictionless(law);
    d.shape = law == SpringLaw::kCubic ? Shape::kVolume : Shape::kWendland;
    d.reach = 0.025;
    Stage one, two, crack;
    std::vector<std::pair<Stage*, std::vector<Entity>>> scenes;
    scenes.push_back({&one, {one.add(both, d)}});
    scenes.push_back({&two, {two.add(half, d), two.add(half, d, Pose{{kSize, 0, 0}})}});
    scenes.push_back({&crack, {crack.add(cracked, d)}});
    std::vector<Entity> hands;
    for (auto& [stage, surfaces] : scenes) {
      hands.push_back(stage->add_probe({0.03, 0.002, 0.0037}));
      stage->prepare();
    }
    const auto go = [&](dvec3 to, double seconds) {
      for (std::size_t i = 0; i < scenes.size(); ++i) {
        scenes[i].first->move(hands[i], to, seconds);
        scenes[i].first->wait(0.003);  // the far side of a seam is known a tick later
      }
    };
    const auto compare = [&](const char* when) {
      std::map<std::pair<int, int>, std::vector<float>> want, got;
      add_heights(one, scenes[0].second[0], want);
      for (const Entity surface : scenes[1].second) add_heights(two, surface, got);
      double largest = 0;
      for (const auto& [at, heights] : want) {
        largest = std::max<double>(largest, std::abs(heights[0]));
        for (const float h : got.at(at)) EXPECT_NEAR(h, heights[0], 2e-6) << int(law) << ' ' << when << ' ' << at.first;
      }
      const HeightField& torn = crack.field(scenes[2].second[0]);
      float deepest = 0;
      for (const vec4& s : torn.stream) deepest = std::min(deepest, s.w);
      EXPECT_NEAR(-deepest, largest, 0.02 * largest) << when;
      return largest;
    };
    go({0.03, -0.004, 0.0037}, 0.05);
    EXPECT_GT(compare("pressed"), 0.003);
    for (const double x : {0.05, 0.055, 0.059, 0.061, 0.07, 0.058}) {
      go({x, -0.004, 0.0037}, 0.04);
      EXPECT_GT(compare("slid"), 0.003) << x;
    }
    go({0.058, 0.02, 0.0037}, 0.01);
    EXPECT_GT(compare("left"), 0.0005);
    go({0.058, 0.02, 0.0037}, 0.02);
    compare("recovering");
    // Beyond the crack it is dented too.
    go({0.057, 0.001, 0.0037}, 0.5);
    go({0.057, -0.004, 0.0037}, 0.05);
    const Mesh& mesh = crack.mesh(scenes[2].second[0]);
    float beyond = 0;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
      if (mesh.px[v] > 0.0600001f) beyond = std::min(beyond, crack.field(scenes[2].second[0]).stream[v].w);
    EXPECT_LT(beyond, -0.003);
  }
}

// Where four nodes meet, and for two probes on different ones.
TEST(TouchSeam, FourNodesLookAsOneUnderTwoProbes) {
  constexpr int kCells = 20;
  constexpr double kSize = 0.1;
  const Primitive part = scenes::sheet(kCells, kSize);
  Primitive all;
  Stage one, four;
  Deformable d = frictionless();
  d.shape = Shape::kWendland;
  d.reach = 0.03;
  std::vector<Entity> parts;
  for (const double x : {0.0, kSize})
    for (const double z : {0.0, kSize}) {
      const auto first = static_cast<std::uint32_t>(all.position.size());
      for (const vec3& p : part.position) all.position.push_back(p + vec3(x, 0, z));
      for (const std::uint32_t i : part.index) all.index.push_back(i + first);
      parts.push_back(four.add(part, d, Pose{{x, 0, z}}));
    }
  const Entity whole = one.add(all, d);
  std::vector<Entity> a, b;
  for (Stage* stage : {&one, &four}) {
    a.push_back(stage->add_probe({0.044, 0.002, 0.043}));
    b.push_back(stage->add_probe({0.057, 0.002, 0.046}));
    stage->prepare();
    stage->move(a.back(), {0.044, -0.004, 0.043}, 0.05);
    stage->move(b.back(), {0.057, -0.005, 0.046}, 0.05);
    stage->wait(0.05);
  }
  std::map<std::pair<int, int>, std::vector<float>> want, got;
  add_heights(one, whole, want);
  for (const Entity surface : parts) add_heights(four, surface, got);
  double corner = 0;
  for (const auto& [at, heights] : want)
    for (const float h : got.at(at)) {
      ASSERT_NEAR(h, heights[0], 5e-6) << at.first << ' ' << at.second;
      if (at.first > 5000 && at.second > 5000) corner = std::min<double>(corner, h);
    }
  EXPECT_LT(corner, -0.001) << "in the node that no probe is on";
}

// Sheets and slabs that are flush, part and come back: one surface, then borders with air or edges between them, then
// one surface again. The one on the right moves.
TEST(TouchSeam, SeamsOpenWhenSurfacesPartAndCloseWhenTheyMeetAgain) {
  using glm::dvec4;
  constexpr double kSize = 0.1, kGap = 0.03;
  for (const bool thick : {false, true}) {
    const Primitive half = thick ? scenes::slab(10, kSize, 0.05) : scenes::sheet(10, kSize);
    const auto pressed_at = [&](double x, double time) {  // [N] held 3 mm deep from then on
      Stage stage;
      stage.add(half, frictionless(), Pose{{-kSize / 2, 0, 0}});
      const Entity right = stage.add(half, frictionless(), Pose{{kSize / 2, 0, 0}});
      PrescribedMotion motion;
      motion.translation = {Interpolation::kLinear,
                            {0.0, 0.2, 0.4, 0.6, 0.8},
                            {dvec4(kSize / 2, 0, 0, 0), dvec4(kSize / 2, 0, 0, 0), dvec4(kSize / 2 + kGap, 0, 0, 0),
                             dvec4(kSize / 2 + kGap, 0, 0, 0), dvec4(kSize / 2, 0, 0, 0)},
                            0.8};
      motion.repeats = false;
      stage.carry(right, motion);
      const Entity probe = stage.add_probe({x, 0.02, 0.0037});
      stage.prepare();
      stage.wait(time);
      stage.move(probe, {x, 0.001, 0.0037}, 0.02);
      stage.move(probe, {x, -0.003, 0.0037}, 0.05);
      stage.wait(0.02);
      return raw_force(stage, probe);
    };
    const double whole = law(frictionless(), 0.003);
    const auto expect = [&](double x, double time, double y) {
      EXPECT_LT(length(pressed_at(x, time) - dvec3(0, y, 0)), 1e-6) << thick << ' ' << x << ' ' << time;
    };
    for (const double x : {-1e-7, 1e-7, 0.001}) expect(x, 0.05, whole);        // flush
    for (const double x : {0.001, 0.015, kGap - 0.001}) expect(x, 0.45, 0.0);  // in the gap
    for (const double x : {-0.01, kGap + 0.01}) expect(x, 0.45, whole);        // beside it
    for (const double x : {-1e-7, 1e-7, 0.001}) expect(x, 0.85, whole);        // flush again
    // Held while the surface leaves: felt until its border passes the tip.
    for (const double x : {-0.001, 0.002, 0.02}) {
      Stage stage;
      stage.add(half, frictionless(), Pose{{-kSize / 2, 0, 0}});
      const Entity right = stage.add(half, frictionless(), Pose{{kSize / 2, 0, 0}});
      PrescribedMotion motion;
      motion.translation = {Interpolation::kLinear,
                            {0.0, 0.2, 0.7},
                            {dvec4(kSize / 2, 0, 0, 0), dvec4(kSize / 2, 0, 0, 0), dvec4(kSize / 2 + kGap, 0, 0, 0)},
                            0.7};
      motion.repeats = false;
      stage.carry(right, motion);
      const Entity probe = stage.add_probe({x, 0.001, 0.0037});
      stage.prepare();
      stage.move(probe, {x, -0.003, 0.0037}, 0.1);
      while (stage.time() < 0.8) {
        stage.tick();
        const double border = kGap * std::clamp((stage.time() - 0.2) / 0.5, 0.0, 1.0);
        const double felt = length(raw_force(stage, probe));
        ASSERT_LT(felt, whole * 1.001) << thick << ' ' << x << ' ' << stage.time();
        if (x < 0 && !thick) ASSERT_NEAR(felt, whole, 1e-6) << stage.time();
        if (x > 0 && border < x - 0.006) ASSERT_NEAR(felt, whole, 1e-6) << thick << ' ' << x << ' ' << stage.time();
        if (x > 0 && border > x + 0.002) ASSERT_EQ(felt, 0.0) << thick << ' ' << x << ' ' << stage.time();
      }
    }
    // A slab's edge: 1 mm beside it and 3 mm deep the tip is nearer to the side.
    const dvec3 edge = pressed_at(-0.001, 0.45);
    if (thick)
      EXPECT_GT(edge.x, 0.1) << "its edge is felt";
    else
      EXPECT_NEAR(edge.y, whole, 1e-6);
  }
}

// One that is apart at the start and comes: flush with a sheet at a key of its motion, then with another.
TEST(TouchSeam, SeamsFormWhenSurfacesMeet) {
  using glm::dvec4;
  const Primitive half = scenes::sheet(10, 0.1);
  const double whole = law(frictionless(), 0.003);
  for (const double x : {-0.05, 0.05, 0.15, 0.25}) {  // edges at -0.05 and 0.15: between the fixed ones and the mover
    Stage stage;
    stage.add(half, frictionless(), Pose{{-0.1, 0, 0}});
    const Entity mover = stage.add(half, frictionless(), Pose{{0, 0.05, 0}});
    stage.add(half, frictionless(), Pose{{0.2, 0, 0}});
    PrescribedMotion motion;
    motion.translation = {
        Interpolation::kLinear,
        {0.0, 0.2, 0.4, 0.6, 0.8},
        {dvec4(0, 0.05, 0, 0), dvec4(0, 0, 0, 0), dvec4(0, 0, 0, 0), dvec4(0.1, 0, 0, 0), dvec4(0.1, 0, 0, 0)},
        0.8};
    motion.repeats = false;
    stage.carry(mover, motion);
    const Entity probe = stage.add_probe({x + 0.01, 0.2, 0.0037});
    stage.prepare();
    const auto slide = [&](double begin) {  // over x and back, 3 mm deep
      stage.wait(begin - stage.time());
      stage.move(probe, {x + 0.01, 0.001, 0.0037}, 0.01);
      stage.move(probe, {x + 0.01, -0.003, 0.0037}, 0.02);
      double least = 1e9, most = 0;
      stage.move(probe, {x - 0.01, -0.003, 0.0037}, 0.1, [&](const ProbeReading&) {
        least = std::min(least, length(raw_force(stage, probe)));
        most = std::max(most, length(raw_force(stage, probe)));
      });
      stage.move(probe, {x - 0.01, 0.02, 0.0037}, 0.02);
      return std::pair(least, most);
    };
    const auto first = slide(0.21), second = slide(0.81);
    if (x == -0.05) {
      EXPECT_NEAR(first.first, whole, 1e-6);
      EXPECT_LT(second.first, 1e-9) << "it has left";
    } else if (x == 0.15) {
      EXPECT_LT(first.first, 1e-9) << "it has not come yet";
      EXPECT_NEAR(second.first, whole, 1e-6);
    }
    EXPECT_LT(std::max(first.second, second.second), whole * 1.000001);
  }
}

// Past the end of a seam there is nothing to interpolate.
TEST(TouchSeam, AContactThatRunsOffTheEndOfASeamEnds) {
  Stage stage;
  const Primitive half = scenes::sheet(10, 0.1);
  for (const double x : {-0.05, 0.05}) stage.add(half, frictionless(), Pose{{x, 0, 0}});
  const Entity probe = stage.add_probe({0, 0.002, 0});
  stage.prepare();
  stage.move(probe, {-0.001, -0.003, 0}, 0.05);
  stage.move(probe, {0, -0.003, 0}, 0.05);
  stage.move(probe, {0, -0.003, 0.049}, 0.2);
  EXPECT_GT(raw_force(stage, probe).y, 0.8);
  stage.move(probe, {0, -0.003, 0.08}, 0.2);
  EXPECT_EQ(raw_force(stage, probe), dvec3(0));
}

}  // namespace
}  // namespace pliant
