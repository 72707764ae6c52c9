// Checks the users of accessors against glTF 2.0: mesh primitives, morph targets, texture coordinates of materials,
// animations. Called by check_meaning.
#include <fmt/format.h>

#include <cctype>
#include <map>
#include <set>

#include "content/gltf/check/gltf_check.h"
#include "content/gltf/check/gltf_meaning.h"
#include "content/gltf/form/gltf_accessor.h"
#include "content/level/varying_keys.h"

namespace pliant {

namespace {

// TEXCOORD_3 -> {TEXCOORD, 3}; POSITION -> {POSITION, -1}; false: not a glTF name.
bool split_attribute(const std::string& name, std::string& semantic, int& set) {
  set = -1;
  semantic = name;
  if (name == "POSITION" || name == "NORMAL" || name == "TANGENT") return true;
  const std::size_t underscore = name.find('_');
  if (underscore == std::string::npos || underscore == 0) return underscore == 0;
  semantic = name.substr(0, underscore);
  const std::string digits = name.substr(underscore + 1);
  if (digits.empty() || digits.size() > 3 || digits.find_first_not_of("0123456789") != std::string::npos) return false;
  if (digits.size() > 1 && digits[0] == '0') return false;
  set = std::stoi(digits);
  return semantic == "TEXCOORD" || semantic == "COLOR" || semantic == "JOINTS" || semantic == "WEIGHTS";
}

// The formats of glTF 2.0, 3.7.2.1 and of KHR_mesh_quantization.
bool format_is_allowed(const std::string& semantic, const AccessorLayout& layout, bool quantized, bool target) {
  const std::size_t width = layout.columns == 1 ? layout.rows : 0;
  const int type = layout.component_type;
  const bool is_float = type == kFloat;
  const bool small_unsigned = type == kUnsignedByte || type == kUnsignedShort;
  const bool small_signed = type == kByte || type == kShort;
  const bool small = small_unsigned || small_signed;
  if (semantic[0] == '_') return type != kUnsignedInt;
  if (semantic == "POSITION") return width == 3 && (is_float || (quantized && (target ? small_signed : small)));
  if (semantic == "NORMAL") return width == 3 && (is_float || (quantized && small_signed && layout.normalized));
  if (semantic == "TANGENT")
    return width == (target ? 3u : 4u) && (is_float || (quantized && small_signed && layout.normalized));
  if (semantic == "TEXCOORD")
    return width == 2 && (is_float || (small_unsigned && layout.normalized) || (quantized && small) ||
                          (target && small && layout.normalized));
  if (semantic == "COLOR")
    return (width == 3 || width == 4) &&
           (is_float || (small_unsigned && layout.normalized) || (target && small && layout.normalized));
  if (semantic == "JOINTS") return width == 4 && small_unsigned && !layout.normalized;
  return width == 4 && (is_float || (small_unsigned && layout.normalized));
}

class MeshCheck {
 public:
  MeshCheck(const Json& json, Meaning& check)
      : json_(json), check_(check), quantized_(extension_is_used(json, "KHR_mesh_quantization")) {}

  void mesh(const Json& mesh, const std::string& pointer) {
    const Json& primitives = mesh["primitives"];
    std::size_t targets = array_of(primitives[0], "targets").size();
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const std::string here = fmt::format("{}/primitives/{}", pointer, p);
      primitive(primitives[p], here);
      if (array_of(primitives[p], "targets").size() != targets)
        check_.error(here, "has another number of morph targets than the mesh's first primitive");
    }
    if (mesh.contains("weights") && mesh["weights"].size() != targets)
      check_.error(pointer + "/weights", "are not as many as the morph targets");
  }
  // Several accessors of vertex attributes in one bufferView need a stride.
  void shared_views() {
    for (const auto& [view, accessors] : vertex_accessors_)
      if (accessors.size() > 1 && !json_["bufferViews"][view].contains("byteStride"))
        check_.error(fmt::format("/bufferViews/{}", view),
                     "serves several vertex attributes and so needs a byteStride");
  }

