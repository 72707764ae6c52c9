// A soft body in the soft step, with a rigid handle (a tool) or without one. Degrees of freedom: velocities of its
// moving nodes, 3 each, then the handle's six. Nodes that are slaved to the handle ride on it, pinned ones stand still.
// Writer: the soft clock; one thread at a time, as answers use scratch memory.
#pragma once

#include <memory>
#include <optional>

#include "components/soft_body.h"
#include "systems/tool/body.h"
#include "systems/tool/coupling.h"
#include "systems/tool/flesh.h"
#include "systems/tool/handle.h"
#include "systems/tool/handle_tie.h"
#include "systems/tool/schur.h"

namespace pliant {

class SoftBodyState final : public Body {
 public:
  // `tets` and `skin` outlive it. `handle`: null where none is (its nodes, if any, then move freely). `placement`:
  // object frame to world at the start.
  SoftBodyState(const TetMesh& tets, const Mesh& skin, const SoftBody& body, const Handle6* handle,
                const Pose& placement, SolverKind solver = SolverKind::kAuto);
  // The same over a black box of the caller's.
  SoftBodyState(const TetMesh& tets, const Mesh& skin, const SoftBody& body, const Handle6* handle,
                const Pose& placement, std::unique_ptr<LinearSolver> solver);

  int size() const override { return static_cast<int>(solver_.size()); }
  void free_step(double T, dvec3 gravity) override;
  const Vector& velocity() const override { return velocity_; }
  void push(const SurfacePoint& point, dvec3 impulse, Rows& columns, Eigen::Index column) const override;
  void gather(const SurfacePoint& point, const dmat3& axes, double sign, const Rows& x,
              Eigen::Ref<Rows> out) const override;
  void solve(Rows& columns) const override { solver_.solve(columns); }
  void respond(std::span<const PushedSide> sides, Eigen::Index contacts, Compliance& out) const override;
  void correct(const Vector& dv) override { velocity_ += dv; }
  void move_skin(std::vector<dvec3>& out) const override;
  void advance(double T) override;
  void weigh(const Rows& x, Rows& out) const override;
  RayleighDamping damping() const override { return damping_; }
  Vector starting_velocity() const override;
  void halt() override;
  void show(SoftObjectSnapshot& out) const override;

  const Flesh& flesh() const { return flesh_; }
  void set_tie_stiffness(double ratio) { tie_->stiffness = ratio; }  // [1] handle_tie.h; with spring attachment
  bool solvable() const override {
    return solvable_;
  }  // false: the last step's matrix could not be factorised; nothing moved

  // The device that holds the handle: its pose and velocity (of the frame that the object's own frame is to follow),
  // now; it is taken to keep that velocity for a step. Not finite: released. Only with a handle.
  void set_device(const Pose& pose, const Vector6& velocity);
  void release_device() { device_.reset(), led_.reset(); }
  // From now on the handle is moved as it is told, whatever pulls at it: its centre to `end` over the next step.
  void lead_handle(const RigidMotion& end) { led_ = end; }
  // [m], [rad] from where `handle` ends a step to where it was led; zero where it is not led.
  Vector6 short_of_lead(const RigidMotion& handle) const;

  // Before the first step: a tool's flesh as it rests under gravity while its handle is held where it is. Left in its
  // rest shape it would fall and sway, and the hand would be given that work. Nothing without a handle. It knows of no
  // contacts: unsettle() goes back to the rest shape.
  void settle(dvec3 gravity);
  void unsettle();

