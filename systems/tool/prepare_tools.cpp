#include "systems/tool/prepare_tools.h"

#include <fmt/format.h>

#include "components/soft_body.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

std::string name_of(const World& world, Entity entity) {
  const Name* name = world.registry.find<Name>(entity);
  return name ? name->value : fmt::format("entity {}", entity.index);
}

// A device that never moves, for a tool that nobody drives: it is held where it stands.
Entity resting_device(World& world, Entity tool) {
  if (!world.registry.has<HapticDevice>(tool)) {
    const Pose* pose = world.registry.find<Pose>(tool);
    HapticDevice device;
    if (pose) {
      device.position = pose->position;
      device.rotation = pose->rotation;
    }
    world.registry.add(tool, device);
  }
  return tool;
}

// What the hand feels of a tool that nothing carries. Its nodes have their elements' mass, as in Flesh.
void find_weight(const World& world, ToolTouchState& tool) {
  const SoftBody& body = world.registry.get<SoftBody>(tool.entity);
  if (world.registry.get<Handle6>(tool.entity).carried || !body.tets.valid()) return;
  const TetMesh& mesh = world.tet_meshes[body.tets];
  double mass = 0.0;
  for (const Tet& tet : mesh.tets) {
    const dvec3 a = mesh.nodes[tet[0]];
    const double volume = dot(cross(mesh.nodes[tet[1]] - a, mesh.nodes[tet[2]] - a), mesh.nodes[tet[3]] - a) / 6.0;
    for (const std::uint32_t node : tet) {
      if (node >= mesh.pinned_begin()) continue;  // the world's to hold
      mass += body.density * volume / 4.0;
      tool.balance += body.density * volume / 4.0 * mesh.nodes[node];
    }
  }
  if (!(mass > 0.0)) return;
  tool.balance /= mass;
  tool.weight = mass * world.simulation.gravity;
}

// Two things on one device would each be told that the whole of its force is theirs.
Status check_free(const World& world, Entity tool, Entity device) {
  const std::string sentence = "its device `" + name_of(world, device) + "` already moves `{}`; give each its own";
  for (auto [entity, probe] : world.registry.view<Probe>())
    if (probe.device == device)
      return Error{"tool `" + name_of(world, tool) + "`", fmt::format(fmt::runtime(sentence), name_of(world, entity))};
  for (const auto& other : world.tools->tools)
    if (other->device == device)
      return Error{"tool `" + name_of(world, tool) + "`",
                   fmt::format(fmt::runtime(sentence), name_of(world, other->entity))};
  return Done{};
}

}  // namespace

Status prepare_tools(World& world) {
  world.tools = std::make_shared<ToolTouch>();
  std::vector<Entity> tools;
  for (auto [entity, body, handle] : world.registry.view<SoftBody, Handle6>()) tools.push_back(entity);
  HandleModel empty;
  empty.contacts.resize(kMaxCondensed, kMaxModes);
  for (const Entity entity : tools) {
    const std::string& wanted = world.registry.get<Handle6>(entity).device;
    const Entity named = wanted.empty() ? kNoEntity : find_by_name(world, wanted);
    if (!wanted.empty() && (named == kNoEntity || !world.registry.has<HapticDevice>(named)))
      return Error{"tool `" + name_of(world, entity) + "`",
                   "its device `" + wanted + "` has no PLIANT_haptic_device; name a node that has one"};
    auto tool = std::make_unique<ToolTouchState>();
    tool->entity = entity;
    tool->device = wanted.empty() ? resting_device(world, entity) : named;
    if (Status status = check_free(world, entity, tool->device); !status) return status.error();
    for (HandleModel& slot : tool->model.slots()) slot = empty;
    tool->pending = empty;
    tool->contacts.resize(kMaxCondensed, kMaxModes);
    tool->replay.resize(kMaxCondensed, kMaxModes);
    // Until the device has been sensed, the tool is held where it stands.
    if (const Pose* pose = world.registry.find<Pose>(entity)) tool->sensed.pose = *pose;
    for (ToolInput& slot : tool->input.slots()) slot.device = tool->sensed;
    tool->limits = {kTickSweeps, kTickTolerance, 0};
    tool->wanted = world.registry.get<Handle6>(entity).force;
    find_weight(world, *tool);
    world.tools->tools.push_back(std::move(tool));
  }
  return Done{};
}

void limit_tool_ticks(World& world) {
  if (!world.tools) return;
  for (const auto& tool : world.tools->tools)
    tool->limits.budget_ns = static_cast<std::uint64_t>(kTickBudgetShare * 1e9 / world.simulation.touch_rate);
}

}  // namespace pliant