 private:
  void attribute(const std::string& name, std::size_t index, const std::string& pointer, bool target) {
    const Json& accessor = json_["accessors"][index];
    const AccessorLayout layout = layout_of(accessor);
    std::string semantic;
    int set;
    if (!split_attribute(name, semantic, set))
      return check_.error(pointer, "unknown attribute '" + name.substr(0, 100) + "'", "prefix your own with _");
    if (!layout.known || !format_is_allowed(semantic, layout, quantized_, target))
      return check_.error(
          pointer, fmt::format("cannot be of {} {}", accessor["type"].get<std::string>(), layout.component_type));
    if (semantic == "POSITION" && !(accessor.contains("min") && accessor.contains("max")))
      check_.error(pointer, "is an accessor without min and max, which POSITION must have");
    check_.use(index, BufferUse::kVertices, pointer);
    if (!accessor.contains("bufferView")) return;
    const std::size_t view_index = accessor["bufferView"].get<std::size_t>();
    const Json& view = json_["bufferViews"][view_index];
    vertex_accessors_[view_index].insert(index);
    const std::uint64_t offset = value_of<std::uint64_t>(accessor, "byteOffset", 0);
    const bool tight = !view.contains("byteStride");
    if (offset % 4 != 0 || (value_of<std::uint64_t>(view, "byteOffset", 0) + offset) % 4 != 0 ||
        (tight && layout.element_size % 4 != 0))
      check_.error(pointer, "is vertex data that does not begin at multiples of four bytes");
  }

  void continuous(const std::map<std::string, std::set<int>>& sets, const std::string& pointer) {
    for (const auto& [semantic, numbers] : sets)
      if (!numbers.empty() && *numbers.rbegin() + 1 != static_cast<int>(numbers.size()))
        check_.error(pointer, semantic + " sets are not numbered 0, 1, 2 without gaps");
  }

  // A vertex has its weights once: the same accessor under two names would count twice.
  void weight_sets(const Json& attributes, const std::string& pointer) {
    std::set<std::size_t> seen;
    for (const auto& [name, value] : attributes.items())
      if (name.rfind("WEIGHTS_", 0) == 0 && !seen.insert(value.get<std::size_t>()).second)
        return check_.error(pointer + "/attributes/" + escaped(name),
                            "is the accessor of another set of weights as well", "remove one of the sets");
  }

  void indices(const Json& primitive, const std::string& pointer) {
    const std::size_t index = primitive["indices"].get<std::size_t>();
    const Json& accessor = json_["accessors"][index];
    const AccessorLayout layout = layout_of(accessor);
    const int type = layout.component_type;
    if (!layout.known || layout.components() != 1 || layout.normalized ||
        !(type == kUnsignedByte || type == kUnsignedShort || type == kUnsignedInt))
      check_.error(pointer + "/indices", "are not unsigned integers");
    check_.use(index, BufferUse::kIndices, pointer + "/indices");
  }

  // Every texture of a material needs the texture coordinate set that it refers to.
  void texcoords(const Json& material, const std::string& where, std::size_t available, const std::string& pointer) {
    for (const auto& [key, value] : material.items()) {
      if (!value.is_object() || key == "extras") continue;
      if (value.contains("index") && key.size() > 7 && key.compare(key.size() - 7, 7, "Texture") == 0) {
        std::size_t set = value_of<std::size_t>(value, "texCoord", 0);
        if (const Json* transform = extension_of(value, "KHR_texture_transform"))
          set = value_of(*transform, "texCoord", set);
        if (set >= available)
          check_.error(pointer + "/material", fmt::format("{}/{} needs TEXCOORD_{}", where, key, set));
      } else {
        texcoords(value, where + "/" + key, available, pointer);
      }
    }
  }

