// Relaxation of tissue (Prony series): against closed forms, and what it must leave alone.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/tet_shapes.h"
#include "systems/soft/fem/tissue_memory.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

constexpr double kCubeEdge = 0.1, kCubeModulus = 1e4;
constexpr double kLight = 1e-6;  // [kg/m3] no inertia

Prony two_arms() {
  return {.count = 2, .arms = {Prony::Arm{0.3, 0.05}, Prony::Arm{0.4, 0.7}}};
}

double stays(const Prony& prony, double t) {
  double g = prony.remains();
  for (std::size_t i = 0; i < prony.count; ++i) g += prony.arms[i].share * std::exp(-t / prony.arms[i].time);
  return g;
}

TissueMaterial relaxing(TissueLaw law, double poisson, const Prony& prony, double density = kLight) {
  return {.young = kCubeModulus, .poisson = poisson, .density = density, .law = law, .stiffening = 0.3, .prony = prony};
}

// A cube with its faces x = 0 and x = kCubeEdge bonded to plates.
struct BondedCube {
  TetMesh mesh = tets::box(3, 3, 3, dvec3(0), dvec3(kCubeEdge));
  std::unique_ptr<Tissue> tissue;
  std::unique_ptr<LinearSolver> solver = make_solver(SolverKind::kBlockCholesky, 1);

  BondedCube(const TissueMaterial& material, bool far_plate = true) {
    tets::hold(mesh, [&](dvec3 p) { return p.x < 1e-9 || (far_plate && p.x > kCubeEdge - 1e-9); });
    tissue = std::make_unique<Tissue>(mesh, material, mesh.free_count);
    solver->analyse(tissue->inner());
  }
  bool on_plate(std::uint32_t i) const { return mesh.nodes[i].x > kCubeEdge - 1e-9; }
  // Takes the shape of the elastic cube at this strain, at once.
  void jump(TissueMaterial material, dvec3 way) {
    material.prony = {};
    BondedCube elastic(material);
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
      elastic.tissue->position()[i] += mesh.nodes[i].x / kCubeEdge * way;
    settle_tissue(*elastic.tissue, *elastic.solver, dvec3(0), {.iterations = 200, .tolerance = 1e-12});
    tissue->position() = elastic.tissue->position();
    tissue->end_step(0.0);
  }
  void step(double T, const std::vector<dvec3>* push = nullptr) {
    EXPECT_TRUE(step_tissue(*tissue, *solver, T, dvec3(0), {.push = push}).solved);
  }
  dvec3 plate_force() {
    tissue->find_forces();
    dvec3 sum(0);
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
      if (on_plate(i))
        for (int k = 0; k < 3; ++k) sum[k] -= tissue->elastic_force()[3 * i + k];
    return sum;
  }
};

TEST(Relaxation, AnyStepIsExactForALinearChange) {
  for (const double T : {1e-6, 1e-3, 0.1, 10.0, 1e4}) {
    TissueMemory whole, parts;
    for (TissueMemory* each : {&whole, &parts}) each->set(two_arms(), 1, {});
    whole.end({2.0}, 0.0), parts.end({2.0}, 0.0);  // a jump first
    whole.end({-3.0}, T);
    for (int i = 1; i <= 1000; ++i) parts.end({2.0 - 5.0 * i / 1000}, T / 1000);
    double want = two_arms().remains() * -3.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto [share, time] = two_arms().arms[i];
      want += share * (2.0 * std::exp(-T / time) + 5.0 * time / T * std::expm1(-T / time));
    }
    EXPECT_NEAR(-3.0 + whole.history(0)[0], want, 1e-12 * 5) << T;
    EXPECT_NEAR(whole.history(0)[0], parts.history(0)[0], 1e-10) << T;
  }
}

TEST(Relaxation, AStepOfStrainRelaxesByTheSeriesForEveryLaw) {
  for (const TissueLaw law : {TissueLaw::kCorotational, TissueLaw::kNeoHookean, TissueLaw::kFung})
    for (const double T : {1e-3, 1.0 / 60, 0.3}) {
      const TissueMaterial material = relaxing(law, 0.4, two_arms());
      BondedCube cube(material);
      cube.jump(material, dvec3(-0.02, 0.01, 0));
      const dvec3 at_once = cube.plate_force();
      ASSERT_LT(at_once.x, -0.5);
      for (int i = 1; i <= 20; ++i) {
        cube.step(T);
        const dvec3 now = cube.plate_force();
        for (int k = 0; k < 2; ++k) EXPECT_NEAR(now[k] / at_once[k], stays(two_arms(), i * T), 1e-4) << T << ' ' << i;
      }
    }
}

