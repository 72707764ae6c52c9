// PLIANT_deformable on a soft body: the law of its dents, in series with the lattice under the smeared force.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "systems/soft/local/dent_spring.h"
#include "systems/soft/local/lattice_calibration.h"
#include "systems/soft/local/smeared_kernel.h"
#include "systems/soft/local/smeared_load.h"
#include "tests/tool/split_block.h"

namespace pliant {
namespace {

constexpr double kTip = 0.003;  // [m] radius of the probe
// [m] The closed form is of small strain on a wide layer: co-rotational tissue softens by 5 % a millimetre here, and
// the block, as wide as 8 R, is 1.5 % softer than a layer.
constexpr double kShallow = 0.0002;

SplitBlock dent_block() {
  SplitBlock block{.half_width = 0.024, .thickness = 0.02, .cell = 0.004, .squares = 12};
  block.law.emplace();
  block.law->stiffness = 200.0;
  block.law->reach = 0.008;
  block.law->friction_static = block.law->friction_sliding = 0.0;
  return block;
}

// [m/N] Of the block under the smeared force: k lambda / (2 E* R).
double smeared_compliance(const SplitBlock& block) {
  const double radius = smearing_cells(block.poisson) * block.cell;
  return lattice_compliance(block.poisson, smearing_cells(block.poisson)).normal *
         LayerKernel(block.poisson).share(radius, block.thickness) / (2 * block.reduced() * radius);
}

// [N] The root of delta(F) + C F = depth, by bisection.
template <class Force>
double in_series(double depth, double compliance, const Force& of_dent) {
  double low = 0.0, high = depth;
  for (int i = 0; i < 80; ++i) {
    const double dent = 0.5 * (low + high);
    (dent + compliance * of_dent(dent) < depth ? low : high) = dent;
  }
  return of_dent(low);
}

TEST(DentLaw, ForceOfADepthAndDepthOfAForceAreInverseForEveryLaw) {
  for (const SpringLaw law :
       {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential, SpringLaw::kStandardLinearSolid,
        SpringLaw::kQuasiLinearCubic, SpringLaw::kQuasiLinearExponential}) {
    Deformable it;
    it.spring = law, it.reach = 0.01, it.contact_damping = 0.4;
    for (const double young : {0.0, 2e4}) {
      it.young = young;
      const DentSpring spring(it, 1.0 / 60);
      const DentSpringAt at{&spring, 2.0, 0.004, 1.0 / 60, 0.0007, 0.05};
      for (const double depth : {2e-4, 1e-3, 4e-3}) {
        const double force = at.force(depth);
        if (force > 0.0) {
          EXPECT_NEAR(at.depth(force), depth, 1e-9 * depth) << static_cast<int>(law);
        }
        const double h = 1e-5 * depth;
        EXPECT_NEAR(at.slope(depth), (at.force(depth + h) - at.force(depth - h)) / (2 * h), 1e-4 * at.slope(depth))
            << static_cast<int>(law) << ' ' << young;
      }
    }
  }
}

TEST(DentLaw, ASphereFeelsItInSeriesWithTheSmearedLattice) {
  SplitBlock block = dent_block();
  Deformable& law = *block.law;
  law.cubic = 1.5e10, law.stiffening = 8000.0;
  for (const SpringLaw spring : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential}) {
    law.spring = spring;
    const auto force = [&](double d) {
      if (spring == SpringLaw::kCubic) return law.stiffness * d + law.cubic * d * d * d;
      if (spring == SpringLaw::kExponential) return law.stiffness / law.stiffening * std::expm1(law.stiffening * d);
      return law.stiffness * d;
    };
    const SpherePress press = press_sphere(block, kTip, kShallow, dvec2(0.0013, 0.0021));
    const double truth = in_series(press.depth, smeared_compliance(block), force);
    EXPECT_NEAR(press.force, truth, 0.03 * truth) << static_cast<int>(spring);
    EXPECT_NEAR(press.felt, press.force, 0.01 * press.force) << static_cast<int>(spring);
    EXPECT_LT(press.aside, 0.005 * press.force);
  }
}

// Its force is bounded: the probe is held by that force, however deep the dent.
TEST(DentLaw, ATableThatFlattensHoldsAProbeThatIsPressedDeeper) {
  SplitBlock block = dent_block();
  block.law->spring = SpringLaw::kTable;
  block.law->table = {.count = 3, .rows = {{{0.0, 0.0}, {2e-5, 0.004}, {4e-5, 0.0042}}}};
  const SpherePress press = press_sphere(block, kTip, kShallow, dvec2(0.0013, 0.0021));
  EXPECT_NEAR(press.force, 0.0042, 0.02 * 0.0042);
  EXPECT_NEAR(press.felt, press.force, 0.01 * press.force);
}

TEST(DentLaw, APaintedLumpIsFeltAsStiffAsItIsPainted) {
  SplitBlock block = dent_block();
  block.squares = 48;
  block.stiffness = [](vec3 p) { return p.x > 0.0f ? 4.0f : 1.0f; };
  for (const double x : {0.006, -0.006}) {
    const SpherePress press = press_sphere(block, kTip, kShallow, dvec2(x, 0.001));
    const double k = (x > 0.0 ? 4.0 : 1.0) * block.law->stiffness;
    const double truth = press.depth / (1 / k + smeared_compliance(block));
    EXPECT_NEAR(press.force, truth, 0.03 * truth) << x;
  }
}

TEST(DentLaw, ItsFrictionIsTheContactsNotTheBodys) {
  SplitBlock block = dent_block();
  block.friction = 0.9;
  block.law->friction_static = 0.25, block.law->friction_sliding = 0.2;
  ToolStage stage(kSplitStep);
  const Entity tissue = add_block(stage, block);
  const Entity probe = stage.add_probe({-0.006, kTip + 1e-3, 0}, kTip);
  stage.device(probe).max_force = 100.0;
  stage.world.registry.get<Probe>(probe).coupling = {3000.0, 10.0};
  stage.prepare();
  stage.lead(probe, dvec3(-0.006, kTip + 1e-3, 0), 0.05);
  stage.lead(probe, dvec3(-0.006, kTip - 0.002, 0), 0.15);
  stage.lead(probe, dvec3(0.004, kTip - 0.002, 0), 0.4);
  EXPECT_GT(stage.contact_force(probe, tissue).y, 0.0);
  ASSERT_EQ(stage.soft().contacts.size(), 1u);
  const ContactPoint& contact = stage.soft().contacts.front();
  EXPECT_TRUE(contact.sliding);
  EXPECT_NEAR(std::hypot(contact.impulse.y, contact.impulse.z), 0.2 * contact.impulse.x, 1e-3 * contact.impulse.x);
}

// The arm relaxes as a standard linear solid in series with a spring: tau (1 + (1 + r1) k C) / (1 + k C).
TEST(DentLaw, ItsArmRelaxesInSeriesWithTheLattice) {
  SplitBlock block = dent_block();
  Deformable& law = *block.law;
  law.spring = SpringLaw::kStandardLinearSolid;
  law.relaxation_stiffness = 300.0, law.relaxation_time = 0.25;
  ToolStage stage(kSplitStep);
  const Entity tissue = add_block(stage, block);
  const Entity probe = stage.add_probe({0, kTip + 2e-4, 0}, kTip);
  stage.device(probe).max_force = 100.0;
  stage.world.registry.get<Probe>(probe).coupling = {2e4, 20.0};
  stage.prepare();
  stage.lead(probe, dvec3(0, kTip, 0), 0.05);
  stage.lead(probe, dvec3(0, kTip - kShallow, 0), 0.034);
  const auto hold = [&](double seconds) {
    stage.lead(probe, dvec3(0, kTip - kShallow, 0), seconds);
    return stage.contact_force(probe, tissue).y;
  };
  const double kC = law.stiffness * smeared_compliance(block), r1 = law.relaxation_stiffness / law.stiffness;
  const double tau = law.relaxation_time * (1 + (1 + r1) * kC) / (1 + kC);
  const double early = hold(0.1), later = hold(0.2), last = hold(5 * tau);
  const double depth = kTip - stage.body(probe).as_tool()->handle().object_pose().position.y;
  const double rest = depth * law.stiffness / (1 + kC);
  EXPECT_NEAR(last, rest, 0.025 * rest);
  EXPECT_GT(early, 1.25 * last);
  EXPECT_NEAR(std::log((early - last) / (later - last)), 0.2 / tau, 0.1 * 0.2 / tau);
}

// A mesh presses one dent by many points, as on a surface that does not bend: its law, not one law a point.
TEST(DentLaw, ManyPointsShareOneDent) {
  SplitBlock block = dent_block();
  block.law->reach = 0.012;
  ToolStage stage(kSplitStep);
  const Entity tissue = add_block(stage, block);
  Handle6 handle;
  handle.translation = {1e5, 20.0};
  handle.rotation = {100.0, 0.1};
  handle.max_force = 1000, handle.max_torque = 100;
  constexpr double kSide = 0.002;
  const Entity punch = stage.add_rigid(scenes::box(dvec3(kSide), dvec3(0, 0.5 * kSide, 0)), RigidBody{},
                                       Pose{dvec3(0, 1e-3, 0)}, &handle);
  stage.prepare();
  stage.lead(punch, dvec3(0, 1e-3, 0), 0.05);
  stage.lead(punch, dvec3(0, -kShallow, 0), 0.1);
  stage.lead(punch, dvec3(0, -kShallow, 0), 0.5);
  const double depth = -stage.body(punch).as_tool()->handle().object_pose().position.y;
  // As P1's probes: phi / k between all that press, and the lattice under the whole patch.
  std::vector<dvec3> at;
  for (const ContactPoint& c : stage.soft().contacts)
    if (c.impulse.x > 0.0) at.push_back((c.body_a == 0 ? c.a : c.b).smeared->place.at);
  const auto n = static_cast<Eigen::Index>(at.size());
  const ShareKernel shared = share_kernel(block.law->shape, block.law->reach, block.law->volume);
  Eigen::MatrixXd W(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const dvec3 apart = at[static_cast<std::size_t>(i)] - at[static_cast<std::size_t>(j)];
      W(i, j) = shared.at(dot(apart, apart)) / block.law->stiffness + smeared_compliance(block);
    }
  const double truth = depth * W.ldlt().solve(Eigen::VectorXd::Ones(n)).sum();
  EXPECT_GT(n, 3);
  EXPECT_LT(truth, 1.5 * depth * block.law->stiffness);  // one law, not one a point
  EXPECT_NEAR(stage.contact_force(punch, tissue).y, truth, 0.06 * truth);
}

}  // namespace
}  // namespace pliant