  void primitive(const Json& primitive, const std::string& pointer) {
    const Json& attributes = primitive["attributes"];
    std::map<std::string, std::set<int>> sets;
    std::uint64_t vertices = 0;
    for (const auto& [name, value] : attributes.items()) {
      const std::string here = pointer + "/attributes/" + escaped(name);
      const std::size_t index = value.get<std::size_t>();
      attribute(name, index, here, false);
      std::string semantic;
      int set;
      if (split_attribute(name, semantic, set) && set >= 0) sets[semantic].insert(set);
      const std::uint64_t count = json_["accessors"][index]["count"].get<std::uint64_t>();
      if (vertices != 0 && count != vertices) check_.error(here, "has another count than the attributes before it");
      vertices = count;
    }
    if (!attributes.contains("POSITION")) check_.warn(pointer + "/attributes", "have no POSITION: nothing is shown");
    continuous(sets, pointer + "/attributes");
    weight_sets(attributes, pointer);
    if (sets["JOINTS"].size() != sets["WEIGHTS"].size())
      check_.error(pointer + "/attributes", "have more JOINTS than WEIGHTS or fewer");
    if (primitive.contains("indices")) indices(primitive, pointer);
    const Json& targets = array_of(primitive, "targets");
    for (std::size_t t = 0; t < targets.size(); ++t)
      for (const auto& [name, value] : targets[t].items()) {
        const std::string here = fmt::format("{}/targets/{}/{}", pointer, t, escaped(name));
        const std::size_t index = value.get<std::size_t>();
        attribute(name, index, here, true);
        if (!attributes.contains(name)) check_.error(here, "has no attribute of the primitive to act on");
        if (json_["accessors"][index]["count"].get<std::uint64_t>() != vertices)
          check_.error(here, "has another count than the primitive's attributes");
      }
    // Check a material once per number of available texture coordinate sets.
    if (!primitive.contains("material")) return;
    const std::size_t material = primitive["material"].get<std::size_t>();
    if (materials_seen_.insert({material, sets["TEXCOORD"].size()}).second)
      texcoords(json_["materials"][material], fmt::format("/materials/{}", material), sets["TEXCOORD"].size(), pointer);
  }

  const Json& json_;
  Meaning& check_;
  bool quantized_;
  std::map<std::size_t, std::set<std::size_t>> vertex_accessors_;  // bufferView -> accessors of vertex attributes
  std::set<std::pair<std::size_t, std::size_t>> materials_seen_;
};

// Nodes with morph weights or skins need a mesh with matching attributes.
void check_node_meshes(const Json& json, Meaning& check) {
  const Json& nodes = array_of(json, "nodes");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].contains("mesh")) continue;
    const Json& first = json["meshes"][nodes[i]["mesh"].get<std::size_t>()]["primitives"][0];
    const std::string pointer = fmt::format("/nodes/{}", i);
    if (nodes[i].contains("weights") && nodes[i]["weights"].size() != array_of(first, "targets").size())
      check.error(pointer + "/weights", "are not as many as the mesh's morph targets");
    const bool skinned = first["attributes"].contains("JOINTS_0") && first["attributes"].contains("WEIGHTS_0");
    if (nodes[i].contains("skin") && !skinned)
      check.error(pointer + "/skin", "is for a mesh without JOINTS_0 and WEIGHTS_0");
    if (!nodes[i].contains("skin") && skinned) check.warn(pointer, "shows a skinned mesh without a skin");
  }
}

}  // namespace

void check_meshes(const Json& json, Meaning& check) {
  MeshCheck meshes(json, check);
  for (std::size_t m = 0; m < array_of(json, "meshes").size(); ++m)
    meshes.mesh(json["meshes"][m], fmt::format("/meshes/{}", m));
  meshes.shared_views();
  check_node_meshes(json, check);
}

