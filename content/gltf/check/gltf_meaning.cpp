// Checks glTF 2.0 rules beyond types and references: hierarchy, buffers and accessors. gltf_primitives.cpp checks the
// users of accessors, gltf_look.cpp the appearance. Requires a checked structure.
#include "content/gltf/check/gltf_meaning.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "components/math.h"
#include "content/gltf/check/gltf_check.h"
#include "content/gltf/form/gltf_accessor.h"

namespace pliant {

namespace {

// Version strings are MAJOR.MINOR; this reader supports 2.0.
void check_asset(const Json& json, Meaning& check) {
  const auto parse = [&](const char* key, int& major, int& minor) {
    const std::string version = value_of<std::string>(json["asset"], key, "2.0");
    char end = 0;
    const bool plain = version.find_first_not_of("0123456789.") == std::string::npos && version.size() < 10;
    if (plain && std::sscanf(version.c_str(), "%d.%d%c", &major, &minor, &end) == 2) return true;
    check.error(fmt::format("/asset/{}", key), "is not a version like 2.0");
    return false;
  };
  int major = 2, minor = 0, least_major = 2, least_minor = 0;
  if (!parse("version", major, minor) || !parse("minVersion", least_major, least_minor)) return;
  if (major != 2) check.error("/asset/version", fmt::format("is {}.{}; export glTF 2.0", major, minor));
  if (least_major > 2 || (least_major == 2 && least_minor > 0))
    check.error("/asset/minVersion", "needs a newer reader than glTF 2.0; export glTF 2.0");
  if (least_major > major || (least_major == major && least_minor > minor))
    check.error("/asset/minVersion", "is newer than /asset/version");
}

void check_extension_lists(const Json& json, Meaning& check) {
  const Json& required = array_of(json, "extensionsRequired");
  if (!required.empty() && !json.contains("extensionsUsed"))
    check.error("/extensionsRequired", "needs extensionsUsed as well");
  std::set<std::string> used;
  for (const Json& name : array_of(json, "extensionsUsed")) used.insert(name.get<std::string>());
  for (std::size_t i = 0; i < required.size(); ++i)
    if (!used.count(required[i].get<std::string>()))
      check.error(fmt::format("/extensionsRequired/{}", i), "is not among extensionsUsed; add it there");
}

void check_buffer_views(const Json& json, Meaning& check) {
  const Json& views = array_of(json, "bufferViews");
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Json& view = views[i];
    const std::string pointer = fmt::format("/bufferViews/{}", i);
    const std::uint64_t size = json["buffers"][view["buffer"].get<std::size_t>()]["byteLength"].get<std::uint64_t>();
    const std::uint64_t offset = value_of<std::uint64_t>(view, "byteOffset", 0);
    const std::uint64_t length = view["byteLength"].get<std::uint64_t>();
    if (offset > size || length > size - offset)
      check.error(pointer, fmt::format("covers bytes {} to {} of a buffer of {}", offset, offset + length, size));
    if (!view.contains("byteStride")) continue;
    const std::uint64_t stride = view["byteStride"].get<std::uint64_t>();
    if (stride % 4 != 0) check.error(pointer + "/byteStride", fmt::format("is {}, no multiple of 4", stride));
    if (stride > length) check.error(pointer + "/byteStride", "is larger than the bufferView");
    if (value_of(view, "target", 0) == 34963) check.error(pointer + "/byteStride", "is not for indices");
  }
}

// Checks that `count` elements of `element` bytes, `stride` apart, lie inside their bufferView and are aligned: their
// components in the buffer, and matrices to four bytes in the bufferView.
void check_placement(const Json& json, const Json& holder, const std::string& pointer, std::uint64_t count,
                     std::uint64_t element, std::uint64_t stride, std::uint64_t component, std::uint64_t alignment,
                     Meaning& check) {
  const Json& view = json["bufferViews"][holder["bufferView"].get<std::size_t>()];
  const std::uint64_t offset = value_of<std::uint64_t>(holder, "byteOffset", 0);
  const std::uint64_t length = view["byteLength"].get<std::uint64_t>();
  if (offset + stride * (count - 1) + element > length)
    check.error(pointer, fmt::format("needs {} bytes from {} on, but its bufferView has {}",
                                     stride * (count - 1) + element, offset, length));
  if (offset % alignment != 0)
    check.error(pointer + "/byteOffset", fmt::format("is {}, no multiple of {}", offset, alignment));
  else if ((offset + value_of<std::uint64_t>(view, "byteOffset", 0)) % component != 0)
    check.error(pointer, fmt::format("does not begin at a multiple of {} bytes in its buffer", component));
}

void check_sparse(const Json& json, const Json& accessor, const AccessorLayout& layout, const std::string& pointer,
                  Meaning& check) {
  const Json& sparse = accessor["sparse"];
  const std::uint64_t count = sparse["count"].get<std::uint64_t>();
  if (count > layout.count) check.error(pointer + "/sparse/count", "is more than the accessor's own count");
  Json index_accessor = {{"type", "SCALAR"}, {"componentType", sparse["indices"]["componentType"]}, {"count", count}};
  const AccessorLayout index = layout_of(index_accessor);
  if (!index.known || index.component_type == kFloat)
    return check.error(pointer + "/sparse/indices/componentType", "is not an unsigned integer type");
  check_placement(json, sparse["indices"], pointer + "/sparse/indices", count, index.element_size, index.element_size,
                  index.component_size, index.component_size, check);
  check_placement(json, sparse["values"], pointer + "/sparse/values", count, layout.last_size, layout.element_size,
                  layout.component_size, layout.component_size, check);
  for (const char* part : {"indices", "values"}) {
    const Json& view = json["bufferViews"][sparse[part]["bufferView"].get<std::size_t>()];
    const std::string where = pointer + "/sparse/" + part + "/bufferView";
    if (view.contains("byteStride")) check.error(where, "has a byteStride, which sparse data may not have");
    if (view.contains("target")) check.error(where, "has a target, which sparse data may not have");
  }
}

void check_accessors(const Json& json, Meaning& check) {
  const Json& accessors = array_of(json, "accessors");
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    const Json& accessor = accessors[i];
    const std::string pointer = fmt::format("/accessors/{}", i);
    const AccessorLayout layout = layout_of(accessor);
    if (accessor.contains("byteOffset") && !accessor.contains("bufferView"))
      check.error(pointer + "/byteOffset", "stands without a bufferView");
    if (!layout.known) continue;
    if (layout.normalized && (layout.component_type == kFloat || layout.component_type == kUnsignedInt))
      check.error(pointer + "/normalized", "is only for 8 and 16 bit integers");
    for (const char* bound : {"min", "max"})
      if (accessor.contains(bound) && accessor[bound].size() != layout.components())
        check.error(pointer + "/" + bound,
                    fmt::format("has {} values, the type has {}", accessor[bound].size(), layout.components()));
    if (accessor.contains("bufferView")) {
      const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
      const std::uint64_t stride = value_of<std::uint64_t>(view, "byteStride", layout.element_size);
      if (stride < layout.element_size) check.error(pointer, "has elements longer than its bufferView's byteStride");
      check_placement(json, accessor, pointer, layout.count, layout.last_size, stride, layout.component_size,
                      layout.columns > 1 ? 4 : layout.component_size, check);
    }
    if (accessor.contains("sparse")) check_sparse(json, accessor, layout, pointer, check);
  }
}

