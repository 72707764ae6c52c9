#include "systems/soft/body/coupling.h"

#include "systems/soft/body/rotation_vector.h"

namespace pliant {
namespace {

// A force f of any size, saturated: s(f) = F_max tanh(|f| / F_max) f / |f|, and its derivatives by f.
struct Saturated {
  dvec3 force{0};       // s(f)
  dvec3 direction{0};   // f / |f|; zero for zero f
  double secant = 1.0;  // [1] |s(f)| / |f|; also its derivative across f
  double along = 1.0;   // [1] its derivative along f: 1 / cosh^2
};
Saturated saturate(dvec3 f, double limit) {
  // Scaled by the largest component, so that no square overflows.
  const double largest = std::max({std::abs(f.x), std::abs(f.y), std::abs(f.z)});
  if (!(largest > 0)) return {};
  if (!(limit > 0)) return {.secant = 0.0, .along = 0.0};
  const dvec3 scaled = f / largest;
  const double size = length(scaled), x = largest / limit * size, t = std::tanh(x);
  Saturated out;
  out.direction = scaled / size;
  out.force = limit * t * out.direction;
  out.secant = x < 1e-4 ? 1.0 - x * x / 3.0 : t / x;
  out.along = 1.0 - t * t;
  return out;
}

// The derivative of s as a matrix.
dmat3 tangent(const Saturated& s) {
  return s.secant * dmat3(1.0) + (s.along - s.secant) * glm::outerProduct(s.direction, s.direction);
}

// The symmetric part of -d log(q_d q^-1) / d(rotation of q): 1 along the vector, (angle/2) cot(angle/2) across it,
// which falls from 1 at zero angle to 0 at pi. The skew part only rotates the frame and does no work.
dmat3 closing(dvec3 vector) {
  const double half = 0.5 * length(vector);
  if (half < 1e-4)
    return dmat3(1.0) - (1.0 / 12.0) * (dot(vector, vector) * dmat3(1.0) - glm::outerProduct(vector, vector));
  const double across = std::max(0.0, half * std::cos(half) / std::sin(half));
  const dvec3 axis = vector / (2.0 * half);
  return across * dmat3(1.0) + (1.0 - across) * glm::outerProduct(axis, axis);
}

Eigen::Matrix3d symmetric(const dmat3& m) {
  Eigen::Matrix3d out;
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col) out(row, col) = 0.5 * (m[col][row] + m[row][col]);
  return out;
}

// ln cosh, without overflow.
double ln_cosh(double x) {
  return x + std::log1p(std::exp(-2.0 * x)) - std::log(2.0);
}

// [J] of a spring k with saturated force: the integral of F_max tanh(k x / F_max).
double saturated_energy(double k, double stretch, double limit) {
  return k > 0 && limit > 0 ? limit * limit / k * ln_cosh(k * stretch / limit) : 0.0;
}

dvec3 turn_left(const RigidMotion& motion, const RigidMotion& device) {
  return vector_of(device.pose.rotation * glm::conjugate(motion.pose.rotation));
}

}  // namespace

CouplingForce coupling_force(const Handle6& handle, const RigidMotion& motion, const RigidMotion& device) {
  const auto [k_t, b_t] = handle.translation;
  const auto [k_r, b_r] = handle.rotation;
  const Vector6 slip = device.velocity - motion.velocity;
  const dvec3 turn = turn_left(motion, device);
  const Saturated spring = saturate(k_t * (device.pose.position - motion.pose.position), handle.max_force);
  const Saturated damper = saturate(b_t * linear(slip), handle.max_force);
  const Saturated twist = saturate(k_r * turn, handle.max_torque);
  const Saturated brake = saturate(b_r * angular(slip), handle.max_torque);

  CouplingForce out;
  out.wrench = join(spring.force + damper.force, twist.force + brake.force);
  out.stiffness.topLeftCorner<3, 3>() = k_t * symmetric(tangent(spring));
  out.stiffness.bottomRightCorner<3, 3>() = k_r * symmetric(tangent(twist) * closing(turn));  // both about one axis
  out.damping.topLeftCorner<3, 3>() = b_t * symmetric(tangent(damper));
  out.damping.bottomRightCorner<3, 3>() = b_r * symmetric(tangent(brake));
  out.secant_stiffness = join(dvec3(k_t * spring.secant), dvec3(k_r * twist.secant));
  out.secant_damping = join(dvec3(b_t * damper.secant), dvec3(b_r * brake.secant));
  return out;
}

double coupling_energy(const Handle6& handle, const RigidMotion& motion, const RigidMotion& device) {
  return saturated_energy(handle.translation[0], length(device.pose.position - motion.pose.position),
                          handle.max_force) +
         saturated_energy(handle.rotation[0], length(turn_left(motion, device)), handle.max_torque);
}

CouplingStep coupling_step(const CouplingForce& force, const RigidMotion& motion, const RigidMotion& device, double T) {
  const Vector6 &K = force.secant_stiffness, &B = force.secant_damping;
  return {.matrix = T * B + T * T * K,
          .right = T * (force.wrench + B.cwiseProduct(motion.velocity) + T * K.cwiseProduct(device.velocity))};
}

}  // namespace pliant