// Unused animation data are checked too, because saving keeps them.
void check_animations(const Json& json, Meaning& check) {
  const Json& animations = array_of(json, "animations");
  std::map<std::size_t, bool> splines;  // per output accessor: CUBICSPLINE
  for (std::size_t a = 0; a < animations.size(); ++a) {
    const Json& samplers = animations[a]["samplers"];
    const std::string pointer = fmt::format("/animations/{}", a);
    for (std::size_t s = 0; s < samplers.size(); ++s) {
      const std::string here = fmt::format("{}/samplers/{}", pointer, s);
      const std::size_t input = samplers[s]["input"].get<std::size_t>();
      const AccessorLayout layout = layout_of(json["accessors"][input]);
      if (!layout.known || layout.components() != 1 || layout.component_type != kFloat)
        check.error(here + "/input", "is not an accessor of scalar floats");
      if (!json["accessors"][input].contains("min") || !json["accessors"][input].contains("max"))
        check.error(here + "/input", "is an accessor without min and max");
      const std::size_t output = samplers[s]["output"].get<std::size_t>();
      check.use(input, BufferUse::kTimes, here + "/input");
      check.use(output, BufferUse::kValues, here + "/output");
      const bool cubic = value_of<std::string>(samplers[s], "interpolation", "LINEAR") == "CUBICSPLINE";
      if (const auto [seen, is_new] = splines.emplace(output, cubic); !is_new && seen->second != cubic)
        check.error(here + "/output", "is an accessor of both splines and plain values", "give each its own");
    }
    std::set<std::pair<std::int64_t, std::string>> targets;
    std::set<std::string> aims;
    for (std::size_t c = 0; c < animations[a]["channels"].size(); ++c) {
      const Json& channel = animations[a]["channels"][c];
      const Json& target = channel["target"];
      const std::string here = fmt::format("{}/channels/{}", pointer, c);
      const std::string path = target["path"].get<std::string>();
      if (const Json* extension = extension_of(target, "KHR_animation_pointer")) {
        if (target.contains("node")) check.error(here + "/target/node", "stands beside KHR_animation_pointer");
        const std::string aim = (*extension)["pointer"].get<std::string>();
        if (aim.empty() || aim[0] != '/') check.error(here + "/target", "has a pointer that is no JSON pointer");
        if (!aims.insert(aim).second) check.error(here + "/target", "is the target of an earlier channel too");
      }
      if (channel["sampler"].get<std::size_t>() >= samplers.size()) {
        check.error(here + "/sampler", "refers to a sampler that the animation does not have");
        continue;
      }
      if (target.contains("node") && !targets.insert({target["node"].get<std::int64_t>(), path}).second)
        check.error(here + "/target", "is the target of an earlier channel too");
      if (const bool moves = path == "translation" || path == "rotation" || path == "scale";
          moves && target.contains("node") && json["nodes"][target["node"].get<std::size_t>()].contains("matrix"))
        check.error(here + "/target/node", "is placed by a matrix, which cannot be animated",
                    "give it translation, rotation and scale");
      const Json& sampler = samplers[channel["sampler"].get<std::size_t>()];
      const AccessorLayout output = layout_of(json["accessors"][sampler["output"].get<std::size_t>()]);
      std::map<std::string, std::size_t> widths = {{"translation", 3}, {"rotation", 4}, {"scale", 3}, {"weights", 1}};
      if (const Json* extension = extension_of(target, "KHR_animation_pointer")) {
        if (path != "pointer") check.error(here + "/target/path", "must be 'pointer' beside KHR_animation_pointer");
        if (find_varying_key(key_pointer((*extension)["pointer"].get<std::string>()).key)) widths["pointer"] = 1;
      }
      const auto width = widths.find(path);
      if (width == widths.end()) continue;
      const bool any_small = path == "rotation" || path == "weights";
      if (!output.known || output.components() != width->second ||
          (output.component_type != kFloat && !(any_small && output.normalized)))
        check.error(here + "/sampler", "has an output of a format that its path cannot take");
      std::size_t morphs = 1;
      if (path == "weights" && target.contains("node")) {
        const Json& node = json["nodes"][target["node"].get<std::size_t>()];
        morphs = node.contains("mesh")
                     ? array_of(json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0], "targets").size()
                     : 0;
        if (morphs == 0) check.error(here + "/target", "animates weights of a mesh without morph targets");
      }
      const bool cubic = value_of<std::string>(sampler, "interpolation", "LINEAR") == "CUBICSPLINE";
      const std::uint64_t keys = json["accessors"][sampler["input"].get<std::size_t>()]["count"].get<std::uint64_t>();
      if (morphs > 0 && output.count != keys * morphs * (cubic ? 3 : 1))
        check.error(here + "/sampler", "has an output of another length than its input asks for");
      if (cubic && keys < 2) check.error(here + "/sampler", "needs two keys at least");
    }
  }
}

}  // namespace pliant
