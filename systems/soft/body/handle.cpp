#include "systems/soft/body/handle.h"

#include <Eigen/Eigenvalues>

#include "runtime/assert.h"
#include "systems/soft/body/rotation_vector.h"

namespace pliant {
namespace {

// If the smallest moment of inertia is below this share of the largest, the body is a line: rotation about it has no
// inertia.
constexpr double kLine = 1e-6;

dmat3 point_inertia(double mass, dvec3 r) {
  return mass * (dot(r, r) * dmat3(1.0) - glm::outerProduct(r, r));
}

Eigen::Matrix3d to_eigen(const dmat3& m) {
  Eigen::Matrix3d out;
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col) out(row, col) = m[col][row];
  return out;
}

// Whether some axis has negligible moment of inertia.
bool on_a_line(const dmat3& inertia) {
  const Eigen::Vector3d moments = to_eigen(inertia).selfadjointView<Eigen::Lower>().eigenvalues();
  return !(moments[0] > kLine * moments[2]);
}

// Of a solid box about its centre.
dmat3 box_inertia(double mass, dvec3 size) {
  const dvec3 s = size * size;
  dmat3 out(0.0);
  out[0][0] = mass / 12.0 * (s.y + s.z);
  out[1][1] = mass / 12.0 * (s.z + s.x);
  out[2][2] = mass / 12.0 * (s.x + s.y);
  return out;
}

dmat3 turned(const dmat3& inertia, dquat rotation) {
  const dmat3 r = glm::mat3_cast(rotation);
  return r * inertia * glm::transpose(r);
}

}  // namespace

RigidMotion RigidMotion::at(dvec3 offset) const {
  const dvec3 arm = pose.rotation * offset;
  RigidMotion out = *this;
  out.pose.position += arm;
  out.velocity.head<3>() += grip_matrix(arm).rightCols<3>() * velocity.tail<3>();
  return out;
}

Grip grip_matrix(dvec3 r) {
  Grip g;
  g << 1, 0, 0, 0, r.z, -r.y,  //
      0, 1, 0, -r.z, 0, r.x,   //
      0, 0, 1, r.y, -r.x, 0;
  return g;
}

RigidHandle::RigidHandle(std::span<const dvec3> nodes, std::span<const double> mass, dvec3 body,
                         const Pose& placement) {
  ASSERT(!nodes.empty() && nodes.size() == mass.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    mass_ += mass[i];
    centre_ += mass[i] * nodes[i];
  }
  centre_ /= mass_;
  for (const dvec3 node : nodes) rest_arm_.push_back(node - centre_);

  inertia_ = dmat3(0.0);
  for (std::size_t i = 0; i < nodes.size(); ++i) inertia_ += point_inertia(mass[i], rest_arm_[i]);
  lent_ = on_a_line(inertia_) ? box_inertia(mass_, body) : dmat3(0.0);
  inertia_ += lent_;

  motion_.pose = {placement.to_world(centre_), placement.rotation};
  turn_arms();
}

RigidHandle::RigidHandle(double mass, dvec3 centre, const dmat3& inertia, const Pose& placement)
    : centre_(centre), mass_(mass), inertia_(inertia) {
  motion_.pose = {placement.to_world(centre_), placement.rotation};
}

void RigidHandle::place(const Pose& object) {
  motion_.pose = {object.to_world(centre_), object.rotation};
  motion_.velocity.setZero();
  turn_arms();
}

Pose RigidHandle::object_pose() const {
  return {motion_.pose.position - motion_.pose.rotation * centre_, motion_.pose.rotation};
}

Matrix6 RigidHandle::mass_matrix() const {
  Matrix6 out = Matrix6::Zero();
  out.diagonal().head<3>().setConstant(mass_);
  out.bottomRightCorner<3, 3>() = to_eigen(turned(inertia_, motion_.pose.rotation));
  return out;
}

Matrix6 RigidHandle::lent_mass() const {
  Matrix6 out = Matrix6::Zero();
  out.bottomRightCorner<3, 3>() = to_eigen(turned(lent_, motion_.pose.rotation));
  return out;
}

void RigidHandle::advance(double T) {
  Pose& pose = motion_.pose;
  const dvec3 spin = angular(motion_.velocity);
  const dvec3 momentum = turned(inertia_, pose.rotation) * spin;
  pose.position += T * linear(motion_.velocity);
  pose.rotation = glm::normalize(rotation_of(T * spin) * pose.rotation);
  turn_arms();
  const dvec3 new_spin = glm::inverse(turned(inertia_, pose.rotation)) * momentum;
  motion_.velocity = join(linear(motion_.velocity), new_spin);
}

void RigidHandle::turn_arms() {
  arm_.resize(rest_arm_.size());
  for (std::size_t i = 0; i < arm_.size(); ++i) arm_[i] = motion_.pose.rotation * rest_arm_[i];
}

}  // namespace pliant
