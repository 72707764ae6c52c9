#include "systems/soft/body/probe_tool.h"

namespace pliant {

std::vector<Entity> probe_tools(const World& world) {
  std::vector<Entity> out;
  for (auto [entity, probe] : world.registry.view<Probe>())
    if (probe.shell.valid() && probe.meets != ProbeMeets::kSurfaces) out.push_back(entity);
  return out;
}

Handle6 probe_handle(const Probe& probe, const HapticDevice& device) {
  Handle6 handle;
  handle.translation = probe.coupling;
  handle.rotation = {kProbeTurn, kProbeTurnDamping};
  handle.max_force = kProbeHeadroom * device.max_force;
  handle.max_torque = kProbeMaxTorque;
  return handle;
}

RigidMass probe_mass() {
  return {kProbeMass, dvec3(0), kProbeInertia * dmat3(1.0)};
}

}  // namespace pliant
