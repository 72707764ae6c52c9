// The bond between device and handle, by finite differences, limits and energy.
#include "systems/soft/body/coupling.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>
#include <random>

#include "systems/soft/body/rotation_vector.h"

namespace pliant {
namespace {

constexpr double kPi = std::numbers::pi;

Handle6 usual_handle() {
  Handle6 handle;
  handle.translation = {200.0, 2.0};
  handle.rotation = {0.5, 0.005};
  handle.max_force = 3.3;
  handle.max_torque = 0.3;
  return handle;
}
const Handle6 kHandle = usual_handle();

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double number(double size) { return std::uniform_real_distribution(-size, size)(engine_); }
  dvec3 vector(double size) { return {number(size), number(size), number(size)}; }
  // A rotation by exactly `angle` about any axis.
  dquat rotation(double angle) { return rotation_of(angle * normalize(vector(1.0))); }
  Vector6 six(double linear_size, double angular_size) { return join(vector(linear_size), vector(angular_size)); }

 private:
  std::mt19937 engine_;
};

RigidMotion moved(RigidMotion motion, const Vector6& by) {
  motion.pose.position += linear(by);
  motion.pose.rotation = rotation_of(angular(by)) * motion.pose.rotation;
  return motion;
}
RigidMotion pushed(RigidMotion motion, const Vector6& by) {
  motion.velocity += by;
  return motion;
}

// A handle and a device `reach` [m] and `angle` [rad] apart, moving at up to `speed` [m/s] and 10 speed [rad/s].
struct Pair {
  RigidMotion handle, device;
};
Pair any_pair(Dice& dice, double reach, double angle, double speed) {
  const dquat q = dice.rotation(dice.number(3.0));
  const dvec3 x = dice.vector(0.1);
  return {.handle = {{x, q}, dice.six(speed, 10 * speed)},
          .device = {{x + reach * normalize(dice.vector(1.0)), dice.rotation(angle) * q}, dice.six(speed, 10 * speed)}};
}

// log2 of how much the error shrinks when the step is halved: 2 for a derivative.
template <class ErrorOf>
double slope(ErrorOf error, double step) {
  return std::log2(error(step) / error(step / 2));
}

TEST(RotationVector, IsExactFromNothingToHalfATurn) {
  Dice dice(1);
  for (const double angle : {0.0, 1e-300, 1e-12, 1e-7, 9e-5, 1.1e-4, 1e-2, 1.0, 3.0, kPi - 1e-3, kPi - 1e-8}) {
    const dvec3 vector = angle * normalize(dice.vector(1.0));
    EXPECT_LE(length(vector_of(rotation_of(vector)) - vector), 4e-16 * (1 + angle)) << angle;
    EXPECT_LE(length(vector_of(-rotation_of(vector)) - vector), 4e-16 * (1 + angle)) << angle;
  }
}

TEST(RotationVector, GoesTheShorterWayRound) {
  const dvec3 axis = normalize(dvec3(1, 2, -2));
  EXPECT_LT(length(vector_of(rotation_of((kPi + 0.1) * axis)) - (0.1 - kPi) * axis), 1e-15);
  EXPECT_NEAR(length(vector_of(rotation_of(kPi * axis))), kPi, 1e-15);
}

TEST(Coupling, IsTheAuthoredSpringAndDamperWhileItIsWeak) {
  RigidMotion handle, device;
  device.pose = {{1e-5, 0, -2e-5}, rotation_of({0, 1e-4, 0})};
  device.velocity = join({0, 1e-4, 0}, {1e-4, 0, 0});
  const Vector6 expected = join({200 * 1e-5, 2 * 1e-4, -200 * 2e-5}, {0.005 * 1e-4, 0.5 * 1e-4, 0});
  EXPECT_LT((coupling_force(kHandle, handle, device).wrench - expected).norm(), 1e-6 * expected.norm());
}

TEST(Coupling, NeverPullsHarderThanItsLimitAndReachesIt) {
  Dice dice(2);
  for (const double reach : {1e-3, 1e-2, 0.1, 1.0, 1e3, 1e100, 1e300}) {
    Pair p = any_pair(dice, reach, 2.5, 0.0);
    const CouplingForce still = coupling_force(kHandle, p.handle, p.device);
    EXPECT_LE(still.wrench.head<3>().norm(), kHandle.max_force * (1 + 1e-15));
    EXPECT_LE(still.wrench.tail<3>().norm(), kHandle.max_torque * (1 + 1e-15));
    const double expected = kHandle.max_force * std::tanh(200 * reach / kHandle.max_force);
    EXPECT_NEAR(still.wrench.head<3>().norm(), expected, 1e-9 * expected);
    // The damper has as much again.
    p.device.velocity = Vector6::Constant(reach);
    const CouplingForce moving = coupling_force(kHandle, p.handle, p.device);
    EXPECT_TRUE(moving.wrench.allFinite() && moving.stiffness.allFinite() && moving.secant_damping.allFinite());
    EXPECT_LE((moving.wrench - still.wrench).head<3>().norm(), kHandle.max_force * (1 + 1e-12));
  }
}

TEST(Coupling, WithoutAnyStrengthDoesNothing) {
  Dice dice(3);
  Handle6 limp = kHandle;
  limp.max_force = limp.max_torque = 0.0;
  const Pair p = any_pair(dice, 0.1, 1.0, 1.0);
  const CouplingForce force = coupling_force(limp, p.handle, p.device);
  EXPECT_EQ(force.wrench.norm() + force.stiffness.norm() + force.damping.norm(), 0.0);
  EXPECT_EQ(force.secant_stiffness.norm() + force.secant_damping.norm(), 0.0);
}

TEST(Coupling, StiffnessIsTheForcesDerivativeToSecondOrder) {
  Dice dice(4);
  for (const double reach : {3e-3, 1e-2, 2e-2})
    for (const double angle : {0.3, 1.0, 2.5}) {
      const Pair p = any_pair(dice, reach, angle, 0.3);
      const CouplingForce at = coupling_force(kHandle, p.handle, p.device);
      const Vector6 along = dice.six(1e-3, 0.1);
      const auto change = [&](double h) -> Vector6 {
        return coupling_force(kHandle, moved(p.handle, h * along), p.device).wrench - at.wrench +
               h * at.stiffness * along;
      };
      EXPECT_NEAR(slope([&](double h) { return change(h).head<3>().norm(); }, 0.1), 2.0, 0.05);
      // The torque's skew part does no work: the remaining difference along the motion is of second order.
      EXPECT_NEAR(slope(
                      [&](double h) {
                        return std::abs(angular(along).x * change(h)[3] + angular(along).y * change(h)[4] +
                                        angular(along).z * change(h)[5]);
                      },
                      0.02),
                  2.0, 0.2);
    }
}

TEST(Coupling, DampingIsTheForcesDerivativeToSecondOrder) {
  Dice dice(5);
  for (const double speed : {0.3, 1.0, 3.0}) {
    const Pair p = any_pair(dice, 1e-2, 1.0, speed);
    const CouplingForce at = coupling_force(kHandle, p.handle, p.device);
    const Vector6 along = dice.six(speed, 10 * speed);
    const auto error = [&](double h) {
      return (coupling_force(kHandle, pushed(p.handle, h * along), p.device).wrench - at.wrench +
              h * at.damping * along)
          .norm();
    };
    EXPECT_NEAR(slope(error, 0.02), 2.0, 0.1);
  }
}

TEST(Coupling, TheSkewPartOfTheTorquesDerivativeIsHalfTheTorque) {
  // The part omitted by the symmetric tangent: -(1/2) [tau]x, exactly, where the spring is not saturated.
  Dice dice(6);
  Handle6 strong = kHandle;
  strong.max_torque = 1e6;
  const Pair p = any_pair(dice, 0.0, 1.2, 0.0);
  const CouplingForce at = coupling_force(strong, p.handle, p.device);
  for (int axis = 0; axis < 3; ++axis) {
    Vector6 along = Vector6::Zero();
    along[3 + axis] = 1e-5;
    const Vector6 there = coupling_force(strong, moved(p.handle, along), p.device).wrench;
    const Vector6 back = coupling_force(strong, moved(p.handle, -along), p.device).wrench;
    const dvec3 left = angular((there - back) / 2e-5 + at.stiffness * along / 1e-5);
    EXPECT_LT(length(left + 0.5 * cross(angular(at.wrench), angular(along) / 1e-5)), 1e-9) << axis;
  }
}

TEST(Coupling, TangentsAreSymmetricAndSemidefiniteUpToHalfATurn) {
  Dice dice(7);
  for (int i = 0; i < 300; ++i) {
    const double angle = i % 3 == 0 ? kPi : i % 3 == 1 ? kPi - 1e-9 : std::abs(dice.number(kPi));
    const Pair p = any_pair(dice, std::abs(dice.number(0.1)), angle, dice.number(3.0));
    const CouplingForce at = coupling_force(kHandle, p.handle, p.device);
    for (const Matrix6& m : {at.stiffness, at.damping}) {
      EXPECT_EQ((m - m.transpose()).norm(), 0.0);
      EXPECT_GE(m.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-14 * m.norm());
    }
  }
}

TEST(Coupling, ItsEnergyIsTheWorkAgainstItsSprings) {
  Dice dice(8);
  for (int i = 0; i < 20; ++i) {
    const Pair p = any_pair(dice, std::abs(dice.number(0.05)), std::abs(dice.number(3.0)), 0.0);
    RigidMotion handle = p.handle, device = p.device;
    handle.velocity = device.velocity = Vector6::Zero();
    const Vector6 along = dice.six(1e-6, 1e-5);
    const double gain = coupling_energy(kHandle, moved(handle, along), device) -
                        coupling_energy(kHandle, moved(handle, -along), device);
    const double work = -2 * coupling_force(kHandle, handle, device).wrench.dot(along);
    EXPECT_NEAR(gain, work, 1e-6 * along.norm());
  }
}

// A rigid ball on the coupling, stepped implicitly.
struct Ball {
  static constexpr double kMass = 0.05, kInertia = 2e-5;  // [kg], [kg m2]
  RigidMotion motion;
  double energy() const {
    return 0.5 * kMass * motion.velocity.head<3>().squaredNorm() +
           0.5 * kInertia * motion.velocity.tail<3>().squaredNorm();
  }
  void step(const RigidMotion& device, double T) {
    const CouplingStep c = coupling_step(coupling_force(kHandle, motion, device), motion, device, T);
    const Vector6 mass = join(dvec3(kMass), dvec3(kInertia));
    motion.velocity = (mass.cwiseProduct(motion.velocity) + c.right).cwiseQuotient(mass + c.matrix);
    motion = moved(motion, T * motion.velocity);
  }
};

TEST(Coupling, AHandleLetGoFarFromItsDeviceOnlyLosesEnergyAndArrives) {
  for (const double T : {1e-4, 1e-3, 1.0 / 60, 0.1}) {
    Ball ball;
    RigidMotion device;
    device.pose = {{1.0, -0.3, 0.2}, rotation_of({0.5, 3.0, -0.3})};
    double before = coupling_energy(kHandle, ball.motion, device);
    const double start = before;
    for (int i = 0; i < 30.0 / T && i < 40000; ++i) {
      ball.step(device, T);
      const double now = ball.energy() + coupling_energy(kHandle, ball.motion, device);
      ASSERT_LE(now, before + 1e-14 * start) << "T " << T << " step " << i;
      before = now;
    }
    EXPECT_LT(before, 1e-6 * start) << T;
  }
}

TEST(Coupling, AHandHasToPutInWhatTheHandleGets) {
  Dice dice(9);
  for (const double T : {1e-3, 1.0 / 60, 0.1}) {
    Ball ball;
    RigidMotion device;
    double put_in = 0.0;
    for (int i = 0; i < 2000; ++i) {
      device.velocity = join(dice.vector(i % 40 == 0 ? 30.0 : 1.0), dvec3(0));
      const CouplingForce force = coupling_force(kHandle, ball.motion, device);
      const CouplingStep c = coupling_step(force, ball.motion, device, T);
      ball.step(device, T);
      const Vector6 impulse = c.right - c.matrix.cwiseProduct(ball.motion.velocity);
      put_in += impulse.dot(device.velocity);
      device = moved(device, T * device.velocity);
      ASSERT_LE(ball.energy() + coupling_energy(kHandle, ball.motion, device), put_in + 1e-9) << T << ' ' << i;
    }
  }
}

TEST(Coupling, TheSameMotionIsSeenFromAnyPointOfTheFrame) {
  Dice dice(10);
  const RigidMotion motion{{dice.vector(1.0), dice.rotation(1.0)}, dice.six(1.0, 1.0)};
  const dvec3 offset = dice.vector(1.0);
  const double h = 1e-6;
  const dvec3 ahead = moved(motion, h * motion.velocity).pose.to_world(offset);
  const dvec3 behind = moved(motion, -h * motion.velocity).pose.to_world(offset);
  EXPECT_LT(length(linear(motion.at(offset).velocity) - (ahead - behind) / (2 * h)), 1e-9);
  EXPECT_EQ(motion.at(offset).pose.position, motion.pose.to_world(offset));
}

}  // namespace
}  // namespace pliant
