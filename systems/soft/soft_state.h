// The soft step's working memory. Writer: the soft clock; what the touch clock needs of it travels in HandleModel
// (handle_model.h), what it must know of the hand in ToolInput.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "components/world.h"
#include "runtime/exchange.h"
#include "systems/soft/body/body.h"
#include "systems/soft/body/rigid_state.h"
#include "systems/soft/body/tool_body.h"
#include "systems/soft/body/yielding_body.h"
#include "systems/soft/body_edits.h"
#include "systems/soft/contact/contact_point.h"
#include "systems/soft/contact/contact_problem.h"
#include "systems/soft/contact/delassus.h"

namespace pliant {

// [1] beta 0.1-0.2: the share of a penetration that a soft step undoes. More adds energy, less leaves bodies sunk in.
inline constexpr double kPenetrationShare = 0.15;

// [ms] of the last step, by stage.
struct SoftTimes {
  double free_motion = 0, proximity = 0, delassus = 0, sweeps = 0, linearise = 0, total = 0;
};

// What soft steps had to leave imperfect, from the first one on. For reports: read once the clocks stand still.
struct SoftTally {
  std::uint64_t contacts_cut = 0;  // left out of a solve because a limit was reached, summed over the steps
  std::uint64_t unconverged = 0;   // steps, some part of which ended above the stated residual
  double residual = 0.0;           // [m/s] the largest that a step ended with
  double deepest = 0.0;            // [m] >= 0: the deepest penetration that a step began with
  std::uint64_t halted = 0;        // times that bodies stopped in a step before a crossing that no contact prevented
  double halted_for = 0.0;         // [s] that they stood still, as the step had no more parts

  // [m] How deep the first step found bodies in each other, at most, beyond 1 % of the smaller one's diagonal; and who.
  double began_inside = 0.0;
  std::uint32_t inside_a = 0, inside_b = 0;  // into SoftState::bodies
};

// Parameters of a body that change between steps, all of its kind.
struct RigidSetting {
  RigidMass mass;  // of a body that moves
  double friction_static = 0.4, friction_sliding = 0.3;
};
struct SoftSetting {
  double young = 5e3, poisson = 0.45;
  std::array<double, 2> rayleigh{0, 0};
  double friction_static = 0.4, friction_sliding = 0.3;
};
struct ParameterEdit {
  Entity body;
  std::variant<DeformableParameters, RigidSetting, SoftSetting, CouplingSetting> now;
};
inline constexpr std::size_t kMostParameterEdits = 256;  // that wait for a step

struct SoftState {
  std::vector<std::unique_ptr<Body>> bodies;  // fixed ones too
  std::vector<std::uint32_t> moving;          // those with degrees of freedom, which a snapshot shows
  std::vector<std::uint32_t> yielding;        // YieldingBody, one per Deformable
  std::unique_ptr<Proximity> proximity;
  std::vector<ContactPoint> contacts;  // of the last step, with their impulses
  Delassus delassus;
  ContactProblem problem;
  SweepReport report;
  SoftTally tally;
  SoftTimes times;
  std::uint64_t steps = 0;                                   // done
  int parts = 1, part = 0;                                   // of the step under way (run_soft_step)
  int more = 0;                                              // parts that may still be added to it
  double share = 1.0;                                        // [1] of the part under way that bodies go
  double step = 0.0;                                         // [s] T of the step under way, all its parts together
  bool settled = true;                                       // so far in the step under way
  std::uint64_t began = 0;                                   // [ns] of the step under way
  std::uint32_t dropped = 0;                                 // DroppedBit, the soft clock's own
  Ring<ParameterEdit> parameter_edits{kMostParameterEdits};  // who owns the run -> soft clock
  Ring<BodyEdit> body_edits{kMostBodyEdits};                 // the same

  // [1] Of a penetration, in a part of T [s]: pushed out as fast in many parts as in one.
  double undone_in(double T) const { return kPenetrationShare * std::min(1.0, T / step); }
  YieldingBody& surface(std::uint32_t body) { return static_cast<YieldingBody&>(*bodies[body]); }
};

}  // namespace pliant