// A TRS matrix (column-major) has an affine last row and orthogonal columns.
bool is_trs(const Json& matrix) {
  double m[16];
  for (std::size_t i = 0; i < 16; ++i) m[i] = matrix[i].get<double>();
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) return false;
  const dvec3 c[3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
  for (int i = 0; i < 3; ++i) {
    const double scale = length(c[i]) * length(c[(i + 1) % 3]);
    if (scale == 0.0 || std::abs(dot(c[i], c[(i + 1) % 3])) > 5e-3 * scale) return false;
  }
  return true;
}

// The parent of every node, -1 for roots. A node with two parents or in a cycle is an error.
std::vector<std::int32_t> check_hierarchy(const Json& json, Meaning& check) {
  const Json& nodes = array_of(json, "nodes");
  std::vector<std::int32_t> parent(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Json& children = array_of(nodes[i], "children");
    for (std::size_t c = 0; c < children.size(); ++c) {
      std::int32_t& slot = parent[children[c].get<std::size_t>()];
      if (slot >= 0)
        check.error(fmt::format("/nodes/{}/children/{}", i, c), "already has another parent");
      else
        slot = static_cast<std::int32_t>(i);
    }
  }
  // Every node has at most one parent, so a node that no root reaches is in a cycle or below one.
  std::vector<bool> reached(nodes.size(), false);
  std::vector<std::size_t> stack;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (parent[i] < 0) stack.push_back(i);
  while (!stack.empty()) {
    const std::size_t i = stack.back();
    stack.pop_back();
    if (reached[i]) continue;
    reached[i] = true;
    for (const Json& child : array_of(nodes[i], "children")) stack.push_back(child.get<std::size_t>());
  }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!reached[i]) check.error(fmt::format("/nodes/{}", i), "is part of a loop of nodes");
  const Json& scenes = array_of(json, "scenes");
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const Json& roots = array_of(scenes[s], "nodes");
    for (std::size_t r = 0; r < roots.size(); ++r)
      if (parent[roots[r].get<std::size_t>()] >= 0)
        check.error(fmt::format("/scenes/{}/nodes/{}", s, r), "is not a root: another node has it as a child");
  }
  return parent;
}

