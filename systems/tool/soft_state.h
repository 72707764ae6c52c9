// The soft step's working memory. Writer: the soft clock; what the touch clock needs of it travels in HandleModel
// (handle_model.h), what it must know of the hand in ToolInput.
#pragma once

#include <memory>
#include <vector>

#include "components/world.h"
#include "systems/tool/body.h"
#include "systems/tool/contact_point.h"
#include "systems/tool/contact_problem.h"
#include "systems/tool/delassus.h"

namespace pliant {

// [ms] of the last step, by stage.
struct SoftTimes {
  double free_motion = 0, proximity = 0, delassus = 0, sweeps = 0, linearise = 0, total = 0;
};

struct SoftState {
  std::vector<std::unique_ptr<Body>> bodies;  // fixed ones too
  std::unique_ptr<Proximity> proximity;
  std::vector<ContactPoint> contacts;  // of the last step, with their impulses
  Delassus delassus;
  ContactProblem problem;
  SweepReport report;
  SoftTimes times;
  double margin = 1e-3;  // [m] proximity margin, sized from the level
  std::uint64_t steps = 0;
};

}  // namespace pliant
