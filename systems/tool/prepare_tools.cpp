#include "systems/tool/prepare_tools.h"

#include <fmt/format.h>

#include "components/mass_properties.h"
#include "components/soft_body.h"
#include "systems/soft/body/probe_tool.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

std::string tool_name(const World& world, Entity entity) {
  const Name* name = world.registry.find<Name>(entity);
  return name ? name->value : fmt::format("entity {}", entity.index);
}

// A fixed device for a tool without one: it keeps the tool at its initial pose.
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

// [kg] and centre of mass [m], object frame.
struct Weight {
  double mass = 0.0;
  dvec3 centre{0};
};

// Nodal masses as in Tissue.
Weight weight_of(const SoftBody& body, const TetMesh& mesh) {
  Weight out;
  for (std::size_t node = 0; node < mesh.volume.size() && node < mesh.pinned_begin(); ++node) {
    out.mass += body.density * mesh.volume[node];
    out.centre += body.density * mesh.volume[node] * mesh.nodes[node];
  }
  if (mesh.volume.empty())
    for (const Tet& tet : mesh.tets) {
      const dvec3 a = mesh.nodes[tet[0]];
      const double volume = dot(cross(mesh.nodes[tet[1]] - a, mesh.nodes[tet[2]] - a), mesh.nodes[tet[3]] - a) / 6.0;
      for (const std::uint32_t node : tet) {
        if (node >= mesh.pinned_begin()) continue;  // pinned: carried by the world
        out.mass += body.density * volume / 4.0;
        out.centre += body.density * volume / 4.0 * mesh.nodes[node];
      }
    }
  if (out.mass > 0.0) out.centre /= out.mass;
  return out;
}

Weight weight_of(const World& world, Entity entity) {
  if (const RigidBody* body = world.registry.find<RigidBody>(entity)) {
    const MassProperties shape = mass_properties(world.meshes[body->collision_mesh]);
    return {body->mass > 0.0 ? body->mass : body->density * shape.volume, shape.centre};
  }
  const SoftBody& body = world.registry.get<SoftBody>(entity);
  return body.tets.valid() ? weight_of(body, world.tet_meshes[body.tets]) : Weight{};
}

// Weight that the hand feels, for a tool without weight compensation.
void find_weight(const World& world, ToolTouchState& tool) {
  if (world.registry.get<Handle6>(tool.entity).carried) return;
  const Weight weight = weight_of(world, tool.entity);
  if (!(weight.mass > 0.0)) return;
  tool.balance = weight.centre;
  tool.weight = weight.mass * world.simulation.gravity;
}

// Two probes or tools on one device would each be reported its whole force.
Status check_free(const World& world, Entity tool, Entity device) {
  const auto moves = [&](Entity other) {
    return Error{"tool `" + tool_name(world, tool) + "`",
                 fmt::format("its device `{}` already moves `{}`", tool_name(world, device), tool_name(world, other)),
                 "give each its own"};
  };
  for (auto [entity, probe] : world.registry.view<Probe>())
    if (probe.device == device) return moves(entity);
  for (const auto& other : world.tools->tools)
    if (other->device == device) return moves(other->entity);
  return Done{};
}

// Working memory of a tool; until the device is sensed, the tool stays at its pose.
std::unique_ptr<ToolTouchState> make_tool(Entity entity, Entity device, const Pose* pose) {
  auto tool = std::make_unique<ToolTouchState>();
  tool->entity = entity;
  tool->device = device;
  HandleModel empty;
  empty.contacts.resize(kMaxCondensed, kMaxModes);
  for (HandleModel& slot : tool->model.slots()) slot = empty;
  tool->pending = empty;
  tool->contacts.resize(kMaxCondensed, kMaxModes);
  tool->replay.resize(kMaxCondensed, kMaxModes);
  if (pose) tool->sensed.pose = *pose;
  for (ToolInput& slot : tool->input.slots()) slot.device = tool->sensed;
  tool->limits = {kTickSweeps, kTickTolerance, 0};
  return tool;
}

Status add_tool(World& world, Entity entity) {
  const std::string& wanted = world.registry.get<Handle6>(entity).device;
  const Entity named = wanted.empty() ? kNoEntity : find_by_name(world, wanted);
  if (!wanted.empty() && (named == kNoEntity || !world.registry.has<HapticDevice>(named)))
    return Error{"tool `" + tool_name(world, entity) + "`", "its device `" + wanted + "` has no PLIANT_haptic_device",
                 "name a node that has one"};
  const Entity device = wanted.empty() ? resting_device(world, entity) : named;
  if (Status status = check_free(world, entity, device); !status) return status.error();
  world.tools->tools.push_back(make_tool(entity, device, world.registry.find<Pose>(entity)));
  ToolTouchState& tool = *world.tools->tools.back();
  tool.wanted = world.registry.get<Handle6>(entity).force;
  find_weight(world, tool);
  return Done{};
}

}  // namespace

Status prepare_tools(World& world) {
  world.tools = std::make_shared<ToolTouch>();
  std::vector<Entity> tools;
  for ([[maybe_unused]] auto [entity, handle] : world.registry.view<Handle6>())
    if (world.registry.has<SoftBody>(entity) || world.registry.has<RigidBody>(entity)) tools.push_back(entity);
  for (const Entity entity : tools)
    if (Status status = add_tool(world, entity); !status) return status.error();
  for (const Entity entity : probe_tools(world)) {
    const Probe& probe = world.registry.get<Probe>(entity);
    const Pose pose{probe.position, probe.rotation};
    world.tools->tools.push_back(make_tool(entity, probe.device, &pose));
    ToolTouchState& tool = *world.tools->tools.back();
    tool.is_probe = true;
    tool.state = HandleState::kSetBack;
    tool.settings = probe_handle(probe, world.registry.get<HapticDevice>(probe.device));
  }
  return Done{};
}

void limit_tool_ticks(World& world) {
  if (!world.tools) return;
  for (const auto& tool : world.tools->tools)
    tool->limits.budget_ns = static_cast<std::uint64_t>(kTickBudgetShare * 1e9 / world.simulation.touch_rate);
}

}  // namespace pliant