void check_nodes(const Json& json, Meaning& check) {
  const Json& nodes = array_of(json, "nodes");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Json& node = nodes[i];
    const std::string pointer = fmt::format("/nodes/{}", i);
    if (node.contains("matrix")) {
      if (node.contains("translation") || node.contains("rotation") || node.contains("scale"))
        check.error(pointer + "/matrix", "stands beside translation, rotation or scale; keep one of the two");
      else if (!is_trs(node["matrix"]))
        check.error(pointer + "/matrix", "is not a product of translation, rotation and scale; apply it to the mesh");
    }
    if (node.contains("rotation")) {
      double sum = 0.0;
      for (const Json& part : node["rotation"]) sum += part.get<double>() * part.get<double>();
      if (std::abs(std::sqrt(sum) - 1.0) > 5e-3) check.error(pointer + "/rotation", "is not a unit quaternion");
    }
    for (const char* key : {"skin", "weights"})
      if (node.contains(key) && !node.contains("mesh")) check.error(pointer + "/" + key, "stands without a mesh");
    if (extension_of(node, "KHR_lights_punctual") && !extension_of(json, "KHR_lights_punctual"))
      check.error(pointer + "/extensions/KHR_lights_punctual", "needs the same extension at the root, with the lights");
  }
}

void check_skins(const Json& json, const std::vector<std::int32_t>& parent, Meaning& check) {
  const Json& skins = array_of(json, "skins");
  // Roots found are cached for all nodes on the way, so that long joint chains are traversed once.
  std::vector<std::int32_t> known(parent.size(), -1);
  const auto root_of = [&](std::int32_t node) {
    std::int32_t root = node;
    while (known[static_cast<std::size_t>(root)] < 0 && parent[static_cast<std::size_t>(root)] >= 0)
      root = parent[static_cast<std::size_t>(root)];
    if (known[static_cast<std::size_t>(root)] >= 0) root = known[static_cast<std::size_t>(root)];
    for (std::int32_t at = node; at >= 0 && known[static_cast<std::size_t>(at)] < 0;
         at = parent[static_cast<std::size_t>(at)])
      known[static_cast<std::size_t>(at)] = root;
    return root;
  };
  for (std::size_t s = 0; s < skins.size(); ++s) {
    const std::string pointer = fmt::format("/skins/{}", s);
    const Json& joints = skins[s]["joints"];
    std::set<std::int32_t> roots;
    for (const Json& joint : joints) roots.insert(root_of(joint.get<std::int32_t>()));
    if (roots.size() > 1) check.error(pointer + "/joints", "have no common root");
    if (!skins[s].contains("inverseBindMatrices")) continue;
    const std::size_t index = skins[s]["inverseBindMatrices"].get<std::size_t>();
    const Json& accessor = json["accessors"][index];
    const AccessorLayout layout = layout_of(accessor);
    if (!layout.known || layout.columns != 4 || layout.component_type != kFloat)
      check.error(pointer + "/inverseBindMatrices", "is not an accessor of MAT4 floats");
    if (layout.count < joints.size()) check.error(pointer + "/inverseBindMatrices", "has fewer matrices than joints");
    check.use(index, BufferUse::kMatrices, pointer + "/inverseBindMatrices");
  }
}

}  // namespace

void Meaning::use(std::size_t accessor, BufferUse use, const std::string& pointer) {
  const auto found = accessor_use_.emplace(accessor, use);
  if (!found.second && found.first->second != use) error(pointer, "is an accessor that already serves another end");
  const Json& json = json_["accessors"][accessor];
  if (json.contains("bufferView")) use_view(json["bufferView"].get<std::size_t>(), use, pointer);
}

void Meaning::use_view(std::size_t view, BufferUse use, const std::string& pointer) {
  const Json& json = json_["bufferViews"][view];
  if (use == BufferUse::kValues) use = BufferUse::kTimes;
  const auto found = view_use_.emplace(view, use);
  if (!found.second && found.first->second != use)
    error(pointer, "stands on a bufferView that already serves another end");
  const int target = value_of(json, "target", 0);
  if ((target == 34962 && use != BufferUse::kVertices) || (target == 34963 && use != BufferUse::kIndices))
    error(pointer, "stands on a bufferView whose target says otherwise");
  if (json.contains("byteStride") && use != BufferUse::kVertices)
    error(pointer, "stands on a bufferView with a byteStride, which only vertex attributes may have");
}

void check_meaning(const Json& json, Findings& findings) {
  Meaning check(json, findings);
  check_asset(json, check);
  check_extension_lists(json, check);
  check_buffer_views(json, check);
  check_accessors(json, check);
  const std::vector<std::int32_t> parent = check_hierarchy(json, check);
  if (any_error(findings)) return;  // the following checks traverse the hierarchy and read layouts
  check_nodes(json, check);
  check_skins(json, parent, check);
  check_skeletons(json, parent, check);
  check_images(json, check);
  check_cameras(json, check);
  check_lights_and_variants(json, check);
  check_meshes(json, check);
  check_animations(json, check);
}

}  // namespace pliant
