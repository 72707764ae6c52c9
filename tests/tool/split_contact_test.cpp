// Split contacts through the engine: probes and tools on tissue of coarse lattices, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "components/bonded_layer.h"
#include "components/sphere_curve.h"
#include "systems/soft/local/smeared_load.h"
#include "systems/tool/tool_touch_state.h"
#include "tests/tool/split_block.h"

namespace pliant {
namespace {

// Hertz on a layer: the contact is a third of a cell, a half and two thirds wide. The lattice alone is beside it.
TEST(SplitContact, ASphereOnCoarseCellsIsHertzSphere) {
  struct Row {
    double radius, depth;  // [m]
    dvec2 at;
    bool lattice_too;
  };
  for (const Row& row : {Row{0.002, 0.0008, dvec2(0.0013, 0.0021), true},
                         {0.004, 0.001, dvec2(0), false},
                         {0.008, 0.001, dvec2(0.0007, -0.0012), false}}) {
    SplitBlock block{.half_width = 0.024, .thickness = 0.02, .cell = 0.004, .squares = 12};
    const double unit = block.thickness * block.thickness / row.radius;
    const auto law = [&](double depth) {
      return 4.0 / 3.0 * block.reduced() * std::sqrt(row.radius) * std::pow(unit, 1.5) *
             layer_sphere(block.poisson).at(depth / unit).value;
    };
    const SpherePress split = press_sphere(block, row.radius, row.depth, row.at);
    const double truth = law(split.depth);
    EXPECT_NEAR(split.force, truth, 0.02 * truth) << row.radius;
    EXPECT_NEAR(split.felt, split.force, 0.01 * split.force) << row.radius;
    EXPECT_LT(split.aside, 0.005 * split.force) << row.radius;
    if (!row.lattice_too) continue;
    block.contact = SoftContact::kLattice;
    const SpherePress plain = press_sphere(block, row.radius, row.depth, row.at);
    EXPECT_GT(plain.force, 2.0 * law(plain.depth));
  }
}

// In a focus and where its cells grow, R by 2.4 times.
TEST(SplitContact, ASphereOnCellsOfAFocusIsHertzSphere) {
  const SplitBlock block{.half_width = 0.03, .thickness = 0.02, .cell = 0.003, .squares = 15, .focus = 0.003};
  constexpr double kRadius = 0.003;
  const double unit = block.thickness * block.thickness / kRadius;
  for (const double x : {0.0, 0.015}) {
    const SpherePress press = press_sphere(block, kRadius, 0.0006, dvec2(x, 0.001));
    const double truth = 4.0 / 3.0 * block.reduced() * std::sqrt(kRadius) * std::pow(unit, 1.5) *
                         layer_sphere(block.poisson).at(press.depth / unit).value;
    EXPECT_NEAR(press.force, truth, 0.04 * truth) << x;
    EXPECT_LT(press.aside, 0.005 * press.force) << x;
  }
}

// A flat punch, twice as thick as wide a block of cells as large as the punch: methods.md 2.10.
TEST(SplitContact, AFlatPunchOnABlockOfCellsOfItsRadiusHasHayesForce) {
  constexpr double kRadius = 0.004, kDepth = 1e-4;
  SplitBlock block{.half_width = 0.025, .thickness = 2 * kRadius, .cell = kRadius, .squares = 50};
  for (const SoftContact contact : {SoftContact::kSplit, SoftContact::kLattice}) {
    block.contact = contact;
    ToolStage stage(kSplitStep);
    const Entity tissue = add_block(stage, block);
    Handle6 handle;
    handle.translation = {1e5, 20.0};
    handle.rotation = {100.0, 0.1};
    handle.max_force = 1000, handle.max_torque = 100;
    RigidBody body;
    const Entity punch = stage.add_rigid(cylinder_of_triangles(kRadius), body, Pose{dvec3(0, 1e-3, 0)}, &handle);
    stage.prepare();
    stage.lead(punch, dvec3(0, 1e-3, 0), 0.05);
    stage.lead(punch, dvec3(0, -kDepth, 0), 0.1);
    stage.lead(punch, dvec3(0, -kDepth, 0), 0.4);
    const double depth = -stage.body(punch).as_tool()->handle().object_pose().position.y;
    const double force = stage.contact_force(punch, tissue).y;
    const double truth =
        2 * block.reduced() * kRadius * bonded_layer_factor(kRadius / block.thickness, block.poisson) * depth;
    if (contact == SoftContact::kSplit)
      EXPECT_NEAR(force, truth, 0.05 * truth);
    else
      EXPECT_GT(force, 1.7 * truth);
  }
}

// A ball of triangles.
Primitive ball_of_triangles(double radius, std::uint32_t around) {
  Primitive p;
  const std::uint32_t rings = around / 2;
  p.position.emplace_back(0.0f, static_cast<float>(-radius), 0.0f);
  for (std::uint32_t r = 1; r < rings; ++r)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double down = M_PI * r / rings, turn = 2 * M_PI * i / around;
      p.position.push_back(
          vec3(radius * dvec3(std::sin(down) * std::cos(turn), -std::cos(down), std::sin(down) * std::sin(turn))));
    }
  p.position.emplace_back(0.0f, static_cast<float>(radius), 0.0f);
  const auto at = [&](std::uint32_t r, std::uint32_t i) { return 1 + (r - 1) * around + i % around; };
  const auto last = static_cast<std::uint32_t>(p.position.size()) - 1;
  for (std::uint32_t i = 0; i < around; ++i) {
    p.index.insert(p.index.end(), {0, at(1, i), at(1, i + 1), last, at(rings - 1, i + 1), at(rings - 1, i)});
    for (std::uint32_t r = 1; r + 1 < rings; ++r)
      p.index.insert(p.index.end(),
                     {at(r, i), at(r + 1, i), at(r, i + 1), at(r, i + 1), at(r + 1, i), at(r + 1, i + 1)});
  }
  return p;
}

// Forces of a tool's mesh, held by its device, soft step by soft step.
struct MeshPress {
  ToolStage stage{kSplitStep};
  Entity tissue, tool;
  double depth = 0.0;                      // [m] of the tool's origin below where it began to touch
  std::vector<double> force, aside, deep;  // [N], [N], [m] per soft step

