// The soft step's working memory. Writer: the soft clock. The touch clock receives HandleModel (handle_model.h) and
// sends ToolInput.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "components/world.h"
#include "runtime/exchange.h"
#include "systems/soft/body/body.h"
#include "systems/soft/body/kinematic_body.h"
#include "systems/soft/body/rigid_state.h"
#include "systems/soft/body/tool_body.h"
#include "systems/soft/body/yielding_body.h"
#include "systems/soft/body_edits.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/soft/contact/contact_problem.h"
#include "systems/soft/contact/delassus.h"
#include "systems/soft/fem/tissue.h"
#include "systems/soft/joint/joints.h"
#include "systems/soft/local/split_contacts.h"

namespace pliant {

// [1] beta 0.1-0.2: share of a penetration corrected by a soft step. More adds energy, less leaves bodies sunk in.
inline constexpr double kPenetrationShare = 0.15;

// [ms] of the last step, by stage.
struct SoftTimes {
  double free_motion = 0, proximity = 0, delassus = 0, sweeps = 0, linearise = 0, total = 0;
};

// Imperfections of soft steps, since the first one. For reports: read once the clocks have stopped.
struct SoftTally {
  std::uint64_t contacts_cut = 0;  // contacts dropped because a limit was reached, summed over the steps
  std::uint64_t unconverged = 0;   // steps with a part that ended above the required residual
  double residual = 0.0;           // [m/s] largest final residual of a step
  double deepest = 0.0;            // [m] >= 0: largest penetration at the beginning of a step
  std::uint64_t halted = 0;        // number of times that bodies stopped in a step before an unprevented crossing
  double fed = 0.0;                // [J] by kinematic bodies, and by gravity to joined rigid ones
  double halted_for = 0.0;         // [s] time lost by it, as the step had no more parts

  // [m] Largest initial penetration in the first step, if beyond 1 % of the smaller body's diagonal; and its bodies.
  double began_inside = 0.0;
  std::uint32_t inside_a = 0, inside_b = 0;  // into SoftState::bodies
};

// Parameters of a body that may change between steps, for each kind.
struct RigidSetting {
  RigidMass mass;  // of a movable body
  double friction_static = 0.4, friction_sliding = 0.3;
};
struct SoftSetting {
  TissueMaterial material;  // without its density, which does not change
  double friction_static = 0.4, friction_sliding = 0.3;
};
struct ParameterEdit {
  Entity body;
  std::variant<DeformableParameters, RigidSetting, SoftSetting, CouplingSetting> now;
};
inline constexpr std::size_t kMostParameterEdits = 256;  // capacity of the queue

struct SoftState {
  std::vector<std::unique_ptr<Body>> bodies;  // fixed ones too
  std::vector<std::uint32_t> moving;          // those with degrees of freedom, which are in the snapshot
  std::vector<std::uint32_t> yielding;        // YieldingBody, one per Deformable
  std::vector<KinematicBody> kinematic;
  std::unique_ptr<Proximity> proximity;
  std::vector<ContactPoint> contacts;  // of the last step, with their impulses
  double impulse_time = 0.0;           // [s] over which these act
  SplitContacts split;
  Joints joints;
  Delassus delassus;
  ContactProblem problem;
  SweepReport report;
  int unsettled = 0;  // successive steps whose contacts did not converge with all penetrations undone
  SoftTally tally;
  SoftTimes times;
  std::uint64_t steps = 0;                                   // done
  int parts = 1, part = 0;                                   // of the current step (run_soft_step)
  int more = 0;                                              // parts that may still be added to it
  double share = 1.0;                                        // [1] of the current part that bodies complete
  double step = 0.0;                                         // [s] T of the current step, all its parts together
  bool settled = true;                                       // so far in the current step
  std::uint64_t began = 0;                                   // [ns] beginning of the current step
  std::uint32_t dropped = 0;                                 // DroppedBit, of the soft clock
  Ring<ParameterEdit> parameter_edits{kMostParameterEdits};  // owner of the run -> soft clock
  Ring<BodyEdit> body_edits{kMostBodyEdits};                 // the same

  // [1] Share of a penetration corrected in a part of T [s]: the same rate in many parts as in one.
  double undone_in(double T) const { return kPenetrationShare * std::min(1.0, T / step); }
  YieldingBody& surface(std::uint32_t body) { return static_cast<YieldingBody&>(*bodies[body]); }
};

}  // namespace pliant