// nu = 0, so that the bonded cube is a bar.
TEST(Relaxation, CreepUnderADeadLoadIsThatOfTheStandardLinearSolid) {
  const Prony arm{.count = 1, .arms = {Prony::Arm{0.6, 0.2}}};
  for (const double T : {0.002, 0.01}) {
    BondedCube cube(relaxing(TissueLaw::kCorotational, 0.0, arm), false);
    const double strain = 0.01, force = kCubeModulus * strain * kCubeEdge * kCubeEdge;
    std::vector<dvec3> push(cube.mesh.node_count(), dvec3(0));
    double count = 0.0;
    for (std::uint32_t i = 0; i < cube.mesh.node_count(); ++i) count += cube.on_plate(i);
    // Shares of a uniform traction, by the elastic forces of the uniformly stretched cube.
    for (std::uint32_t i = 0; i < cube.mesh.node_count(); ++i)
      cube.tissue->position()[i].x = cube.mesh.nodes[i].x * (1 + strain);
    cube.tissue->end_step(0.0);
    cube.tissue->find_forces();
    double sum = 0.0;
    for (std::uint32_t i = 0; i < cube.mesh.node_count(); ++i)
      if (cube.on_plate(i)) push[i].x = -cube.tissue->elastic_force()[3 * i], sum += push[i].x;
    ASSERT_NEAR(sum, force, 1e-9);
    for (int i = 1; i * T < 2.0; ++i) {
      cube.step(T, &push);
      double moved = 0.0;
      for (std::uint32_t n = 0; n < cube.mesh.node_count(); ++n)
        if (cube.on_plate(n)) moved += (cube.tissue->position()[n].x - kCubeEdge) / count;
      const double left = arm.remains(), want = 1 / left - (1 / left - 1) * std::exp(-left * i * T / 0.2);
      EXPECT_NEAR(moved / (strain * kCubeEdge), want, 5e-3 * want) << T << ' ' << i;
    }
  }
}

TEST(Relaxation, ALoopLosesTheEnergyOfTheLossModulus) {
  const Prony prony = two_arms();
  BondedCube cube(relaxing(TissueLaw::kCorotational, 0.0, prony));
  const double strain = 0.01, rate = 2 * std::numbers::pi * 1.5, T = 1e-3;
  double work = 0.0, before = 0.0, place = 0.0;
  const int cycle = static_cast<int>(std::lround(2 * std::numbers::pi / rate / T));
  for (int i = 1; i <= 8 * cycle; ++i) {
    const double next = strain * kCubeEdge * std::sin(rate * i * T);
    for (std::uint32_t n = 0; n < cube.mesh.node_count(); ++n)
      if (cube.on_plate(n)) cube.tissue->velocity()[n].x = (next - place) / T;
    cube.step(T);
    const double force = cube.plate_force().x;
    if (i > 7 * cycle) work += 0.5 * (force + before) * (next - place);
    before = force, place = next;
  }
  double loss = 0.0;
  for (std::size_t i = 0; i < prony.count; ++i) {
    const double x = rate * prony.arms[i].time;
    loss += kCubeModulus * prony.arms[i].share * x / (1 + x * x);
  }
  EXPECT_NEAR(work, std::numbers::pi * loss * strain * strain * kCubeEdge * kCubeEdge * kCubeEdge, 0.01 * work);
}

