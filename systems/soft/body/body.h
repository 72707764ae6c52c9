// A body in the soft step: a linear system A v = b over its degrees of freedom, solved by a black box, and a collision
// mesh that moves with them (J). Kinds: rigid (rigid_state.h), soft, with a handle (a tool) or without
// (soft_body_state.h), fixed (no degrees of freedom), yielding (a P1 surface: no degrees of freedom, but compliance).
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "components/mesh.h"
#include "components/soft_snapshot.h"
#include "components/transform.h"
#include "runtime/entity.h"
#include "systems/soft/fem/modal.h"
#include "systems/soft/linear/block_matrix.h"

namespace pliant {

struct SmearedLoad;     // systems/soft/local/smeared_load.h
struct TissueMaterial;  // systems/soft/fem/tissue.h

struct SurfacePoint {
  std::uint32_t triangle = 0;  // of the collision mesh
  dvec3 barycentric{1, 0, 0};  // [1]
  dvec3 position{0};           // [m] world, at the beginning of the step
  std::int32_t part = -1;      // >= 0: fixed to this rigid part of a soft body, at `position`
  bool beside = false;         // of a rigid body: its position is not on the triangle (contact_on_arcs.h)
  // Of a split contact on tissue: where its force acts instead, and where its motion is read.
  std::shared_ptr<const SmearedLoad> smeared;
};

// Motion of a rigid body over a step: it turns about a centre that moves straight. World frame.
struct RigidPath {
  dvec3 centre{0}, linear{0}, angular{0};  // [m] at the beginning, [m/s], [rad/s]
};

// A tip of a probe.
struct SphereTip {
  dvec3 centre{0};      // [m] object frame
  double radius = 0.0;  // [m] > 0
};

// Mass properties of a rigid body, in its object frame.
struct RigidMass {
  double mass = 1.0;  // [kg] > 0
  dvec3 centre{0};    // [m] centre of mass
  dmat3 inertia{1};   // [kg m2] about the centre of mass, along the object's axes; positive definite
};

// One side of a contact, with unit impulses along the contact's axes.
struct PushedSide {
  Eigen::Index contact = 0;  // index among the body's contacts
  const SurfacePoint* point = nullptr;
  const dmat3* axes = nullptr;
  double sign = 1.0;
};

// J A^-1 J^T = held + lever lever^T [1/kg].
struct Compliance {
  Eigen::MatrixXd held;  // symmetric; for a body with a handle: with the handle fixed
  Rows lever;            // rows x 6: contribution of the handle's motion; no columns without a handle
};

// Loads by a program, besides contacts (systems/soft/body_edits.h). World frame.
struct VertexForce {
  SurfacePoint at;  // a vertex; its position is that of the step
  std::uint32_t vertex = 0;
  dvec3 force{0};  // [N], or [N s]
};
struct BodyLoads {
  dvec3 force{0}, torque{0};        // [N], [N m] at the centre of mass
  dvec3 impulse{0}, turn{0};        // [N s], [N m s] for the next step only
  std::vector<VertexForce> forces;  // [N]
  std::vector<VertexForce> pushes;  // [N s] for the next step only
};

// Collision classes: a probe neither collides with surfaces, which use another law, nor with other probes
// (probe_tool.h).
enum class BodyKind : std::uint8_t { kBody, kSurface, kProbe };

class SoftBodyState;
class ToolBody;
class RigidState;

class Body {
 public:
  virtual ~Body() = default;

  // Its kind, where a step needs more than a linear system; null: another.
  virtual const SoftBodyState* as_tissue() const { return nullptr; }
  virtual const ToolBody* as_tool() const { return nullptr; }
  virtual ToolBody* as_tool() { return nullptr; }
  virtual const RigidState* as_rigid() const { return nullptr; }
  virtual bool is_surface() const { return false; }  // a P1 surface

  bool meets(const Body& other) const {
    if (absent || other.absent || taken_out || other.taken_out || (size() == 0 && other.size() == 0)) return false;
    if (std::find(joined.begin(), joined.end(), &other) != joined.end()) return false;
    if (kind == BodyKind::kProbe) return other.kind == BodyKind::kBody;
    return other.kind != BodyKind::kProbe || kind == BodyKind::kBody;
  }

  Entity entity;
  const Mesh* collision_mesh = nullptr;  // topology and rest shape (object frame)
  std::vector<dvec3> surface_position;   // [m] world, per collision mesh vertex, now
  std::vector<dvec3> surface_velocity;   // [m/s] world, of the free motion after free_step(); for predicting contacts
  double friction_static = 0.4, friction_sliding = 0.3;  // [1]
  BodyKind kind = BodyKind::kBody;
  bool absent = false;     // no contacts: its pose is not known yet, or it began inside a body (begun_inside.h)
  bool taken_out = false;  // removed by the owner of the run: no contacts, and not stepped
  bool carried = false;    // of a rigid body: its weight is compensated, as a part of a tool (Joints::carry_parts)
  BodyLoads loads;
  std::vector<SphereTip> tips;      // of a probe made of spheres; else empty
  std::vector<const Body*> joined;  // connected to it by a joint: they do not collide
  bool self_collides = false;       // its collision mesh can touch itself

