#include "devices/drivers/falcon_delta.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr double kPi = 3.14159265358979323846;
// [m] the lengths of (1)
constexpr double a = 0.060, b = 0.1025, c = 0.01443, d = 0.01125, e = d, f = -0.025, r = 0.040, s = -0.02309;
constexpr double kLeg[3] = {kPi / 2 + kPi / 12, -kPi / 6 + kPi / 12, -5 * kPi / 6 + kPi / 12};  // [rad] about z
constexpr double kSlots = 320.0, kShaft = 0.01425, kCapstan = 0.110;                            // [1] [m] [m]
constexpr double kAngleAtZero = 35.0 * kPi / 180.0;                                             // [rad] at count 0

}  // namespace

double falcon_angle(int count) {
  // Four counts per slot; the shaft drives the leg by a cable.
  return count / (4.0 * kSlots) * 2.0 * kPi * kShaft / kCapstan + kAngleAtZero;
}

bool falcon_angles(const dvec3& position, FalconPose& pose) {
  for (int i = 0; i < 3; ++i) {
    const double cosine = std::cos(kLeg[i]), sine = std::sin(kLeg[i]);
    const double u = cosine * position.x + sine * position.y - r, v = -sine * position.x + cosine * position.y - s;
    const double A = u + c, B = position.z, cosine3 = (v + f) / b;
    if (!(std::abs(cosine3) < 1.0)) return false;
    const double sine3 = std::sqrt(1.0 - cosine3 * cosine3), L = d + e + b * sine3;
    const double reach = std::hypot(A, B), ratio = (reach * reach + a * a - L * L) / (2.0 * a * reach);
    if (!(std::abs(ratio) < 1.0)) return false;
    const double t = std::atan2(B, A) - std::acos(ratio);  // the knee points outward
    pose.angle[i] = t;
    // Of (1), halved: G_u du + G_v dv + G_w dw + G_t dt = 0.
    const double G_u = A - a * std::cos(t), G_w = B - a * std::sin(t), G_v = L * cosine3 / sine3;
    const double G_t = a * (A * std::sin(t) - B * std::cos(t));
    if (!(std::abs(G_t) > 1e-6)) return false;  // singular pose
    pose.jacobian[0][i] = -(cosine * G_u - sine * G_v) / G_t;
    pose.jacobian[1][i] = -(sine * G_u + cosine * G_v) / G_t;
    pose.jacobian[2][i] = -G_w / G_t;
  }
  return true;
}

bool falcon_position(const dvec3& angle, dvec3& position) {
  constexpr double kLargest = 0.01;  // [m] largest Newton step: prevents a jump to another solution
  dvec3 guess = position;
  for (int i = 0; i < 50; ++i) {
    FalconPose pose;
    if (!falcon_angles(guess, pose)) return false;
    const dvec3 off = angle - pose.angle;
    if (std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) < 1e-10) {
      position = guess;
      return true;
    }
    const double det = glm::determinant(pose.jacobian);
    if (!(std::abs(det) > 1e-3)) return false;
    dvec3 step = glm::inverse(pose.jacobian) * off;
    if (const double size = glm::length(step); size > kLargest) step *= kLargest / size;
    guess += step;
  }
  return false;
}

bool falcon_torques(const FalconPose& pose, const dvec3& force, dvec3& torque) {
  // Power: torque . d angle = force . dx for every dx, so force = Jt torque.
  const double det = glm::determinant(pose.jacobian);
  if (!(std::abs(det) > 1e-3)) return false;
  torque = glm::inverse(glm::transpose(pose.jacobian)) * force;
  return true;
}

}  // namespace pliant
