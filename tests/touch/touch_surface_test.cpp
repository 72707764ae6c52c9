// Touch on faces, edges, ridges, grooves, seams and cracks, against closed forms (methods.md 1.5).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "scenes/touch_laws.h"
#include "scenes/touch_raw.h"
#include "systems/touch/collide/foot.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/feed/publish.h"

namespace pliant {
namespace {

// Intersection of the curved surface with a ray from the origin along a unit vector. [m]
dvec3 surface_on_the_way(const Mesh& mesh, dvec3 along) {
  const Entry entry = first_entry(mesh, dvec3(0), 0.1 * along);
  EXPECT_TRUE(entry.valid());
  dvec3 x = entry.fraction * 0.1 * along;
  for (int i = 0; i < 20; ++i) {
    const Foot foot = descend(mesh, entry.triangle, entry.barycentric, x);
    x -= foot.height / dot(along, foot.normal) * along;
  }
  return x;
}

// The force there is a hard case (player/study/hard).
TEST(TouchSurface, ASphereInAGrooveShowsAnArrowForEachWall) {
  Stage stage;
  stage.add(scenes::valley(40, 0.2, M_PI / 4), frictionless());
  const Entity probe = stage.add_probe({0, 0.06, 0}, 0.02);
  stage.prepare();
  for (const double aside : {0.0, 0.0039}) {
    stage.move(probe, {aside, (0.02 - 0.0031) * std::sqrt(2.0), 0}, 1.0);
    stage.wait(0.3);
    publish(stage.world, {});
    ASSERT_TRUE(stage.world.snapshots->acquire());
    const ProbeSnapshot& shown = stage.world.snapshots->read().probes[0];
    ASSERT_EQ(shown.contact_count, 2u);
    EXPECT_LT(length(shown.contacts[0].force + shown.contacts[1].force - raw_force(stage, probe)), 1e-12);
    stage.move(probe, {0, 0.06, 0}, 0.5);
  }
}

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
TEST(TouchSurface, ADentGoesOnOverASeamAsIfThereWereNone) {
  constexpr int kCells = 24;
  constexpr double kSize = 0.12;
  const Primitive half = scenes::sheet(kCells, kSize);
  Primitive both = half;
  for (const vec3& x : half.position) both.position.push_back(x + vec3(kSize, 0, 0));
  for (const std::uint32_t i : half.index) both.index.push_back(i + static_cast<std::uint32_t>(half.position.size()));
  Primitive cracked = both;
  for (std::size_t v = half.position.size(); v < cracked.position.size(); ++v)
    cracked.position[v].x += static_cast<float>(0.01 * kSize / kCells);
  for (const SpringLaw law : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kStandardLinearSolid}) {
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
TEST(TouchSurface, FourNodesLookAsOneUnderTwoProbes) {
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
TEST(TouchSurface, SeamsOpenWhenSurfacesPartAndCloseWhenTheyMeetAgain) {
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
TEST(TouchSurface, SeamsFormWhenSurfacesMeet) {
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
TEST(TouchSurface, AContactThatRunsOffTheEndOfASeamEnds) {
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

// A crack in one mesh: two sheets in one primitive, a gap of a hundredth of an edge between them.
TEST(TouchSurface, ACrackNarrowerThanTheMeshResolvesDoesNotExist) {
  Primitive p = scenes::sheet(10, 0.1);
  const std::size_t count = p.position.size();
  for (std::size_t i = 0; i < count; ++i) p.position.push_back(p.position[i] + vec3(0.10005f, 0, 0));
  const std::size_t indices = p.index.size();
  for (std::size_t i = 0; i < indices; ++i) p.index.push_back(p.index[i] + static_cast<std::uint32_t>(count));
  Stage stage;
  const Deformable d = frictionless();
  stage.add(p, d);
  const Entity probe = stage.add_probe({0.02, 0.002, 0.0037});
  stage.prepare();
  stage.move(probe, {0.02, -0.003, 0.0037}, 0.1);
  for (const double x : {0.08, 0.02})
    stage.move(probe, {x, -0.003, 0.0037}, 1.0, [&](const ProbeReading&) {
      ASSERT_LT(length(raw_force(stage, probe) - dvec3(0, law(d, 0.003), 0)), 0.01 * law(d, 0.003));
    });
}

// One that the mesh does resolve is an edge: the probe falls into it.
TEST(TouchSurface, AGapOfATenthOfAnEdgeIsAGap) {
  Primitive p = scenes::sheet(10, 0.1);
  const std::size_t count = p.position.size(), indices = p.index.size();
  for (std::size_t i = 0; i < count; ++i) p.position.push_back(p.position[i] + vec3(0.101f, 0, 0));
  for (std::size_t i = 0; i < indices; ++i) p.index.push_back(p.index[i] + static_cast<std::uint32_t>(count));
  Stage stage;
  stage.add(p, frictionless());
  const Entity probe = stage.add_probe({0.04, 0.002, 0.0037});
  stage.prepare();
  stage.move(probe, {0.04, -0.003, 0.0037}, 0.1);
  EXPECT_GT(raw_force(stage, probe).y, 0.8);
  stage.move(probe, {0.0505, -0.003, 0.0037}, 0.2);
  EXPECT_EQ(raw_force(stage, probe), dvec3(0));
}

// Closed parts that are flush in one node, or in two: a crack between them does not exist, however it is met.
TEST(TouchSurface, ACrackBetweenClosedPartsDoesNotExist) {
  constexpr double kSize = 0.1;
  const Primitive half = scenes::slab(10, kSize, 0.04);
  const Deformable d = frictionless();
  const double whole = law(d, 0.003);
  for (const bool one_node : {true, false})
    for (const double crack : {0.0, 1e-9, 1e-7, 1e-6, 1e-5, 4e-5, 1e-4})
      for (const double radius : {0.0, 0.006}) {
        const auto build = [&](Stage& stage) {
          const dvec3 way(kSize + crack, 0, 0);
          if (one_node) {
            Primitive both = half;
            const std::size_t count = half.position.size();
            for (std::size_t i = 0; i < count; ++i) both.position.push_back(vec3(dvec3(half.position[i]) + way));
            for (const std::uint32_t i : half.index) both.index.push_back(i + static_cast<std::uint32_t>(count));
            stage.add(both, d);
          } else {
            stage.add(half, d);
            stage.add(half, d, Pose{way});
          }
        };
        const double middle = kSize / 2 + crack / 2;
        const std::string what = std::to_string(one_node) + " crack " + std::to_string(crack * 1e6) + " um, radius " +
                                 std::to_string(radius);
        for (const double x : {0.0, 0.3 * crack, -0.3 * crack, crack, -crack, 1e-4, -1e-3})  // pressed
          for (const double z : {0.0037, 0.0}) {  // there, and at a vertex of both sides
            Stage stage;
            build(stage);
            const Entity probe = stage.add_probe({middle + x, radius + 0.002, z}, radius);
            stage.prepare();
            stage.move(probe, {middle + x, radius - 0.003, z}, 0.1);
            stage.wait(0.01);
            EXPECT_NEAR(raw_force(stage, probe).y, whole, (0.005 + crack / 0.003) * whole)
                << what << " pressed at " << x;
            EXPECT_LT(std::abs(raw_force(stage, probe).x), (1e-6 + crack / 0.003) * whole)
                << what << " pressed at " << x;
            stage.move(probe, {middle + x, radius + 0.001, z}, 0.1);
            EXPECT_EQ(raw_force(stage, probe), dvec3(0)) << what << " lifted at " << x;
          }
        Stage stage;  // slid over it, and back
        build(stage);
        const Entity probe = stage.add_probe({middle - 0.01, radius + 0.002, 0.0037}, radius);
        stage.prepare();
        stage.move(probe, {middle - 0.01, radius - 0.003, 0.0037}, 0.1);
        double least = 1e9, most = 0, sideways = 0;
        for (const double x : {0.01, -0.01})
          stage.move(probe, {middle + x, radius - 0.003, 0.0037}, 0.5, [&](const ProbeReading&) {
            least = std::min(least, raw_force(stage, probe).y);
            most = std::max(most, raw_force(stage, probe).y);
            sideways = std::max(sideways, std::abs(raw_force(stage, probe).x));
          });
        EXPECT_NEAR(least, whole, (0.005 + crack / 0.003) * whole) << what;
        EXPECT_NEAR(most, whole, (0.005 + crack / 0.003) * whole) << what;
        EXPECT_LT(sideways, (1e-6 + crack / 0.003) * whole) << what;
      }
}

// A welded box of cells on all six faces, its top at y = 0.
Primitive box_of_cells(int n, double size) {
  Primitive p;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [it, is_new] = known.emplace(at, static_cast<std::uint32_t>(p.position.size()));
    if (is_new) p.position.push_back(vec3(size / n * dvec3(at[0] - n / 2.0, at[1] - n, at[2] - n / 2.0)));
    return it->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          std::array<int, 3> at{};
          at[axis] = side;
          const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
          const auto corner = [&](int k, int l) {
            at[u] = i + k, at[v] = j + l;
            return vertex(at);
          };
          const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          for (const std::uint32_t w : side ? std::array{a, b, c, a, c, d} : std::array{a, c, b, a, d, c})
            p.index.push_back(w);
        }
  return p;
}

// Where four parts meet in a corner, pressed exactly there and slid over it any way.
TEST(TouchSurface, ACornerWhereFourPartsMeetIsASurface) {
  constexpr double kSize = 0.1;
  const Deformable d = frictionless();
  const double whole = law(d, 0.003);
  for (const Primitive& quarter : {scenes::slab(8, kSize, 0.04), box_of_cells(8, kSize)})
    for (const bool one_node : {true, false})
      for (const double crack : {0.0, 1e-9, 1e-7, 1e-5, 4e-5})
        for (const double radius : {0.0, 0.006}) {
          const double half = kSize / 2 + crack / 2;
          const auto build = [&](Stage& stage) {
            Primitive all;
            for (const dvec3 at : {dvec3(half, 0, half), {-half, 0, half}, {half, 0, -half}, {-half, 0, -half}}) {
              if (!one_node) stage.add(quarter, d, Pose{at});
              const auto first = static_cast<std::uint32_t>(all.position.size());
              for (const vec3& p : quarter.position) all.position.push_back(vec3(dvec3(p) + at));
              for (const std::uint32_t v : quarter.index) all.index.push_back(first + v);
            }
            if (one_node) stage.add(all, d);
          };
          const std::string what = std::to_string(one_node) + " crack " + std::to_string(crack * 1e6) + " um, radius " +
                                   std::to_string(radius);
          const double most_off = (0.005 + 1.5 * crack / 0.003) * whole;
          for (const double angle : {0.0, 0.3, M_PI / 4, 2.0}) {
            const dvec3 way(std::cos(angle), 0, std::sin(angle));
            Stage stage;
            build(stage);
            const Entity probe = stage.add_probe({0, radius + 0.002, 0}, radius);
            stage.prepare();
            stage.move(probe, {0, radius - 0.003, 0}, 0.1);
            EXPECT_NEAR(raw_force(stage, probe).y, whole, most_off) << what << " pressed";
            double least = 1e9, most = 0, sideways = 0;
            for (const double x : {0.01, -0.01, 0.0})
              stage.move(probe, x * way + dvec3(0, radius - 0.003, 0), 0.3, [&](const ProbeReading&) {
                const dvec3 f = raw_force(stage, probe);
                least = std::min(least, f.y);
                most = std::max(most, f.y);
                sideways = std::max(sideways, std::hypot(f.x, f.z));
              });
            EXPECT_NEAR(least, whole, most_off) << what << " slid at " << angle;
            EXPECT_NEAR(most, whole, most_off) << what << " slid at " << angle;
            EXPECT_LT(sideways, (1e-4 + 1.5 * crack / 0.003) * whole) << what << " slid at " << angle;
            stage.move(probe, {0, radius + 0.001, 0}, 0.1);
            EXPECT_EQ(raw_force(stage, probe), dvec3(0)) << what << " lifted";
          }
        }
}

// Wherever along its length that is (flat on a surface: touch_capsule_test.cpp).
TEST(TouchSurface, ACapsuleAcrossABoxsEdgeTouchesInOnePlace) {
  Stage box;
  box.add(scenes::slab(4, 0.08, 0.06), frictionless());
  const Entity shaft = box.add_probe({0.03, 0.03, 0}, 0.004);
  box.world.registry.get<Probe>(shaft).length = 0.06;
  box.device(shaft).rotation = glm::angleAxis(-3 * M_PI / 4, dvec3(0, 0, 1));  // down and outwards, over the edge
  box.prepare();
  double low = 1e9, high = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double s = 0.02 * i / 1000;  // along its own axis; 2 mm of the shaft behind the edge
    const dvec3 axis = normalize(dvec3(1, -1, 0)), out = normalize(dvec3(1, 1, 0));
    box.place(shaft, dvec3(0.04, 0, 0) + 0.002 * out * (i < 100 ? 3 - 2 * i / 100.0 : 1.0) - axis * (0.02 + s));
    box.tick();
    if (i < 150) continue;
    low = std::min(low, length(raw_force(box, shaft)));
    high = std::max(high, length(raw_force(box, shaft)));
  }
  EXPECT_GT(low, 0.4);
  EXPECT_LT(high - low, 0.01 * high);
}

// A tip that was pressed through a wall is not caught by it on its way back; a second wall behind it is touched. Seen
// from the inside, a bowl's curved surface is behind its triangles. A tip between the two does not touch yet, and is
// caught when it moves on, fast or slow.
TEST(TouchSurface, ATipBetweenATriangleAndItsCurvedSurfaceIsCaughtHoweverFastItGoesOn) {
  constexpr double kRadius = 0.05;
  const Primitive bowl = scenes::bowl(4, kRadius);
  int caught = 0;
  for (const double step : {2e-4, 1e-3, 3e-3, 8e-3})
    for (const double between : {1e-6, 0.5, 1.0}) {  // from the triangle to the curved surface
      Stage stage;
      const Entity surface = stage.add(bowl, frictionless());
      const Entity probe = stage.add_probe({0, 0.01, 0});
      stage.prepare();
      const Mesh& mesh = stage.mesh(surface);
      for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 5) {
        const uvec3 corner = mesh.triangles[t];
        const dvec3 middle =
            (dvec3(mesh.position(corner.x)) + dvec3(mesh.position(corner.y)) + dvec3(mesh.position(corner.z))) / 3.0;
        if (middle.y > -0.4 * kRadius) continue;
        const dvec3 down = normalize(middle), curved = surface_on_the_way(mesh, down);
        ASSERT_GT(length(curved), length(middle) + 1e-5);
        const double from = length(middle) + between * (length(curved) - length(middle)) - 1e-12;
        for (const double r : {from - 1e-3, from, from + step}) {
          stage.place(probe, r * down);
          stage.tick();
        }
        const ProbeReading felt = stage.read(probe);
        EXPECT_NEAR(felt.depth, std::max(0.0, from + step - length(curved)), 0.02 * step + 1e-6)
            << step << " " << between << " " << t;
        caught += felt.depth > 0;
        for (const double r : {from - 1e-3, 0.5 * from}) {
          stage.place(probe, r * down);
          stage.tick();
        }
      }
    }
  EXPECT_GT(caught, 100);
}

TEST(TouchSurface, ATipPressedThroughAWallTouchesTheNextAndComesBackByTheSameForces) {
  for (const double radius : {0.0, 0.002}) {
    Primitive walls = scenes::slab(20, 0.1, 0.001);
    const auto count = static_cast<std::uint32_t>(walls.position.size());
    const Primitive wall = walls;
    for (const vec3& p : wall.position) walls.position.push_back(p - vec3(0, 0.004f, 0));
    for (const std::uint32_t i : wall.index) walls.index.push_back(i + count);
    Stage stage;
    stage.add(walls, frictionless());
    const Entity probe = stage.add_probe({0.003, 0.005, 0.002}, radius);
    stage.prepare();
    std::vector<std::pair<double, dvec3>> down;
    for (double y = 0.005; y > -0.008; y -= 5e-5) {
      stage.place(probe, {0.003, y, 0.002});
      stage.tick();
      down.push_back({y, raw_force(stage, probe)});
    }
    std::size_t contacts = 0;
    for (auto [entity, contact] : stage.world.registry.view<Contact>()) contacts += contact.probe == probe;
    EXPECT_EQ(contacts, 2u) << radius;
    EXPECT_GE(down.back().second.y, 0.99 * law(frictionless(), radius + 0.008)) << radius;
    for (; !down.empty(); down.pop_back()) {
      stage.place(probe, {0.003, down.back().first, 0.002});
      stage.tick();
      ASSERT_LT(length(raw_force(stage, probe) - down.back().second), 1e-6) << radius << ' ' << down.back().first;
    }
  }
}

}  // namespace
}  // namespace pliant
