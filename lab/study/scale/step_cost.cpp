#include "lab/study/scale/step_cost.h"

#include <algorithm>
#include <string_view>

#include "lab/study/processor_time.h"
#include "systems/schedule.h"

namespace pliant {
namespace {

constexpr double kStepLength = 1.0 / 60, kTick = 1e-3;  // [s]

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

StepPart part_of(std::string_view system) {
  if (system == "free_motion") return StepPart::kFreeMotion;
  if (system == "find_contacts") return StepPart::kProximity;
  if (system == "solve_contacts") return StepPart::kContacts;
  return system == "linearise_tools" ? StepPart::kLinearise : StepPart::kAll;
}

}  // namespace

const char* name_of(StepPart part) {
  constexpr const char* kNames[] = {"whole step", "free motion", "finding contacts", "solving contacts",
                                    "linear models"};
  return kNames[static_cast<std::size_t>(part)];
}

StepCost measure_step(scenes::PaddleCells cells, scenes::StudBed bed, int steps) {
  scenes::ToolStage stage(kStepLength, 1 / kTick);
  const Entity tool = scenes::add_paddle(stage, cells);
  scenes::add_bed(stage, bed);
  stage.prepare();
  StepCost cost;
  cost.tetrahedra = static_cast<std::size_t>(cells.tetrahedra());
  const std::vector<System<World>> soft = soft_schedule();
  std::vector<std::vector<double>> times(std::size(kStepParts));
  const int pressed = static_cast<int>(scenes::kPaddlePressed / kStepLength) + 1;
  std::uint64_t ticks = 0;
  for (int n = 0; n < pressed + steps; ++n) {
    std::vector<double> ms(std::size(kStepParts));
    const Tick tick{static_cast<std::uint64_t>(n), kStepLength, n * kStepLength};
    for (const System<World>& system : soft) {
      const std::uint64_t begin = processor_ns();
      system.run(stage.world, tick);
      const double own = static_cast<double>(processor_ns() - begin) * 1e-6;
      const StepPart part = part_of(system.name);
      ms[0] += own;
      if (part != StepPart::kAll) ms[static_cast<std::size_t>(part)] += own;
    }
    for (; static_cast<double>(ticks) * kTick < (n + 1) * kStepLength; ++ticks) {
      stage.device_of(tool).position = scenes::paddle_path(static_cast<double>(ticks) * kTick);
      stage.tick();
    }
    if (n < pressed) continue;
    for (std::size_t i = 0; i < ms.size(); ++i) times[i].push_back(ms[i]);
    cost.contacts += static_cast<double>(stage.soft().contacts.size()) / steps;
  }
  for (const std::vector<double>& part : times) cost.ms.push_back(median(part));
  return cost;
}

}  // namespace pliant
