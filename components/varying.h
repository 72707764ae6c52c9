// Parameters of a deformable surface over time: key-framed tracks, as in glTF's KHR_animation_pointer.
#pragma once

#include <vector>

#include "components/deformable.h"
#include "components/kinematic.h"
#include "runtime/entity.h"

namespace pliant {

struct World;

// One parameter. Its value is clamped to `range`: a spline may overshoot its keys.
struct ParameterTrack {
  double DeformableParameters::*member = nullptr;
  Range range;
  Track track;  // x of its values
};

// On an entity with a Deformable. Rate: never changes. Writer: content at spawn.
struct Varying {
  std::vector<ParameterTrack> tracks;
  bool repeats = true;  // else the last key holds
  double speed = 1.0;   // [1] of the tracks' own clock against simulated time
};

// Whether the motion of a released dent depends on this parameter.
bool moves_field(const DeformableParameters& deformable, double DeformableParameters::*member);
// Where a surface's field is evaluated in this world: a dent whose motion varies has no closed form, and the GPU's copy
// knows one motion alone, so that the CPU steps it.
enum class FieldOn : std::uint8_t { kCpu, kGpuSources, kGpuSteps };
FieldOn field_on(const World& world, Entity surface);

// Sets the parameters at `time` [s]. Sliding friction never exceeds static friction. Does not allocate.
void vary(const Varying& varying, double time, DeformableParameters& now);

}  // namespace pliant
