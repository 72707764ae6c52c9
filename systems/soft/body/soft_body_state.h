// A soft body in the soft step, with a rigid handle (a tool) or without one. Degrees of freedom: velocities of its
// moving nodes, 3 each, then six of each further rigid part, then the handle's six. Slaved nodes move with the handle
// or their part, pinned ones do not move. Writer: the soft clock; one thread at a time, as respond() uses scratch
// memory.
#pragma once

#include <memory>
#include <optional>

#include "systems/soft/body/handle_tie.h"
#include "systems/soft/body/rigid_parts.h"
#include "systems/soft/body/schur.h"
#include "systems/soft/body/tool_body.h"
#include "systems/soft/body/two_stages.h"
#include "systems/soft/fem/tissue.h"

namespace pliant {

struct DentSpring;       // systems/soft/local/dent_spring.h
class SmearingSurface;   // systems/soft/local/smearing_surface.h
struct LocalElasticity;  // systems/soft/local/local_compliance.h

class SoftBodyState final : public ToolBody {
 public:
  ~SoftBodyState() override;
  const SoftBodyState* as_tissue() const override { return this; }
  // `tets` and `collision mesh` outlive it. `handle`: null without one (its nodes, if any, then move freely).
  // `placement`: initial object frame to world.
  SoftBodyState(const TetMesh& tets, const Mesh& surface, const SoftBody& body, const Handle6* handle,
                const Pose& placement, SolverKind solver = SolverKind::kAuto);
  // The same with the caller's solver.
  SoftBodyState(const TetMesh& tets, const Mesh& surface, const SoftBody& body, const Handle6* handle,
                const Pose& placement, std::unique_ptr<LinearSolver> solver);

  int size() const override { return static_cast<int>(solver_.size()); }
  void free_step(double T, dvec3 gravity) override;
  void push(const SurfacePoint& point, dvec3 impulse, Rows& columns, Eigen::Index column) const override;
  void gather(const SurfacePoint& point, const dmat3& axes, double sign, const Rows& x,
              Eigen::Ref<Rows> out) const override;
  void solve(Rows& columns) const override {
    solver_.solve(columns);
    columns *= response_;
  }
  void respond(std::span<const PushedSide> sides, Eigen::Index contacts, Compliance& out) const override;
  // Of the last respond(), out (size() rows) = A^-1 J^T at some of its rows (three a contact; kNoRow: zero), with the
  // handle fixed. False: not kept; solve_held() is needed.
  [[nodiscard]] bool respond_at(std::span<const Eigen::Index> rows, Rows& out) const;
  static constexpr Eigen::Index kNoRow = -1;
  void load(dvec3 force, dvec3 torque, Rows& column) const override;
  void place(const Pose& pose) override;
  void move_surface(std::vector<dvec3>& out) const override;
  void advance(double T) override;
  void weigh(const Rows& x, Rows& out) const override;
  RayleighDamping damping() const override { return damping_; }
  bool staged() const override { return stages_ && solvable_ && !taken_out; }
  void first_stage() override;
  void second_stage() override;
  StepSplit split(double T) const override;
  Vector ending_velocity() const override { return staged() ? stages_->ending(velocity_) : velocity_; }
  Vector force_lag() const override { return staged() ? stages_->force_lag(velocity_) : Body::force_lag(); }
  Vector starting_velocity() const override;
  void halt() override;
  void set_material(const TissueMaterial& material) override;
  void start_with(dvec3 velocity) override;
  void show(SoftObjectSnapshot& out) const override;
  std::size_t part_count() const { return tets_.parts.size(); }
  void show_part(std::size_t part, SoftObjectSnapshot& out) const;
  // One per TetMesh::parts, in their order; they outlive it.
  void set_part_meshes(std::vector<const std::vector<uvec3>*> triangles) { part_triangles_ = std::move(triangles); }