  // Degrees of freedom; 0: contacts cannot move it.
  virtual int size() const = 0;
  // Assembles and factorises A for a step of T [s], and computes v* without contacts. Updates surface_velocity.
  virtual void free_step(double T, dvec3 gravity) = 0;
  // False: the step's A could not be factorised; solve() must not be called.
  virtual bool solvable() const { return true; }
  // True: the last advance() shortened the step's motion (passive_step.h).
  virtual bool shortened() const { return false; }
  // Between steps: changes the mass of a rigid body, or the law, elasticity and damping of tissue. Pose and velocity
  // are kept.
  virtual void set_mass(const RigidMass& mass) { (void)mass; }
  virtual void set_material(const TissueMaterial& material) { (void)material; }
  // [m/s] Before the first step.
  virtual void start_with(dvec3 velocity) { (void)velocity; }
  // Sets its velocity to zero.
  virtual void halt() {}
  // v: after free_step v*, after correct() the step's final velocity.
  virtual const Vector& velocity() const = 0;
  // columns.col(column) += J^T(point) impulse.
  virtual void push(const SurfacePoint& point, dvec3 impulse, Rows& columns, Eigen::Index column) const = 0;
  // columns.middleCols(first, 3) += sign * J^T(point) [a0 a1 a2], J^T of unit impulses along the axes' columns.
  void spread(const SurfacePoint& point, const dmat3& axes, double sign, Rows& columns, Eigen::Index first) const {
    for (int k = 0; k < 3; ++k) push(point, sign * axes[k], columns, first + k);
  }
  // out (3 x columns of x) += sign * axes^T J(point) x.
  virtual void gather(const SurfacePoint& point, const dmat3& axes, double sign, const Rows& x,
                      Eigen::Ref<Rows> out) const = 0;
  // columns = A^-1 columns.
  virtual void solve(Rows& columns) const = 0;
  // J A^-1 J^T of `contacts` contacts, three rows each. `sides`: their sides on this body, by ascending contact (both
  // sides of a self-contact).
  virtual void respond(std::span<const PushedSide> sides, Eigen::Index contacts, Compliance& out) const;
  // column += J^T of a force at the centre of mass and of a torque, distributed over the body by mass.
  virtual void load(dvec3 force, dvec3 torque, Rows& column) const { (void)force, (void)torque, (void)column; }
  // Moves its object frame to this pose, at rest and undeformed.
  virtual void place(const Pose& pose) { (void)pose; }
  // v = v* + dv, dv = A^-1 J^T lambda (already solved).
  virtual void correct(const Vector& dv) = 0;
  // [m/s] Per collision mesh vertex, from the current velocity().
  virtual void move_surface(std::vector<dvec3>& out) const { out.assign(surface_position.size(), dvec3(0)); }
  // Of a rigid body that is not a tool: its path by velocity(), and by the velocity at the beginning of the step.
  virtual std::optional<RigidPath> path() const { return {}; }
  virtual std::optional<RigidPath> last_path() const { return {}; }
  // x += T v; refreshes surface_position.
  virtual void advance(double T) = 0;
  // Its contacts are compliant, although it has no degrees of freedom.
  virtual bool yields() const { return false; }
  // Yielding surfaces and split contacts: w += compliance [1/kg] between contacts on this body, along their axes; rows
  // 3 * contact.
  struct Side {
    int contact;  // index of the contact: rows 3 * contact ...
    const SurfacePoint* point;
    const dmat3* axes = nullptr;
    double sign = 1.0;  // as PushedSide's
  };
  virtual void add_compliance(std::span<const Side> sides, double T, Eigen::MatrixXd& w) const {
    (void)sides, (void)T, (void)w;
  }
  // --- A step in two stages (two_stages.h), if staged(): contacts are solved for the first stage alone, and then for
  // the whole step. Both calls set velocity() and surface_velocity to the motion without contacts.
  virtual bool staged() const { return false; }
  virtual void first_stage() {}
  virtual void second_stage() {}  // with the first stage's impulses, by correct()
  // --- For the touch clock's reduced model (modal.h): the inertia in A, and the velocity at the beginning of the step.
  // After free_step.
  virtual StepSplit split(double T) const { return {T, damping()}; }
  // [m/s] At the step's end; velocity() is the mean of the step, on which the contacts act.
  virtual Vector ending_velocity() const { return velocity(); }
  // [m/s] From where the step's elastic forces are those that it used, to its end, by T.
  virtual Vector force_lag() const { return Vector::Zero(size()); }
  virtual void weigh(const Rows& x, Rows& out) const { out.setZero(x.rows(), x.cols()); }  // out = M x
  virtual RayleighDamping damping() const { return {}; }
  virtual Vector starting_velocity() const { return Vector::Zero(size()); }
  // --- For joints.
  // Pose of a rigid body's object frame after `T` [s] with its current velocity(); 0: now. None: it deforms.
  virtual std::optional<Pose> pose_after(double T) const { return (void)T, std::nullopt; }
  // The same of a rigid part of a soft body (SoftBodyState::rigid_part).
  virtual std::optional<Pose> part_pose(int part, double T) const { return (void)part, (void)T, std::nullopt; }
  // The stiffness [N m/rad] against turning that the joints' forces give a rigid body in a step of T [s], by
  // their levers: beyond 2 I/T^2 it counts as inertia, without which that step would be unstable.
  // Returns whether that grew much.
  virtual bool stiffen_turning(const dmat3& stiffness, double T) { return (void)stiffness, (void)T, false; }
  // Its motion is prescribed, and it moves.
  virtual bool prescribed() const { return false; }
  // [m/s] J v of a point, by the current velocity().
  virtual dvec3 velocity_of(const SurfacePoint& point) const;
  // Fills the object's part of a snapshot. Sizes are set by the first call, before the clocks start.
  virtual void show(SoftObjectSnapshot& out) const = 0;
};

}  // namespace pliant