  MeshPress(const SplitBlock& block, const Primitive& mesh, dvec2 at) {
    tissue = add_block(stage, block);
    Handle6 handle;
    handle.translation = {1e5, 50.0};
    handle.rotation = {100.0, 0.1};
    handle.max_force = 1000, handle.max_torque = 100;
    tool = stage.add_rigid(mesh, RigidBody{}, Pose{dvec3(at.x, 0, at.y)}, &handle);
  }
  void go(dvec3 to, double seconds) {
    force.clear(), aside.clear(), deep.clear();
    double next = 0.0, time = 0.0;
    stage.lead(tool, to, seconds, [&] {
      time += stage.dt();
      if (time < next) return;
      next += kSplitStep;
      const dvec3 on = stage.contact_force(tool, tissue);
      force.push_back(on.y), aside.push_back(std::hypot(on.x, on.z));
      deep.push_back(-stage.body(tool).as_tool()->handle().object_pose().position.y);
    });
  }
  double ripple() const {  // [1] of the mean
    const auto [low, high] = std::minmax_element(force.begin(), force.end());
    return (*high - *low) / (0.5 * (*high + *low));
  }
};

// Two tissues: a cushion with a round top of this radius [m] is turned over and pressed on a block as thick. Both bear
// the same pressure, so they are one layer of the reduced modulus 1 / (1 / E1* + 1 / E2*).
TEST(SplitContact, TwoTissuesAreHertzBodiesOfTheirReducedModulus) {
  constexpr double kRound = 0.03, kRise = 0.0015, kDepth = 0.0006;  // [m]
  const SplitBlock below{.half_width = 0.02, .thickness = 0.016, .squares = 10};
  SplitBlock above = below;
  above.young = 3 * below.young, above.squares = 40;
  above.handle.emplace();
  above.handle->translation = {1e5, 50.0};
  above.handle->rotation = {100.0, 0.1};
  above.handle->max_force = 1000, above.handle->max_torque = 100;
  above.pose = Pose{dvec3(0, 1e-3, 0), glm::angleAxis(M_PI, dvec3(0, 0, 1))};
  Primitive cushion = block_surface(above);
  for (vec3& p : cushion.position)
    if (p.y > -1e-6f) p.y -= static_cast<float>(std::min((p.x * p.x + p.z * p.z) / (2 * kRound), kRise));
  above.shape = cushion;
  ToolStage stage(kSplitStep);
  const Entity one = add_block(stage, below), other = add_block(stage, above);
  stage.prepare();
  stage.lead(other, dvec3(0, -kDepth, 0), 0.05);
  stage.lead(other, dvec3(0, -kDepth, 0), 0.1);
  for (const ContactPoint& c : stage.soft().contacts) EXPECT_TRUE(c.a.smeared && c.b.smeared);
  const double depth = -stage.body(other).as_tool()->handle().object_pose().position.y;
  const double reduced = 1 / (1 / below.reduced() + 1 / above.reduced());
  const double unit = below.thickness * below.thickness / kRound;
  const double truth = 4.0 / 3.0 * reduced * std::sqrt(kRound) * std::pow(unit, 1.5) *
                       layer_sphere(below.poisson).at(depth / unit).value;
  const dvec3 force = stage.contact_force(other, one);
  EXPECT_NEAR(force.y, truth, 0.05 * truth);
  EXPECT_LT(std::hypot(force.x, force.z), 0.01 * force.y);
}

// F / E* r^2 of a ball at the depth d / r on a half-space (Sneddon 1965).
double sneddon_ball(double depth) {
  double low = 0.0, high = 0.999;
  for (int i = 0; i < 60; ++i) {
    const double a = 0.5 * (low + high);
    (0.5 * a * std::log((1 + a) / (1 - a)) < depth ? low : high) = a;
  }
  return 0.5 * (1 + low * low) * std::log((1 + low) / (1 - low)) - low;
}

// A ball of triangles: pressed in steadily to 0.45 of its radius its force is that of a ball on a
// layer all the way, and at rest it is steady.
TEST(SplitContact, ABallOfTrianglesPressedDeepIsSteadyAndAsHeavyAsABall) {
  constexpr double kBallRadius = 0.01;
  SplitBlock block{.half_width = 0.06, .thickness = 0.05, .cell = 0.012, .squares = 12};
  Primitive mesh = ball_of_triangles(kBallRadius, 64);
  for (vec3& p : mesh.position) p.y += static_cast<float>(kBallRadius);
  MeshPress press(block, mesh, dvec2(0.0023, -0.0031));
  const double unit = block.thickness * block.thickness / kBallRadius;
  const auto law = [&](double depth) {  // of a paraboloid on a layer, by a ball's share of it on a half-space
    const double paraboloid = 4.0 / 3.0 * std::pow(depth / kBallRadius, 1.5);
    return block.reduced() * kBallRadius * kBallRadius * sneddon_ball(depth / kBallRadius) / paraboloid * 4.0 / 3.0 *
           std::pow(unit / kBallRadius, 1.5) * layer_sphere(block.poisson).at(depth / unit).value;
  };
  press.stage.prepare();
  press.go(dvec3(0.0023, 5e-4, -0.0031), 0.05);
  press.go(dvec3(0.0023, -0.0045, -0.0031), 1.0);
  int compared = 0;
  for (std::size_t i = 0; i < press.force.size(); ++i) {
    if (press.deep[i] < 0.06 * kBallRadius) continue;  // facets
    EXPECT_NEAR(press.force[i], law(press.deep[i]), 0.03 * law(press.deep[i])) << press.deep[i];
    ++compared;
  }
  EXPECT_GT(compared, 40);
  press.go(dvec3(0.0023, -0.0045, -0.0031), 0.3);
  press.go(dvec3(0.0023, -0.0045, -0.0031), 0.5);
  EXPECT_LT(press.ripple(), 0.001);
  EXPECT_LT(press.aside.back(), 0.01 * press.force.back());
}

// Hertz' law ends where the contact is as wide as its smeared load: tips of over 1.5 R = 9 mm press the lattice alone.
TEST(SplitContact, AWideTipPressesTheLatticeAlone) {
  for (const double radius : {0.008, 0.010}) {
    SplitBlock block{.half_width = 0.024, .thickness = 0.02, .cell = 0.004, .squares = 12};
    ToolStage stage(kSplitStep);
    add_block(stage, block);
    const Entity probe = stage.add_probe({0, radius + 1e-3, 0}, radius);
    stage.prepare();
    stage.lead(probe, dvec3(0, radius - 1e-3, 0), 0.1);
    ASSERT_FALSE(stage.soft().contacts.empty());
    EXPECT_GT(stage.read(probe).force.y, 0.01);
    for (const ContactPoint& c : stage.soft().contacts) EXPECT_EQ(bool(c.a.smeared || c.b.smeared), radius < 0.009);
  }
}

// Row 15: a hand that presses, slides and leaves at random gains no energy, with friction and without.
TEST(SplitContact, RandomPathsAtThreeSpeedsGiveTheHandNoEnergy) {
  constexpr double kTip = 0.002;  // [m]
  for (const double friction : {0.0, 0.3})
    for (const double speed : {0.02, 0.1, 0.5}) {
      SplitBlock block{.half_width = 0.016, .thickness = 0.016, .cell = 0.004, .friction = friction, .squares = 8};
      ToolStage stage(kSplitStep);
      add_block(stage, block);
      const dvec3 above(0, kTip + 0.002, 0);
      const Entity probe = stage.add_probe(above, kTip);
      stage.prepare();
      stage.lead(probe, above, 0.05);
      scenes::WorkMeter meter;
      double lent = 0.0, most = 0.0;  // [J] the least work so far, below; [N]
      std::mt19937 random(static_cast<unsigned>(1e3 * speed) + 1);
      const auto any = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
      dvec3 from = above;
      for (int way = 0; way < 12; ++way) {
        const dvec3 to = way == 11 ? above : dvec3(any(-0.005, 0.005), kTip + any(-0.0015, 0.0005), any(-0.005, 0.005));
        stage.lead(probe, to, std::max(length(to - from) / speed, 0.004), [&] {
          meter.add(stage.read(probe));
          lent = std::max(lent, meter.work());
          most = std::max(most, length(stage.read(probe).force));
        });
        from = to;
      }
      EXPECT_GT(most, 0.05) << speed;
      EXPECT_LT(meter.work(), 0.0) << speed << ' ' << friction;
      EXPECT_LT(lent, 1e-9) << "[J] " << speed << ' ' << friction;
    }
}

// An egg pressed smoothly by a rod with a round end, which then leaves. Its points go from fine to coarse on the way
// in.
TEST(SplitContact, ARodThatPressesAnEggAndLeavesGetsNoEnergy) {
  constexpr double kRodRadius = 0.0017, kTop = 0.001, kDeep = -0.004;  // [m]
  Primitive egg = ball_of_triangles(0.0225, 32), rod = ball_of_triangles(kRodRadius, 16);
  for (vec3& p : egg.position) p = vec3(p.x / 0.75f, p.y - 0.0225f, p.z);
  for (vec3& p : rod.position) p.y += static_cast<float>(kRodRadius) + (p.y > 1e-6f ? 0.06f : 0.0f);
  SplitBlock block{.half_width = 0.03, .thickness = 0.045, .cell = 0.009, .young = 5600, .shape = egg};
  ToolStage stage(kSplitStep);
  const Entity tissue = add_block(stage, block);
  Handle6 handle;
  handle.translation = {1000.0, 8.0};
  handle.rotation = {0.38, 0.0038};
  RigidBody body;
  body.mass = 0.025;
  const Entity tool = stage.add_rigid(rod, body, Pose{dvec3(0, kTop, 0)}, &handle);
  stage.prepare();
  stage.lead(tool, dvec3(0, kTop, 0), 0.02);
  const ToolTouchState& touch = *stage.world.tools->tools.front();
  double work = 0.0, most = 0.0;  // [J] on the hand, before the safety layer; [N]
  dvec3 before = touch.sensed.pose.position, force(0);
  const auto lead = [&](double from, double to, double seconds) {
    for (double share = 0.0; share < 1.0 - 1e-9;) {
      share += 0.005 / seconds;
      const double u = share * share * share * (10 - 15 * share + 6 * share * share);
      stage.lead(tool, dvec3(0, from + u * (to - from), 0), 0.005, [&] {
        const dvec3 at = touch.sensed.pose.position, now = linear(touch.device_wrench);
        work += 0.5 * dot(force + now, at - before);
        before = at, force = now, most = std::max(most, length(now));
      });
    }
  };
  for (const double seconds : {0.2, 0.5})
    for (const double friction : {0.0, 0.2, 0.6}) {
      if (seconds < 0.5 && friction != 0.2) continue;
      for (const Entity e : {tissue, tool}) stage.body(e).friction_static = stage.body(e).friction_sliding = friction;
      work = most = 0.0;
      lead(kTop, kDeep, seconds);
      lead(kDeep, kTop, seconds);
      lead(kTop, kTop, 0.1);
      EXPECT_GT(most, 0.04) << seconds;
      EXPECT_LT(work, 5e-8) << "[J] " << seconds << ' ' << friction;
    }
  EXPECT_EQ(touch.force_safety.tally.of(SafetyLimit::kWithheld).ticks, 0u);
}

}  // namespace
}  // namespace pliant
