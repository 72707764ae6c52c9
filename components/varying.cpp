#include "components/varying.h"

#include <algorithm>

#include "components/world.h"

namespace pliant {

bool moves_field(const DeformableParameters& deformable, double DeformableParameters::*member) {
  if (member == &DeformableParameters::damping_ratio) return true;
  return member == &DeformableParameters::stiffness && row_of(deformable.spring).step != SpringStep::kExact;
}

FieldOn field_on(const World& world, Entity surface) {
  const Deformable& deformable = world.registry.get<Deformable>(surface);
  if (world.field_place == FieldPlace::kProcessor || !gpu_knows(deformable)) return FieldOn::kCpu;
  if (const Varying* const varying = world.registry.find<Varying>(surface))
    for (const ParameterTrack& track : varying->tracks)
      if (moves_field(deformable, track.member)) return FieldOn::kCpu;
  return has_closed_form(deformable, world.meshes[deformable.mesh]) ? FieldOn::kGpuSources : FieldOn::kGpuSteps;
}

void vary(const Varying& varying, double time, DeformableParameters& now) {
  PrescribedMotion clock;
  clock.repeats = varying.repeats;
  clock.speed = varying.speed;
  for (const ParameterTrack& each : varying.tracks) {
    const double value = sample_vector(each.track, track_time(each.track, clock, time).time).x;
    now.*each.member = std::clamp(value, each.range.min, each.range.max);
  }
  now.friction_sliding = std::min(now.friction_sliding, now.friction_static);
}

}  // namespace pliant