// One element through a random closed path: the hand gets nothing back.
TEST(Relaxation, AClosedPathCostsWork) {
  TetMesh mesh;
  mesh.nodes = {dvec3(0), dvec3(0.1, 0, 0), dvec3(0, 0.1, 0), dvec3(0, 0, 0.1)};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.free_count = 4;
  for (std::uint32_t path = 0; path < 50; ++path) {
    Tissue tissue(mesh, relaxing(TissueLaw::kCorotational, 0.3, two_arms()), 4);
    const auto rest = tissue.position();
    double work = 0.0;  // the last leg returns
    for (std::uint32_t leg = 0; leg < 8; ++leg)
      for (int i = 0; i < 5; ++i) {
        const double T = 0.02 * (1 + path % 7);
        std::vector<dvec3> next = rest;
        for (std::uint32_t n = 0; n < 4 && leg < 7; ++n) next[n] += 0.005 * tets::scatter(1000 * path + 10 * leg + n);
        const auto before = tissue.position();
        for (std::size_t n = 0; n < 4; ++n) next[n] = glm::mix(before[n], next[n], 0.2 + 0.2 * i);
        tissue.position() = next;
        tissue.end_step(T);
        tissue.find_forces();
        for (std::uint32_t n = 0; n < 4; ++n)
          for (int k = 0; k < 3; ++k) work -= tissue.elastic_force()[3 * n + k] * (next[n] - before[n])[k];
      }
    EXPECT_GT(work, 0.0) << path;
  }
}

// At any history: a function of the strain alone, so its forces have no moment and do no work in a rotation.
TEST(Relaxation, ForcesAreTheGradientOfTheStepsEnergyAndHaveNoMoment) {
  const TetMesh mesh = tets::box(1, 1, 2, dvec3(0), dvec3(0.1, 0.1, 0.2));
  for (const TissueLaw law : {TissueLaw::kCorotational, TissueLaw::kNeoHookean, TissueLaw::kFung}) {
    Tissue tissue(mesh, relaxing(law, 0.4, two_arms()), mesh.node_count());
    const auto shake = [&](std::uint32_t seed) {
      for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
        tissue.position()[i] = mesh.nodes[i] + 0.03 * tets::scatter(100 * seed + i);
    };
    shake(1), tissue.end_step(0.0);
    shake(2), tissue.end_step(0.1);
    shake(3);
    tissue.assemble(0.05, dvec3(0));
    const Vector f = tissue.elastic_force();
    dvec3 sum(0), moment(0);
    const double size = f.lpNorm<Eigen::Infinity>();
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
      const dvec3 each(f[3 * i], f[3 * i + 1], f[3 * i + 2]);
      sum += each, moment += cross(tissue.position()[i], each);
      for (int k = 0; k < 3; ++k) {
        const double h = 1e-6;
        tissue.position()[i][k] += h;
        const double up = tissue.elastic_energy();
        tissue.position()[i][k] -= 2 * h;
        const double down = tissue.elastic_energy();
        tissue.position()[i][k] += h;
        EXPECT_NEAR((down - up) / (2 * h), f[3 * i + k], 1e-5 * size);
      }
    }
    EXPECT_LT(length(sum), 1e-10 * size);
    EXPECT_LT(length(moment), 1e-8 * size * 0.2);
  }
}

dvec3 spin_of(const Tissue& tissue) {
  dvec3 out(0);
  for (std::size_t i = 0; i < tissue.mass().size(); ++i)
    out += tissue.mass()[i] * cross(tissue.position()[i], tissue.velocity()[i]);
  return out;
}

TEST(Relaxation, FreeFallAndRotationAreNotBraked) {
  const TetMesh mesh = tets::box(2, 2, 4, dvec3(-0.05, -0.05, -0.1), dvec3(0.05, 0.05, 0.1));
  Tissue tissue(mesh, relaxing(TissueLaw::kCorotational, 0.4, two_arms(), 1000.0), mesh.node_count());
  auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
  solver->analyse(tissue.inner());
  const dvec3 turn(1.0, 2.0, 4.0), gravity(0, -9.81, 0);
  for (int i = 0; i < 60; ++i) step_tissue(tissue, *solver, 1.0 / 60, gravity);
  for (const dvec3 v : tissue.velocity()) EXPECT_NEAR(v.y, -9.81, 1e-9);
  tissue.position() = mesh.nodes, tissue.rest_here();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) tissue.velocity()[i] = cross(turn, mesh.nodes[i]);
  const dvec3 begin = spin_of(tissue);
  for (int i = 0; i < 240; ++i)
    step_tissue(tissue, *solver, 1.0 / 240, dvec3(0),
                {.scheme = Scheme::kMidpoint, .iterations = 50, .tolerance = 1e-12});
  EXPECT_LT(length(spin_of(tissue) - begin), 1e-6 * length(begin));
}

}  // namespace
}  // namespace pliant
