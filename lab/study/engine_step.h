// The motions of study_time_step.h with the soft step that levels take: contacts are constraints (without friction
// here), and a ball is a rigid tool that its device leads.
#pragma once

#include "lab/study/study_time_step.h"

namespace pliant {

inline constexpr const char* kEngineStep = "a level's step";

// As trace_of() does.
StepTrace engine_trace(
    const TissueScene& scene, double step, double every, double* ms = nullptr,
    const std::function<bool(double)>& goes_on = [](double) { return true; });

}  // namespace pliant
