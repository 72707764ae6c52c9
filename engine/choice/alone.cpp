#include "engine/choice/alone.h"

#include "content/keys/extension_table.h"

namespace pliant {

bool states(const LevelNode& node, const std::string& extension, const std::string& key) {
  if (node.stated.contains(extension + "." + key)) return true;
  const Extension* table = find_extension(extension);
  LevelNode defaults;
  table->add(&defaults);
  const Key* it = find_key(*table, key);
  return it->get(&node) != it->get(&defaults);
}

bool states_step(const Level& level) {
  return level.stated.contains("simulation.soft_step") || level.simulation.soft_step != Simulation{}.soft_step;
}

Level level_alone(const Level& level, std::size_t node) {
  Level alone;
  alone.name = level.name;
  alone.path = level.path;
  alone.simulation = level.simulation;
  alone.nodes = level.nodes;
  for (std::size_t i = 0; i < alone.nodes.size(); ++i) {
    LevelNode& each = alone.nodes[i];
    each.probe.reset();
    each.device.reset();
    each.motion.reset();
    each.light.reset();
    each.camera.reset();
    if (each.handle) each.handle->device.clear();
    if (i == node) {
      if (!each.handle) each.rigid_body.reset();
      continue;
    }
    each.deformable.reset();
    each.soft_body.reset();
    each.rigid_body.reset();
    each.handle.reset();
    each.mesh = -1;
  }
  if (std::int32_t& mesh = alone.nodes[node].mesh; mesh >= 0) {
    alone.meshes = {level.meshes[static_cast<std::size_t>(mesh)]};
    for (Primitive& primitive : alone.meshes[0].primitives) primitive.material = -1;
    mesh = 0;
  }
  return alone;
}

Result<World> spawn_alone(const Level& level, std::size_t node, const std::function<void(LevelNode&)>& edit) {
  Level alone = level_alone(level, node);
  edit(alone.nodes[node]);
  return spawn_level(alone);
}

}  // namespace pliant
