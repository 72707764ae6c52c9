#include "engine/session/scene_check.h"

#include <fmt/format.h>

#include <cmath>

#include "content/keys/extension_table.h"

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
        return Error{where, fmt::format("has {} positions and {} values beside them", count, size),
                     "give none or as many"};
    if (p.index.size() % 3 != 0)
      return Error{where, "the number of indices is no multiple of three", "give whole triangles"};
    for (const std::uint32_t i : p.index)
      if (i >= count)
        return Error{where, fmt::format("index {} is beyond its {} positions", i, count), "check the triangles"};
  }
  return Done{};
}

Status check_placement(const LevelNode& node) {
  const LocalTransform& at = node.local;
  if (!finite(at.translation) || !finite(at.scale) || at.scale.x * at.scale.y * at.scale.z == 0.0f)
    return Error{"`" + node.name + "`", "its placement is not finite, or its scale is zero", "check Placement"};
  if (!(std::abs(glm::length(at.rotation) - 1.0f) < 0.01f))
    return Error{"`" + node.name + "`", "its rotation is not of unit length", "normalise it"};
  return Done{};
}

// `owner`: a LevelNode or the Level.
Status check_keys(const std::string& name, const Extension& extension, void* owner) {
  if (!extension.present(owner)) return Done{};
  for (const Key& key : extension.keys) {
    if (key.alias) continue;
    const Json value = key.get(owner);
    if (value.is_null()) continue;  // not set
    if (const std::optional<Note> fault = check_value(key, value))
      return error_at("`" + name + "`: " + key.name, *fault);
  }
  if (const std::optional<Note> fault = extension.settle(owner)) return error_at("`" + name + "`", *fault);
  return Done{};
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
  return check_references(level);
}

}  // namespace pliant