  // --- Of the handle; all of the last free_step, at its beginning, unless said otherwise. Only with a handle.
  bool has_handle() const { return handle_.has_value(); }
  const Handle6& handle_settings() const { return settings_; }
  const RigidHandle& handle() const { return *handle_; }  // now
  // J_h - J_t Z: out (3 x 6) += sign * axes^T times how a skin point moves with the handle when flesh follows.
  void handle_rows(const SurfacePoint& point, const dmat3& axes, double sign, Eigen::Ref<Rows> out) const;
  // columns = A_tt^-1 columns (3 * moving nodes rows): the black box, handle held still.
  void solve_held(Eigen::Ref<Rows> columns) const { solver_.solve_held(columns); }
  const Matrix6& reduced() const { return solver_.reduced(); }  // S = handle_mass + flesh_matrix + coupling [kg]
  const Rows& follow() const { return solver_.follow(); }       // [-Z; 1], size() x 6
  const Matrix6& handle_mass() const { return handle_mass_; }   // M_h [kg], [kg m2]
  // [N], [N m] at the centre: M_h's weight, and what carries the tool while a device holds it.
  const Vector6& handle_load() const { return handle_load_; }
  // What flesh does to the handle in this step, as a linear function of the handle's velocity w over it:
  //   T F(w) = T flesh_wrench - flesh_matrix (w - w0),  w0 the velocity at the step's beginning,
  // mass-proportional damping of M_h included; its inertia and weight, coupling and contacts left out.
  const Matrix6& flesh_matrix() const { return flesh_matrix_; }  // [kg], [kg m2] symmetric, positive semidefinite
  const Vector6& flesh_wrench() const { return flesh_wrench_; }  // [N], [N m] world, at the centre, for w = w0
  bool held() const { return device_.has_value(); }              // a device holds the handle
  // Where the device wants the handle's own frame.
  RigidMotion device_target() const { return device_ ? device_->at(handle_->centre()) : handle_->motion(); }
  const CouplingForce& coupling() const { return coupling_; }  // at the step's beginning; zero while released
  // [N], [N m] world, on the handle at its centre: what the coupling did over the step, with the velocity as it is now.
  Vector6 coupling_wrench() const;
  // The same of flesh and contacts together: what the handle's momentum and the coupling leave over.
  Vector6 handle_wrench() const;

 private:
  // Calls use(node, weight) for the nodes that a point of the skin rides on. Weights of zero are left out: most skins
  // stand on nodes, and a vertex of such a skin rides on one node of twelve.
  template <class Use>
  void for_each_node(const SurfacePoint& point, Use use) const;
  bool slaved(std::uint32_t node) const { return node >= flesh_.moving() && node < tets_.pinned_begin(); }
  Eigen::Index handle_row() const { return 3 * static_cast<Eigen::Index>(flesh_.moving()); }
  dvec3 arm(std::uint32_t node) const { return handle_->arm(node - tets_.free_count); }
  dvec3 node_velocity(std::uint32_t node) const;  // [m/s] by velocity()
  void couple(double T, dvec3 gravity);
  Vector6 support(dvec3 gravity) const;
  void separate_flesh(double T);
  void refresh_skin(const std::vector<dvec3>& of_nodes, std::vector<dvec3>& of_skin) const;

  const TetMesh& tets_;
  Handle6 settings_;
  RayleighDamping damping_;
  Flesh flesh_;
  std::optional<RigidHandle> handle_;
  std::optional<HandleTie> tie_;
  double mass_ = 0.0;  // [kg] of flesh and handle
  dvec3 balance_{0};   // [m] from the handle's centre to that mass's, at rest, object axes
  CoupledSolver solver_;
  mutable BlockColumns pushed_;  // respond()'s
  bool solvable_ = true;
  double T_ = 0.0;  // [s] of the last free_step
  Vector velocity_;
  std::optional<RigidMotion> device_, led_;
  CouplingForce coupling_;
  CouplingStep coupling_step_;
  Vector6 start_ = Vector6::Zero();  // w0
  Matrix6 handle_mass_ = Matrix6::Zero(), flesh_matrix_ = Matrix6::Zero();
  Vector6 handle_load_ = Vector6::Zero(), flesh_wrench_ = Vector6::Zero();
};

}  // namespace pliant
