#include "content/level/probe_damage.h"

#include <fmt/format.h>

#include <algorithm>

namespace pliant {

std::optional<Note> undamaged_by_bodies(const Level& level) {
  const bool pressed = std::any_of(level.nodes.begin(), level.nodes.end(), [](const LevelNode& node) {
    return node.in_scene && (node.soft_body || (node.rigid_body && !node.rigid_body->fixed));
  });
  std::size_t count = 0;
  std::string name;
  for (const LevelNode& node : level.nodes)
    if (node.in_scene && node.deformable && (!node.deformable->layers.empty() || node.deformable->yield_force > 0.0))
      if (count++ == 0) name = node.name;
  if (!pressed || count == 0) return std::nullopt;
  const std::string others = count > 1 ? fmt::format(" and {} more", count - 1) : "";
  return Note{fmt::format("`{}`{}: soft and rigid bodies press the law of `stiffness` alone, break no layer and leave "
                          "no dent",
                          name, others),
              "press it with a probe, or remove `layers` and `yield` where bodies shall be borne as stiffly",
              "surface.undamaged", name};
}

}  // namespace pliant
