// A rigid instrument: a rigid body that is its own handle (a stylus, a probe, a scalpel's grip). The same coupling,
// contacts and 1 kHz tick as for a tool of tissue, but without tissue between handle and contact. Writer: the soft
// clock.
#pragma once

#include <Eigen/Cholesky>

#include "systems/soft/body/rigid_state.h"
#include "systems/soft/body/tool_body.h"

namespace pliant {

class RigidTool final : public ToolBody {
 public:
  // `collision mesh` outlives it. `placement`: object frame to world at the start.
  RigidTool(const Mesh& surface, const RigidMass& mass, const Handle6& handle, const Pose& placement);

  int size() const override { return 6; }
  void free_step(double T, dvec3 gravity) override;
  bool solvable() const override { return solvable_; }
  void push(const SurfacePoint& point, dvec3 impulse, Rows& columns, Eigen::Index column) const override;
  void gather(const SurfacePoint& point, const dmat3& axes, double sign, const Rows& x,
              Eigen::Ref<Rows> out) const override;
  void solve(Rows& columns) const override;
  void respond(std::span<const PushedSide> sides, Eigen::Index contacts, Compliance& out) const override;
  void move_surface(std::vector<dvec3>& out) const override;
  void advance(double T) override;
  void weigh(const Rows& x, Rows& out) const override { out = handle_mass_ * x; }
  Vector starting_velocity() const override { return start_; }
  void halt() override;
  void set_mass(const RigidMass& mass) override;
  std::optional<Pose> pose_after(double T) const override;
  void show(SoftObjectSnapshot& out) const override;
  void unsettle() override { refresh_surface(); }
  const Rows& follow() const override { return follow_; }
  void solve_held(Eigen::Ref<Rows>) const override {}  // no tissue

 private:
  void refresh_surface();

  Rows follow_ = Matrix6::Identity();
  Eigen::LLT<Matrix6> factor_;  // of M_h and coupling
  bool solvable_ = true;
};

}  // namespace pliant
