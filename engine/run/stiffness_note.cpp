#include "engine/run/stiffness_note.h"

#include <fmt/format.h>

#include <algorithm>

#include "systems/device/hands.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

constexpr const char* kLessStiff = "give less stiffness, or take a stiffer or faster device";

// [N/m] per metre of the world, and its owner: the largest stiffness that this effector can feel, without vertex
// factors and depth.
std::pair<double, std::string> stiffest_for(const World& world, Entity effector, const std::string& name) {
  std::pair<double, std::string> stiffest{0.0, ""};
  if (const ToolTouchState* const tool = find_tool(world, effector))
    stiffest = {settings_of(world, *tool).translation[0], "the coupling of `" + name + "`"};
  if (!world.registry.has<Probe>(effector)) return stiffest;
  for (auto [entity, surface] : world.registry.view<const Deformable>()) {
    double stiffness = surface.stiffness;
    for (const Layer& layer : surface.layers) stiffness += layer.stiffness;
    if (!(stiffness > stiffest.first)) continue;
    const Name* const its = world.registry.find<Name>(entity);
    stiffest = {stiffness, "`" + (its ? its->value : std::string()) + "`"};
  }
  return stiffest;
}

// [1] Share of the force that remains.
double share_by_keys(const HapticDevice& device, double stiffness) {
  const double most = device.can.max_stiffness, felt = stiffness * device.workspace;
  return most > 0.0 && felt > most ? most / felt : 1.0;
}

}  // namespace

std::optional<Note> stiffness_note(const World& world, Entity effector, const std::string& name) {
  const HapticDevice& device = world.registry.get<HapticDevice>(device_of(world, effector));
  const auto [stiffness, its] = stiffest_for(world, effector, name);
  const double share = share_by_keys(device, stiffness);
  if (share == 1.0) return std::nullopt;
  return Note{fmt::format("{} has {:g} N/m, and the device of `{}` renders at most {:.3g} N/m stably: there it gets "
                          "{:.0f} % of the force",
                          its, stiffness, name, device.can.max_stiffness / device.workspace, 100.0 * share),
              kLessStiff, "device.softened", name};
}

std::optional<Note> softened_note(const World& world, Entity effector, const std::string& name, double least) {
  if (!(least < 0.99)) return std::nullopt;
  const HapticDevice& device = world.registry.get<HapticDevice>(device_of(world, effector));
  const double most = device.can.max_stiffness / device.workspace;
  return Note{fmt::format("what `{}` touched was up to {:.3g} N/m stiff, and its device renders at most {:.3g} N/m "
                          "stably: there it got {:.0f} % of the force",
                          name, most / least, most, 100.0 * least),
              kLessStiff, "device.softened", name};
}

}  // namespace pliant
