// The second-order step of tissue against closed forms: a mode's amplitude and period, the order of convergence, free
// flight, and energy in contact.
#include "systems/soft/body/two_stages.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/soft/body/tissue_material.h"
#include "tests/soft/box_pile.h"

namespace pliant {
namespace {

constexpr double kUsualStep = 1.0 / 60.0;  // [s]

SoftBody staged_body(double young, StepMethod method = StepMethod::kSecondOrder) {
  SoftBody body;
  body.young = young, body.poisson = 0.3;
  body.integrator = method;
  return body;
}

// A bar along x, pinned at its end x = 0.
TetMesh staged_bar() {
  TetMesh tets = tets::box(6, 1, 1, dvec3(0, -0.01, -0.01), dvec3(0.12, 0.01, 0.01));
  tets::hold(tets, [](dvec3 x) { return x.x < 1e-9; });
  return tets;
}

// The lowest mode of a pinned body, [m] largest displacement 1, and Young's modulus that gives it a frequency of 1 Hz.
struct LowestMode {
  Vector shape, mass;
  double young = 0.0;
};
LowestMode lowest_mode(const TetMesh& tets) {
  const SoftBody body = staged_body(1e4);
  Tissue tissue(tets, material_of(body), tets.free_count);
  tissue.assemble(1.0, dvec3(0));
  LowestMode out;
  out.mass.resize(3 * tissue.moving());
  for (std::uint32_t i = 0; i < tissue.moving(); ++i) out.mass.segment<3>(3 * i).setConstant(tissue.mass()[i]);
  const Vector root = out.mass.cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd K = tissue.inner().dense();
  K.diagonal() -= out.mass;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(root.asDiagonal() * K * root.asDiagonal());
  out.shape = root.cwiseProduct(eigen.eigenvectors().col(0));
  out.shape /= out.shape.cwiseAbs().maxCoeff();
  const double w = 2 * std::numbers::pi;
  out.young = body.young * w * w / eigen.eigenvalues()[0];
  return out;
}

// What is left of the amplitude [1], and the phase error [1] of the periods gone by.
struct Swing {
  double amplitude = 0.0, phase = 0.0;
};
Swing swing_of(StepMethod method, double step, double seconds) {
  TetMesh tets = staged_bar();
  const LowestMode mode = lowest_mode(tets);
  constexpr double kSmall = 1e-5;  // [m]
  tets.start = tets.nodes;
  for (std::uint32_t i = 0; i < tets.free_count; ++i)
    for (int k = 0; k < 3; ++k) tets.start[i][k] += kSmall * mode.shape[3 * i + k];
  const std::vector<dvec3> rest = tets.nodes;
  scenes::ToolStage stage(step);
  stage.world.simulation.gravity = dvec3(0);
  const Entity bar = stage.add_soft(tets, staged_body(mode.young, method), {});
  stage.prepare();
  const double w = 2 * std::numbers::pi;
  double turned = 0.0, last = 0.0;
  Swing out;
  const int steps = static_cast<int>(std::lround(seconds / step));
  for (int n = 1; n <= steps; ++n) {
    stage.step();
    const Tissue& tissue = stage.tissue(bar).tissue();
    double q = 0.0, rate = 0.0, size = 0.0;
    for (std::uint32_t i = 0; i < tissue.moving(); ++i)
      for (int k = 0; k < 3; ++k) {
        const double weight = mode.mass[3 * i + k] * mode.shape[3 * i + k];
        q += weight * (tissue.position()[i] - rest[i])[k], rate += weight * tissue.velocity()[i][k];
        size += weight * mode.shape[3 * i + k];
      }
    q /= size * kSmall, rate /= size * kSmall * w;
    const double angle = std::atan2(-rate, q);
    turned += std::remainder(angle - last, 2 * std::numbers::pi);
    last = angle;
    out.amplitude = std::hypot(q, rate);
  }
  out.phase = (turned - w * seconds) / (w * seconds);
  return out;
}

TEST(TwoStages, AModeOfOneHertzKeepsItsAmplitudeAndPeriod) {
  const Swing euler = swing_of(StepMethod::kEuler, kUsualStep, 3.0);
  const Swing staged = swing_of(StepMethod::kSecondOrder, kUsualStep, 3.0);
  EXPECT_NEAR(staged.amplitude, 1.0, 0.001);
  EXPECT_NEAR(staged.phase, 0.0, 0.001);
  EXPECT_LT(euler.amplitude, 0.5);
}

// The scheme's own damping and period, of its stability function R(z) = (1 + (1 - 2g) z) / (1 - g z)^2.
TEST(TwoStages, AModeFollowsTheStabilityFunction) {
  for (const double step : {0.01, 0.05, 0.2}) {
    const std::complex<double> z(0.0, 2 * std::numbers::pi * step);
    const double g = TwoStages::kShare;
    const std::complex<double> R = (1.0 + (1 - 2 * g) * z) / ((1.0 - g * z) * (1.0 - g * z));
    const Swing staged = swing_of(StepMethod::kSecondOrder, step, 10 * step);
    EXPECT_NEAR(staged.amplitude, std::pow(std::abs(R), 10), 2e-5) << step;
    EXPECT_NEAR(staged.phase, std::arg(R) / (2 * std::numbers::pi * step) - 1.0, 2e-5) << step;
  }
}

// A bar falls from level into a large swing, with stress and rotation.
std::vector<dvec3> fallen(TissueLaw law, double beta, double step) {
  scenes::ToolStage stage(step);
  SoftBody body = staged_body(4e4);
  body.law = law;
  body.rayleigh = {0.1, beta};
  const Entity bar = stage.add_soft(staged_bar(), body, {});
  stage.prepare();
  for (int i = 0; i < static_cast<int>(std::lround(0.4 / step)); ++i) stage.step();
  return stage.tissue(bar).tissue().position();
}

// Damping acts by the matrix of the step's beginning: with a law for large strain, whose matrix changes most, without
// it.
TEST(TwoStages, ItsErrorFallsWithTheSquareOfTheStep) {
  for (const TissueLaw law : {TissueLaw::kCorotational, TissueLaw::kNeoHookean}) {
    const double beta = law == TissueLaw::kCorotational ? 0.002 : 0.0;
    const std::vector<dvec3> truth = fallen(law, beta, 0.4 / 3200);
    double last = 0.0;
    for (const int steps : {50, 100, 200}) {
      const std::vector<dvec3> x = fallen(law, beta, 0.4 / steps);
      double off = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) off += dot(x[i] - truth[i], x[i] - truth[i]);
      off = std::sqrt(off / static_cast<double>(x.size()));
      if (last > 0.0) EXPECT_NEAR(std::log2(last / off), 2.0, 0.3) << static_cast<int>(law) << ' ' << steps;
      last = off;
    }
  }
}

// A block thrown with one turn a second, and stretched by it, for ten seconds.
TEST(TwoStages, InFreeFlightEnergyAndMomentaStay) {
  for (const double step : {1.0 / 60, 1.0 / 120, 1.0 / 240}) {
    scenes::ToolStage stage(step);
    stage.world.simulation.gravity = dvec3(0);
    SoftBody body = staged_body(1e5);
    body.law = TissueLaw::kNeoHookean;
    body.velocity = dvec3(0.1, -0.03, 0.02);
    const TetMesh tets = tets::box(3, 2, 2, dvec3(-0.06, -0.04, -0.04), dvec3(0.06, 0.04, 0.04));
    const Entity block = stage.add_soft(tets, body, {});
    stage.prepare();
    stage.body(block).loads.turn = dvec3(0.001, 0.002, 0.0078);
    struct Sums {
      dvec3 momentum{0}, spin_momentum{0};
      double energy = 0.0;
    };
    const auto sums = [&] {
      const Tissue& t = stage.tissue(block).tissue();
      Sums out;
      for (std::size_t i = 0; i < t.mass().size(); ++i) {
        out.momentum += t.mass()[i] * t.velocity()[i];
        out.spin_momentum += t.mass()[i] * cross(t.position()[i], t.velocity()[i]);
      }
      out.energy = stage.kinetic_energy() + stage.elastic_energy();
      return out;
    };
    for (int i = 0; i < static_cast<int>(std::lround(0.5 / step)); ++i) stage.step();  // it vibrates from the push
    const Sums begin = sums();
    for (int i = 0; i < static_cast<int>(std::lround(10.0 / step)); ++i) stage.step();
    const Sums end = sums();
    EXPECT_NEAR(end.energy, begin.energy, 0.01 * begin.energy) << step;
    EXPECT_LT(length(end.momentum - begin.momentum), 1e-10 * length(begin.momentum)) << step;
    EXPECT_LT(length(end.spin_momentum - begin.spin_momentum), 1e-8 * length(begin.spin_momentum)) << step;
  }
}

}  // namespace
}  // namespace pliant
