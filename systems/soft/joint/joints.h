// Joints between two bodies (PLIANT_joint; methods.md 2.16) as rows of the contact problem. A joint holds points of its
// bodies together along some of their axes; a limit and a rope push along one axis as a contact without friction does.
// Bodies stay black boxes: a row needs their response alone, as a contact does. Rows have the direction of the step's
// beginning, and are solved for the gap at its end after the bodies' finite rotations (as in SHAKE: Ryckaert, Ciccotti
// & Berendsen, Journal of Computational Physics 23, 1977), so that a pendulum keeps its energy.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "components/joint.h"
#include "components/world.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/soft/contact/contact_problem.h"

namespace pliant {

// Force and state of a joint. Writer: soft clock.
struct JointReport {
  double force = 0.0;      // [N] at its point, of the last step
  double largest = 0.0;    // [N] of all steps
  double apart = 0.0;      // [m] largest gap at a step's beginning
  double broke_at = -1.0;  // [s] world; < 0: whole
  // Of its spring:
  double push = 0.0;         // [N m], [N] of the last step
  double fed = 0.0;          // [J] by the motion of where it is at rest
  double work = 0.0;         // [J] done on the bodies: at most `fed` and what it held at the beginning
  double limited_for = 0.0;  // [s] during which it was at its bound
};

class Joints {
 public:
  // Finds the joints of a world whose bodies are these, at their poses now. Adds an immovable body if one is joined to
  // the world. Errors: joins that the step cannot hold.
  Status prepare(const World& world, std::vector<std::unique_ptr<Body>>& bodies);

  // Removes the joints' points from the contacts of the last step and keeps their impulses.
  void take_out(std::vector<ContactPoint>& contacts);
  // Adds them, as they are at the beginning of a step.
  void place(const std::vector<std::unique_ptr<Body>>& bodies, Tick tick, std::vector<ContactPoint>& contacts);
  // [1] The grip of a tool or probe, 0 to 1, from now on.
  void set_grip(Entity hand, double grip);
  // Corrects their laws by the gap to which the current velocities lead over the step. Returns the largest correction
  // [m].
  double look_again(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                    const std::vector<ContactPoint>& contacts, ContactProblem& problem) const;
  // [J] of joined bodies, by their current velocities.
  double kinetic_energy(const std::vector<std::unique_ptr<Body>>& bodies) const;
  // Leaves the rows of rigid joints with u = 0 alone, which adds no energy: gaps stay.
  void leave_gaps(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                  ContactProblem& problem) const;
  // Gives bodies the stiffness against turning that the joints' impulses [N s] lend them (methods.md 2.16), three per
  // contact. True: it grew much, so that the problem is to be built again.
  bool stiffen(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
               const Vector& impulses, double T) const;
  // Breaks those whose impulses [N s], three per contact, exceed their strength, and takes their points out of the
  // contacts: the step is to be solved without them, so that what they held keeps its velocity. True: one broke.
  bool snap(const Vector& impulses, double T, std::vector<ContactPoint>& contacts);
  // After the step's solution: their forces; those that only the last correction brought beyond their strength break.
  void measure(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts, Tick tick);

  std::size_t size() const { return joints_.size(); }
  const std::string& name(std::size_t joint) const { return joints_[joint].name; }
  double arm(std::size_t joint) const { return joints_[joint].arm; }  // [m] of its size
  const JointReport& report(std::size_t joint) const { return joints_[joint].report; }
  const Joint& joint(std::size_t joint) const { return joints_[joint].joint; }
  double fed() const;  // [J] by all of them

 private:
  static constexpr std::size_t kMostRows = 6;
  static constexpr std::size_t kMostPoints = 3;  // of tissue, which a joint holds

  // One of a joint's bodies.
  struct Side {
    std::uint32_t body = 0;
    std::int32_t part = -1;                    // >= 0: that rigid part of a soft body
    Pose frame;                                // of a rigid body: the joint's frame in the object's
    std::array<dvec3, kMostPoints> point{};    // [m] of a rigid body joined to tissue, object frame
    std::array<SurfacePoint, kMostPoints> on;  // of tissue
    bool rigid = true;
  };
  struct JointState {
    Joint joint;
    std::string name;
    Side a, b;
    double arm = 0.1;                        // [m] from the joint's point to those that hold its directions
    double turned = 0.0;                     // [rad] of a hinge, at the last step's beginning
    double grip = 0.0;                       // [1]
    double target = 0.0;                     // [rad], [m] where its spring is at rest, at the step's end
    std::array<dvec3, kMostPoints> apart{};  // [m] between the points of two tissues at the beginning
    std::array<dvec3, kMostRows> impulse{};  // [N s] of the last step
    dvec3 sum{0};                            // [N s] of its points
    JointReport report;
  };
  // A point that the joint holds, or pushes.
  struct Row {
    SurfacePoint a, b;
    dmat3 axes{1};
    std::uint8_t held = 0;
    dvec3 off{0};            // [m]
    double stiffness = 0.0;  // [N/m], [N s/m] along the first axis; both 0: rigid
    double damping = 0.0;
    double most = HUGE_VAL;  // [N]
  };
  using Rows = std::vector<Row>;

  Status add(const World& world, Entity entity, const Joint& joint, std::vector<std::unique_ptr<Body>>& bodies);
  // Rigid bodies that a tool's grip drives are parts of the tool: if its weight is compensated, so is theirs.
  void carry_parts(const World& world, const std::vector<std::unique_ptr<Body>>& bodies) const;
  // After a step of T [s] with the bodies' current velocities; 0: now.
  void find_rows(const std::vector<std::unique_ptr<Body>>& bodies, const JointState& state, double T, Rows& out) const;
  static SurfacePoint point_of(const std::vector<std::unique_ptr<Body>>& bodies, const Side& side, std::size_t i,
                               double T);
  // Number of a body's rigid part of this name; -1 of none.
  static Result<std::int32_t> part_of(const World& world, const Body& body, const std::string& where,
                                      const std::string& name);
  static Pose pose_of(const Body& body, const Side& side, double T);  // of a rigid side
  static Pose frame_of(const std::vector<std::unique_ptr<Body>>& bodies, const Side& side, double T);
  // [rad], [m] Where its spring is at rest.
  static double rest_at(const Joint& joint, double grip, double time);
  // Moves that to where it is at the step's end.
  void drive(const std::vector<std::unique_ptr<Body>>& bodies, JointState& state, Tick tick) const;
  static void add_frames(const JointState& state, const Pose& a, const Pose& b, Rows& out);
  static void add_free_axis(const JointState& state, const Pose& a, const Pose& b, Rows& out);

  void load(JointState& state) const;  // breaks it if its force is beyond its strength
  static dmat3 turning_stiffness(const RigidState& body, dvec3 at, dvec3 force);

  std::vector<JointState> joints_;
  double end_ = 0.0;                      // [s] of the current step
  mutable std::vector<dmat3> stiffness_;  // [N m/rad] per body
  mutable Rows rows_;
  std::unique_ptr<Mesh> nothing_ = std::make_unique<Mesh>();  // of the world's body
};

}  // namespace pliant
