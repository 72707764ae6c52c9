#include "engine/scene_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/keys/extension_table.h"
#include "runtime/hash.h"

namespace pliant {
namespace {

bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Status check_mesh(const LevelMesh& mesh) {
  const std::string where = "mesh `" + mesh.name + "`";
  for (const Primitive& p : mesh.primitives) {
    const std::size_t count = p.position.size();
    for (const std::size_t size :
         {p.normal.size(), p.tangent.size(), p.uv.size(), p.stiffness.size(), p.friction.size(), p.damping.size(),
          p.relaxation.size(), p.pinned.size(), p.handle.size()})
      if (size != 0 && size != count)
        return Error{where,
                     fmt::format("has {} positions and {} values beside them; give none or as many", count, size)};
    if (p.index.size() % 3 != 0)
      return Error{where, "the number of indices is no multiple of three; give whole triangles"};
    for (const std::uint32_t i : p.index)
      if (i >= count)
        return Error{where, fmt::format("index {} is beyond its {} positions; check the triangles", i, count)};
  }
  return Done{};
}

Status check_placement(const LevelNode& node) {
  const LocalTransform& at = node.local;
  if (!finite(at.translation) || !finite(at.scale) || at.scale.x * at.scale.y * at.scale.z == 0.0f)
    return Error{"`" + node.name + "`", "its placement is not finite, or its scale is zero; check Placement"};
  if (!(std::abs(glm::length(at.rotation) - 1.0f) < 0.01f))
    return Error{"`" + node.name + "`", "its rotation is not of unit length; normalise it"};
  return Done{};
}

// `owner`: a LevelNode or the Level.
Status check_keys(const std::string& name, const Extension& extension, void* owner) {
  if (!extension.present(owner)) return Done{};
  for (const Key& key : extension.keys) {
    if (key.alias) continue;
    const Json value = key.get(owner);
    if (value.is_null()) continue;  // says nothing
    if (const std::string fault = check_value(key, value); !fault.empty())
      return Error{"`" + name + "`: " + key.name, fault};
  }
  if (const std::string fault = extension.settle(owner); !fault.empty()) return Error{"`" + name + "`", fault};
  return Done{};
}

void add_text(Hash& hash, const std::string& text) {
  hash.add(text.size());
  hash.add_bytes(text.data(), text.size());
}

// A probe that a window adds for its mouse has a colour of its own, and a replay of it has not. An error budget is felt
// by what was chosen for it, in other keys.
bool is_not_felt(const Extension& extension, const Key& key) {
  return (extension.name == "probe" && key.name == "color") || key.name == "error";
}

void add_keys(Hash& hash, const Extension& extension, const void* owner) {
  if (!extension.present(owner)) return;
  add_text(hash, extension.name);
  for (const Key& key : extension.keys)
    if (!key.alias && !is_not_felt(extension, key))
      add_text(hash, key.get(owner).dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

Status check_device(const std::string& name, const DeviceParameters& device) {
  LevelNode node;
  node.device.emplace();
  static_cast<DeviceParameters&>(*node.device) = device;
  return check_keys(name, *find_extension("haptic_device"), &node);
}

Status check_scene(Level& level) {
  for (const LevelMesh& mesh : level.meshes)
    if (Status ok = check_mesh(mesh); !ok) return ok;
  for (LevelNode& node : level.nodes)
    if (Status ok = check_placement(node); !ok) return ok;
  for (const Extension& extension : extension_table()) {
    if (extension.on_scene) {
      if (Status ok = check_keys("scene", extension, &level); !ok) return ok;
      continue;
    }
    for (LevelNode& node : level.nodes)
      if (Status ok = check_keys(node.name, extension, &node); !ok) return ok;
  }
  return Done{};
}

std::uint64_t scene_hash(const Level& level) {
  Hash hash;
  for (const LevelMesh& mesh : level.meshes)
    for (const Primitive& p : mesh.primitives) {
      hash.add_bytes(p.position.data(), p.position.size() * sizeof(vec3));
      hash.add_bytes(p.index.data(), p.index.size() * sizeof(std::uint32_t));
      for (const std::vector<float>* painted :
           {&p.stiffness, &p.friction, &p.damping, &p.relaxation, &p.pinned, &p.handle})
        hash.add_bytes(painted->data(), painted->size() * sizeof(float));
    }
  for (const LevelNode& node : level.nodes) {
    add_text(hash, node.name);
    for (const float number : {node.local.translation.x, node.local.translation.y, node.local.translation.z,
                               node.local.rotation.x, node.local.rotation.y, node.local.rotation.z,
                               node.local.rotation.w, node.local.scale.x, node.local.scale.y, node.local.scale.z})
      hash.add(number);
  }
  for (const Extension& extension : extension_table()) {
    if (extension.name == "environment") continue;  // is seen, not felt
    if (extension.on_scene) {
      add_keys(hash, extension, &level);
      continue;
    }
    for (const LevelNode& node : level.nodes) add_keys(hash, extension, &node);
  }
  return std::max<std::uint64_t>(hash.value(), 1);
}

}  // namespace pliant
