#include "content/level/unit.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace pliant {
namespace {

constexpr float kSmallest = 1e-3f;                          // [m] diagonal below which the unit is probably wrong
constexpr double kSmallestUnit = 1e-9, kLargestUnit = 1e6;  // [m]
constexpr std::pair<const char*, double> kUnits[] = {{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"in", 0.0254}};

}  // namespace

Result<double> parse_unit(const std::string& text) {
  for (const auto& [name, metres] : kUnits)
    if (text == name) return metres;
  double metres = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), metres);
  if (error == std::errc() && end == text.data() + text.size() && metres >= kSmallestUnit && metres <= kLargestUnit)
    return metres;
  return Error{"--unit", "must be m, cm, mm, in, or metres for one unit such as 0.0254; got '" + text + "'"};
}

Status check_unit(const Level& level, std::optional<double> metres) {
  if (metres.value_or(1.0) == 1.0 || !level.has_pliant()) return Done{};
  return Error{"--unit", "is for bare meshes",
               "this level's PLIANT extensions name lengths in metres: scale its nodes"};
}

Status check_unit_said(const Level& level, std::optional<double> metres) {
  if (metres || !level.unitless || level.has_pliant()) return Done{};
  const float across = bounds(level).diagonal();
  if (!(across > kRoom)) return Done{};
  return Error{level.path.string(), fmt::format("is {:.3g} m across", across), "say its unit, e.g. `--unit mm`",
               kUnitUnsaid};
}

void scale_roots(Level& level, double metres) {
  if (metres == 1.0) return;
  const auto factor = static_cast<float>(metres);
  for (LevelNode& node : level.nodes) {
    if (node.parent >= 0) continue;
    node.local.translation *= factor;
    node.local.scale *= factor;
  }
}

// Parents come before children, so one pass suffices.
std::vector<mat4> world_matrices(const Level& level) {
  std::vector<mat4> world;
  for (const LevelNode& node : level.nodes) {
    const mat4 local = glm::translate(mat4(1), node.local.translation) * glm::mat4_cast(node.local.rotation) *
                       glm::scale(mat4(1), node.local.scale);
    world.push_back(node.parent < 0 ? local : world[static_cast<std::size_t>(node.parent)] * local);
  }
  return world;
}

Box bounds(const Level& level) {
  Box box;
  const std::vector<mat4> world = world_matrices(level);
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (node.mesh < 0 || !node.in_scene) continue;
    for (const Primitive& primitive : level.meshes[static_cast<std::size_t>(node.mesh)].primitives)
      for (const vec3& position : primitive.position) box.add(vec3(world[i] * vec4(position, 1)));
  }
  return box;
}

std::string unit_hint(const Box& box, bool bare) {
  const float diagonal = box.diagonal();
  if (box.empty() || (diagonal <= kRoom && diagonal >= kSmallest)) return {};
  if (!bare)
    return fmt::format(
        "its diagonal is {:.4g} m, unusual for metres; where the lengths of its PLIANT extensions are in metres, scale "
        "its nodes",
        diagonal);
  if (diagonal > kRoom)
    return fmt::format(
        "its diagonal is {:.4g} m, unusual for metres; if the file is in mm, use `pliant run FILE --unit mm`, or "
        "convert "
        "it with `pliant convert IN OUT --unit mm`",
        diagonal);
  return fmt::format(
      "its diagonal is {:.4g} m, unusual for metres; if the file is in another unit, use `pliant run FILE --unit "
      "METRES`, "
      "or convert it with `pliant convert IN OUT --unit METRES`",
      diagonal);
}

}  // namespace pliant
