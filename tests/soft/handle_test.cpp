// The rigid handle by itself: inertia, momentum, free turning.
#include "systems/soft/body/handle.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "systems/soft/body/rotation_vector.h"

namespace pliant {
namespace {

constexpr double T = 1.0 / 60;  // [s]

dvec3 random_vector(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = uniform(random), y = uniform(random);
  return {x, y, uniform(random)};
}

// Points of different masses, none on a line with two others.
RigidHandle uneven_handle(std::vector<dvec3>& nodes, std::vector<double>& mass) {
  std::mt19937 random(1);
  for (int i = 0; i < 7; ++i) {
    nodes.push_back(random_vector(random) * dvec3(0.01, 0.02, 0.05));
    mass.push_back(1e-3 * (1 + i));
  }
  return RigidHandle(nodes, mass, dvec3(0.1), {{0.1, 0.2, 0.3}, rotation_of({0.4, -1.0, 0.3})});
}

TEST(RigidHandle, HasTheKineticEnergyOfItsNodes) {
  std::vector<dvec3> nodes;
  std::vector<double> mass;
  RigidHandle handle = uneven_handle(nodes, mass);
  const Vector6 w = join({0.3, -0.2, 0.5}, {3, 1, -2});
  double energy = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Vector3d v = grip_matrix(handle.arm(i)) * w;
    energy += 0.5 * mass[i] * v.squaredNorm();
  }
  EXPECT_NEAR(0.5 * w.dot(handle.mass_matrix() * w), energy, 1e-14 * energy);
  EXPECT_EQ(handle.lent_mass().norm(), 0.0);
}

TEST(RigidHandle, NodesKeepTheirPlacesInTheObject) {
  std::vector<dvec3> nodes;
  std::vector<double> mass;
  RigidHandle handle = uneven_handle(nodes, mass);
  handle.set_velocity(join({0.1, 0, 0}, {20, 3, -9}));
  for (int i = 0; i < 100; ++i) handle.advance(T);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const dvec3 rides = handle.motion().pose.position + handle.arm(i);
    EXPECT_LT(length(rides - handle.object_pose().to_world(nodes[i])), 1e-15);
  }
}

TEST(RigidHandle, SpinsFreelyWithItsMomentumKeptAndItsEnergyBounded) {
  std::vector<dvec3> nodes;
  std::vector<double> mass;
  RigidHandle handle = uneven_handle(nodes, mass);
  handle.set_velocity(join({0, 0, 0}, {10, 7, -5}));
  const Vector6 momentum = handle.mass_matrix() * handle.motion().velocity;
  const Eigen::Vector3d moments =
      handle.mass_matrix().bottomRightCorner<3, 3>().selfadjointView<Eigen::Lower>().eigenvalues();
  for (int i = 0; i < 10000; ++i) {
    handle.advance(0.05);  // half a radian a step
    const Vector6& w = handle.motion().velocity;
    ASSERT_LT((handle.mass_matrix() * w - momentum).norm(), 1e-10 * momentum.norm());
    const double energy = 0.5 * w.dot(momentum), square = momentum.squaredNorm();
    ASSERT_LE(energy, 0.5 * square / moments[0] * (1 + 1e-9));
    ASSERT_GE(energy, 0.5 * square / moments[2] * (1 - 1e-9));
  }
}

TEST(RigidHandle, TumblesAsEulersEquationsSay) {
  // Against d(omega)/dt = -I^-1 (omega x I omega) in the body's frame, RK4 at a fine step. First order in T.
  std::vector<dvec3> nodes;
  std::vector<double> mass;
  const dvec3 spin{4, 9, -6};
  const auto error = [&](double dt) {
    nodes.clear(), mass.clear();
    RigidHandle handle = uneven_handle(nodes, mass);
    const dquat start = handle.motion().pose.rotation;
    const Eigen::Matrix3d R = Eigen::Quaterniond(start.w, start.x, start.y, start.z).toRotationMatrix();
    const Eigen::Matrix3d I = R.transpose() * handle.mass_matrix().bottomRightCorner<3, 3>() * R;
    Eigen::Vector3d w = R.transpose() * Eigen::Vector3d(spin.x, spin.y, spin.z);
    const auto rate = [&](const Eigen::Vector3d& o) -> Eigen::Vector3d { return I.ldlt().solve((I * o).cross(o)); };
    const double h = 1e-4;
    for (int i = 0; i < 5000; ++i) {
      const Eigen::Vector3d a = rate(w), b = rate(w + h / 2 * a), c = rate(w + h / 2 * b), d = rate(w + h * c);
      w += h / 6 * (a + 2 * b + 2 * c + d);
    }
    handle.set_velocity(join(dvec3(0), spin));
    for (int i = 0; i < static_cast<int>(std::lround(0.5 / dt)); ++i) handle.advance(dt);
    const dvec3 now = glm::conjugate(handle.motion().pose.rotation) * angular(handle.motion().velocity);
    return (Eigen::Vector3d(now.x, now.y, now.z) - w).norm();
  };
  EXPECT_NEAR(error(4e-4) / error(2e-4), 2.0, 0.1);
  EXPECT_NEAR(error(2e-4) / error(1e-4), 2.0, 0.05);
}

TEST(RigidHandle, OfNodesOnALineCanStillBeTurnedAboutIt) {
  const std::vector<dvec3> line{{0, 0, 0}, {0.01, 0, 0}, {0.02, 0, 0}}, point{{0.3, 0, 0}};
  const std::vector<double> masses{1e-3, 1e-3, 1e-3}, mass{1e-3};
  for (const RigidHandle& handle :
       {RigidHandle(line, masses, {0.05, 0.02, 0.02}, {}), RigidHandle(point, mass, {0.05, 0.02, 0.02}, {})}) {
    const Matrix6 m = handle.mass_matrix();
    const Eigen::Vector3d moments = m.bottomRightCorner<3, 3>().selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GT(moments.minCoeff(), 1e-2 * m(0, 0) * 0.02 * 0.02);
    EXPECT_GT(handle.lent_mass().norm(), 0.0);
  }
}

}  // namespace
}  // namespace pliant
