#include "content/level/unfelt_relief.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/mesh/relief_map.h"

namespace pliant {

bool draws_relief(const Level& level, const LevelNode& node) {
  if (node.mesh < 0) return false;
  const std::vector<Primitive>& primitives = level.meshes[static_cast<std::size_t>(node.mesh)].primitives;
  return std::any_of(primitives.begin(), primitives.end(), [&](const Primitive& each) {
    return !each.uv.empty() && each.material >= 0 &&
           draws_relief(level.materials[static_cast<std::size_t>(each.material)]);
  });
}

std::optional<Note> unfelt_relief(const Level& level) {
  std::size_t count = 0;
  std::string name;
  for (const LevelNode& node : level.nodes) {
    if (!node.in_scene || !node.deformable || node.deformable->relief > 0.0) continue;
    if (node.stated.contains("deformable.relief") || !draws_relief(level, node)) continue;
    if (count++ == 0) name = node.name;
  }
  if (count == 0) return std::nullopt;
  const std::string others = count > 1 ? fmt::format(" and {} more", count - 1) : "";
  return Note{fmt::format("`{}`{}: the relief that its material draws is not felt", name, others),
              "set `relief` to 1 to feel it as drawn, or to 0 to leave it so", "relief.unfelt", name};
}

}  // namespace pliant