  const TetMesh& tets() const { return tets_; }
  const Tissue& tissue() const { return tissue_; }
  // Rigid parts, in the order of SoftBody::rigid; the last is the handle, if it has one.
  int rigid_count() const { return static_cast<int>(parts_ ? parts_->count() : 0) + (handle_ ? 1 : 0); }
  const RigidHandle& rigid_part(int part) const {
    return part == rigid_count() - 1 && handle_ ? *handle_ : (*parts_)[static_cast<std::size_t>(part)];
  }
  std::optional<Pose> part_pose(int part, double T) const override;
  void set_tie_stiffness(double ratio) { tie_->stiffness = ratio; }  // [1] handle_tie.h; with spring attachment
  // Of a body whose contacts are split (SoftContact::kSplit); else null.
  const SmearingSurface* smearing() const { return smearing_.get(); }
  // The law of its dents instead of the tissue's own, with steps of T [s], and its friction. Before the first step.
  void set_dent_law(const Deformable& law, double T);
  const DentSpring* dent() const { return dent_.get(); }  // or null
  LocalElasticity elasticity() const;                     // of tissue(), for the laws of split contacts
  // [m/s] v* at a smeared load.
  dvec3 free_velocity(const SmearedLoad& load) const;
  bool yields() const override { return smearing_ != nullptr; }
  void add_compliance(std::span<const Side> sides, double T, Eigen::MatrixXd& w) const override;
  // False: the last step's matrix could not be factorised; nothing moved.
  bool solvable() const override { return solvable_; }
  bool shortened() const override { return shortened_; }

  // Tissue of a tool left in its rest shape would fall and sway, and this work would reach the hand.
  void settle(dvec3 gravity) override;
  void unsettle() override;
  const Rows& follow() const override { return solver_.follow(); }
  void solve_held(Eigen::Ref<Rows> columns) const override { solver_.solve_held(columns); }
  const Matrix6& reduced() const { return solver_.reduced(); }  // S = handle_mass + tissue_matrix + coupling [kg]

 private:
  // Calls use(node, weight) for the nodes in which a point of the collision mesh is embedded. Zero weights are skipped:
  // most collision meshes have their vertices at nodes, so one of twelve weights is non-zero.
  template <class Use>
  void for_each_node(const SurfacePoint& point, Use use) const;
  void smear();
  bool slaved(std::uint32_t node) const { return node >= tissue_.moving() && node < tets_.pinned_begin(); }
  Eigen::Index part_row(int part) const { return 3 * static_cast<Eigen::Index>(tissue_.moving()) + 6 * part; }
  Eigen::Index handle_row() const { return part_row(static_cast<int>(parts_ ? parts_->count() : 0)); }
  // Of a slaved node: its arm, and the rows of what it is on.
  struct Ride {
    Eigen::Index row;
    dvec3 arm;
  };
  Ride ride(std::uint32_t node) const {
    if (parts_ && parts_->has(node)) return {part_row(static_cast<int>(parts_->of(node))), parts_->arm(node)};
    return {handle_row(), handle_->arm(node - tets_.free_count)};
  }
  Ride ride(const SurfacePoint& point) const {  // of one that is fixed to a rigid part
    return {part_row(point.part), point.position - rigid_part(point.part).motion().pose.position};
  }
  void push_twist(Ride on, dvec3 impulse, Rows& columns, Eigen::Index column) const {  // G^T
    columns.block<6, 1>(on.row, column) += join(impulse, cross(on.arm, impulse));
  }
  void place_parts(const Pose& object);
  void advance_parts(double T);
  dvec3 node_velocity(std::uint32_t node, const Vector& velocity) const;  // [m/s]
  void separate_tissue(double T);
  std::vector<dvec3> carried_motion() const;  // [m/s] per node
  void keep_passive(double T);                // passive_step.h
  void choose_step(StepMethod method);
  bool quasi_static() const { return stage_ > 1.0; }
  void note_free_motion();  // after a change of velocity() before contacts
  void advance_stages(double T);
  void refresh_surface(const std::vector<dvec3>& of_nodes, std::vector<dvec3>& of_surface) const;

  const TetMesh& tets_;
  RayleighDamping damping_;
  Tissue tissue_;
  std::optional<RigidParts> parts_;
  bool parts_fixed_ = false;
  std::optional<HandleTie> tie_;
  std::optional<TwoStages> stages_;
  double stage_ = 1.0;     // [1] of the step: the length that its matrix is of
  double response_ = 1.0;  // [1] motion by an impulse of the step, of A^-1
  CoupledSolver solver_;
  mutable BlockColumns pushed_;  // of the last respond(): columns that were solved for
  mutable Rows expand_;          // contacts' rows x those columns; empty: they are the contacts'
  std::unique_ptr<const SmearingSurface> smearing_;
  std::unique_ptr<const DentSpring> dent_;
  Vector free_velocity_;      // v* of the step; only of a body with smearing
  dquat placed_{1, 0, 0, 0};  // object frame to world at the start
  std::vector<const std::vector<uvec3>*> part_triangles_;
  bool solvable_ = true, shortened_ = false;
};

}  // namespace pliant
