#include "engine/run/scene_hash.h"

#include <algorithm>

#include "components/soft_body.h"
#include "content/keys/extension_table.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

void add_mesh(Hash& hash, const LevelMesh& mesh) {
  hash.add(mesh.primitives.size());
  for (const Primitive& p : mesh.primitives) {
    add_values(hash, p.position);
    add_values(hash, p.normal);  // they create creases
    add_values(hash, p.index);
    for (const std::vector<float>* painted :
         {&p.stiffness, &p.friction, &p.damping, &p.relaxation, &p.pinned, &p.handle})
      add_values(hash, *painted);
  }
}

void add_node(Hash& hash, const LevelNode& node) {
  add_text(hash, node.name);
  hash.add(node.parent);
  hash.add(node.mesh);
  hash.add(node.in_scene);
  for (const float number : {node.local.translation.x, node.local.translation.y, node.local.translation.z,
                             node.local.rotation.x, node.local.rotation.y, node.local.rotation.z, node.local.rotation.w,
                             node.local.scale.x, node.local.scale.y, node.local.scale.z})
    hash.add(number);
}

void add_animation(Hash& hash, const LevelAnimation& animation) {
  add_text(hash, animation.name);
  hash.add(animation.length);
  hash.add(animation.channels.size());
  for (const LevelChannel& channel : animation.channels) {
    hash.add(channel.node);
    hash.add(static_cast<int>(channel.property));
    add_text(hash, channel.key);
    hash.add(static_cast<int>(channel.track.interpolation));
    add_values(hash, channel.track.times);
    add_values(hash, channel.track.values);
  }
}

// Keeps the hash of scenes older than these keys.
bool is_newer_default(const Extension& extension, const Key& key, const Json& value) {
  if (key.name == "prony" || key.name == "cavities" || key.name == "rigid" || key.name.starts_with("fibres.") ||
      (extension.name == "joint" &&
       (key.name == "closed" || key.name == "grip" || key.name == "max_force" || key.name.starts_with("part_")))) {
    LevelNode fresh;
    extension.add(&fresh);
    return value == key.get(&fresh);
  }
  return (key.name == "under_gravity" && value == "falls") || (key.name == "contact" && value == "lattice") ||
         (key.name == "law" && value == "corotational") || (key.name == "integrator" && value == "euler") ||
         (key.name == "velocity" && value == Json::array({0.0, 0.0, 0.0})) ||
         (extension.name == "soft_body" && key.name == "stiffening" && value == SoftBodyParameters{}.stiffening);
}

// A probe added for a window's mouse has a special colour; a replay of it does not.
bool is_not_felt(const Extension& extension, const Key& key) {
  return (extension.name == "probe" && key.name == "color") || key.name == "error" || key.name == "carries" ||
         key.name == "expose";
}

void add_keys(Hash& hash, const Extension& extension, const void* owner, const fs::path& folder) {
  if (!extension.present(owner)) return;
  add_text(hash, extension.name);
  for (const Key& key : extension.keys) {
    if (key.alias || is_not_felt(extension, key)) continue;
    const Json value = key.get(owner);
    if (is_newer_default(extension, key, value)) continue;
    add_text(hash, value.dump(-1, ' ', false, Json::error_handler_t::replace));
    if (key.type == KeyType::kText && value.is_string() && extension.name != "haptic_device" &&
        extension.name != "joint")
      add_named_file(hash, folder, value.get<std::string>());
  }
}

}  // namespace

std::uint64_t scene_hash(const Level& level) {
  Hash hash;
  const fs::path folder = level.path.parent_path();
  hash.add(level.meshes.size());
  for (const LevelMesh& mesh : level.meshes) add_mesh(hash, mesh);
  for (const LevelNode& node : level.nodes) add_node(hash, node);
  for (const LevelNode& node : level.nodes)
    for (const PathRow& row : node.effect_path.rows) hash.add_bytes(&row.position, sizeof row.position);
  for (const LevelAnimation& animation : level.animations) add_animation(hash, animation);
  for (const Extension& extension : extension_table()) {
    if (extension.name == "environment") continue;  // visible only
    if (extension.on_scene) {
      add_keys(hash, extension, &level, folder);
      continue;
    }
    for (std::size_t i = 0; i < level.nodes.size(); ++i) {
      if (extension.present(&level.nodes[i])) hash.add(i);
      add_keys(hash, extension, &level.nodes[i], folder);
    }
  }
  return std::max<std::uint64_t>(hash.value(), 1);
}

}  // namespace pliant
