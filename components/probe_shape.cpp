#include "components/probe_shape.h"

#include <algorithm>

namespace pliant {
namespace {

using Parts = std::vector<ProbePart>;

void add_points(const ProbeParameters& probe, Parts& parts) {
  for (const vec3& at : probe.points) parts.push_back({dvec3(at), dvec3(at)});
}

void add_capsule(const ProbeParameters& probe, Parts& parts) {
  if (probe.length > 0.0) parts.push_back({dvec3(0), dvec3(0, probe.length, 0)});
}

// One line per shape: adds its parts, or none if the probe has not its keys.
constexpr void (*kProbeShapes[])(const ProbeParameters&, Parts&) = {
    add_points,
    add_capsule,
};

}  // namespace

Parts probe_parts(const ProbeParameters& probe) {
  Parts parts;
  for (const auto add : kProbeShapes) add(probe, parts);
  if (parts.empty()) parts.emplace_back();
  return parts;
}

bool has_capsule(const ProbeParameters& probe) {
  const Parts parts = probe_parts(probe);
  return !std::all_of(parts.begin(), parts.end(), [](const ProbePart& part) { return part.is_sphere(); });
}

}  // namespace pliant
