// The motions of study_time_step.h with the soft step of the engine: contacts are constraints (here without friction),
// and a ball is a rigid tool with a prescribed device pose.
#pragma once

#include "lab/study/time_step/study_time_step.h"

namespace pliant {

inline constexpr const char* kEngineStep = "a level's step";
inline constexpr const char* kEngineStages = "a level's step, second_order";

// Same contract as trace_of().
StepTrace engine_trace(
    const TissueScene& scene, StepMethod method, double step, double every, double* ms = nullptr,
    const std::function<bool(double)>& goes_on = [](double) { return true; });

}  // namespace pliant
