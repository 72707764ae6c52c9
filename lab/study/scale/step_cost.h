// Cost of a soft step, by part, over the number of tetrahedra and of contacts.
#pragma once

#include <string>
#include <vector>

#include "scenes/paddle.h"

namespace pliant {

enum class StepPart : std::uint8_t { kAll, kFreeMotion, kProximity, kContacts, kLinearise };
inline constexpr StepPart kStepParts[] = {StepPart::kAll, StepPart::kFreeMotion, StepPart::kProximity,
                                          StepPart::kContacts, StepPart::kLinearise};
const char* name_of(StepPart part);

struct StepCost {
  std::size_t tetrahedra = 0;
  double contacts = 0.0;   // mean
  std::vector<double> ms;  // per kStepParts, median over steps, CPU time of this thread
};
// A tissue paddle pressed on studs and moved in circles (scenes/paddle.h).
StepCost measure_step(scenes::PaddleCells cells, scenes::StudBed bed, int steps);

}  // namespace pliant
