#include "lab/study/hard/hard_case.h"

namespace pliant {

const std::vector<HardCase>& hard_cases() {
  static const std::vector<HardCase> all = [] {
    std::vector<HardCase> cases;
    for (const auto& part : {hard_numbers, hard_time, hard_elements, hard_places, hard_meshes, hard_contacts,
                             hard_loops, hard_surfaces, hard_levels, hard_cost})
      for (const HardCase& hard : part()) cases.push_back(hard);
    return cases;
  }();
  return all;
}

HardVerdict verdict_of(const HardCase& hard, const HardFigure& figure) {
  if (figure.is_absent()) return HardVerdict::kNotJudged;
  if (figure.low() <= hard.bound && hard.bound < figure.high()) return HardVerdict::kNotJudged;
  return figure.is_measured() && figure.value() <= hard.bound ? HardVerdict::kYes : HardVerdict::kNo;
}

}  // namespace pliant
