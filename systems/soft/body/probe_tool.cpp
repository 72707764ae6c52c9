#include "systems/soft/body/probe_tool.h"

#include <algorithm>

#include "components/probe_shape.h"

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

std::vector<SphereTip> tips_of(const Probe& probe, const Mesh& shell) {
  std::vector<SphereTip> out;
  for (const ProbePart& part : probe_parts(probe)) {
    if (!part.is_sphere()) return {};
    double radius = 1e300;  // the nearest vertex is one of its own
    for (std::uint32_t v = 0; v < shell.vertex_count; ++v)
      radius = std::min(radius, length(dvec3(shell.position(v)) - part.from));
    out.push_back({part.from, probe.radius > 0.0 ? probe.radius : radius});
  }
  return out;
}

}  // namespace pliant
