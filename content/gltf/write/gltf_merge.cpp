// merge_document: nodes and scenes, and the order of the steps. Data unknown to the Level move with their element.
// References to nodes, meshes, lights and cameras are renumbered.
#include "content/gltf/write/gltf_merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "content/gltf/write/gltf_save.h"

namespace pliant {

namespace {

bool same(const LocalTransform& a, const LocalTransform& b) {
  return a.translation == b.translation && a.rotation == b.rotation && a.scale == b.scale;
}

void set_or_erase(Json& object, const char* key, Json list) {
  if (list.empty())
    object.erase(key);
  else
    object[key] = std::move(list);
}

// The children of every node in order: those listed in `children`, then those that only name it as `parent`.
std::vector<std::vector<std::int32_t>> children_of(const std::vector<LevelNode>& nodes) {
  std::vector<std::vector<std::int32_t>> out(nodes.size());
  std::vector<bool> placed(nodes.size(), false);
  const auto place = [&](std::int32_t child, std::int32_t parent) {
    if (placed[static_cast<std::size_t>(child)]) return;
    placed[static_cast<std::size_t>(child)] = true;
    out[static_cast<std::size_t>(parent)].push_back(child);
  };
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const std::int32_t child : nodes[i].children)
      if (child >= 0 && static_cast<std::size_t>(child) < nodes.size() &&
          nodes[static_cast<std::size_t>(child)].parent == static_cast<std::int32_t>(i))
        place(child, static_cast<std::int32_t>(i));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].parent >= 0) place(static_cast<std::int32_t>(i), nodes[i].parent);
  return out;
}

// Collects the names under any "extensions".
void collect_extensions(const Json& json, std::set<std::string>& names) {
  if (!json.is_structured()) return;
  if (json.is_object())
    for (const auto& [key, value] : json.items()) {
      if (key == "extras") continue;
      if (key == "extensions" && value.is_object())
        for (const auto& [name, extension] : value.items()) names.insert(name);
      collect_extensions(value, names);
    }
  else
    for (const Json& element : json) collect_extensions(element, names);
}

// Removes extensions that are no longer used, and unused ones of Pliant, from the declarations.
void undeclare_extensions(const Json& before, Json& json) {
  std::set<std::string> had, have;
  collect_extensions(before, had);
  collect_extensions(json, have);
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (!json.contains(list)) continue;
    Json kept = Json::array();
    for (const Json& name : json[list]) {
      const std::string text = name.get<std::string>();
      if (have.count(text) || (!had.count(text) && text.rfind("PLIANT_", 0) != 0)) kept.push_back(name);
    }
    set_or_erase(json, list, std::move(kept));
  }
}

// Whether drop_unused_data knows every reference to accessors and bufferViews.
bool all_references_known(const Json& json) {
  for (const Json& name : array_of(json, "extensionsUsed")) {
    const std::string text = name.get<std::string>();
    const auto begins = [&](const char* prefix) { return text.rfind(prefix, 0) == 0; };
    if (!begins("KHR_") && !begins("PLIANT_") && !begins("EXT_texture_") && text != "EXT_mesh_gpu_instancing")
      return false;
  }
  return true;
}

void write_about(const Level& level, Json& json) {
  if (level.about == about_of(json)) return;
  Json& asset = json["asset"];
  if (level.about.empty()) {
    asset["extras"].erase("about");
    if (asset["extras"].empty()) asset.erase("extras");
    return;
  }
  if (asset.contains("extras") && !asset["extras"].is_object()) asset["extras"] = {{"extras", asset["extras"]}};
  asset["extras"]["about"] = level.about;
}

}  // namespace

std::vector<std::int32_t> numbers_of_kept(const std::vector<bool>& stays) {
  std::vector<std::int32_t> now;
  std::int32_t next = 0;
  for (const bool stay : stays) now.push_back(stay ? next++ : -1);
  return now;
}

void keep_elements(Json& json, const char* key, const std::vector<std::int32_t>& now) {
  if (std::find(now.begin(), now.end(), -1) == now.end()) return;
  Json kept = Json::array();
  for (std::size_t i = 0; i < now.size(); ++i)
    if (now[i] >= 0) kept.push_back(std::move(json[key][i]));
  set_or_erase(json, key, std::move(kept));
}

Merge merge_nodes(const Level& level) {
  Merge merge{level, *level.source, {}, {}, {}, {}, {}, {}, false, {}};
  Json& json = merge.document.json;
  const std::size_t count = array_of(json, "nodes").size();
  merge.read_by_number.resize(count);
  for (const LevelNode& node : level.source->nodes_as_read)
    merge.read_by_number[static_cast<std::size_t>(node.source)] = &node;
  // The first node with this source comes from the document; others with the same source are copies, and new.
  std::vector<bool> stays(count, false);
  for (const LevelNode& node : level.nodes) {
    const bool old = node.source >= 0 && static_cast<std::size_t>(node.source) < count &&
                     !stays[static_cast<std::size_t>(node.source)];
    merge.from.push_back(old ? node.source : -1);
    if (old) stays[static_cast<std::size_t>(node.source)] = true;
  }
  merge.node_now = numbers_of_kept(stays);
  merge.dropped = std::find(stays.begin(), stays.end(), false) != stays.end();
  keep_elements(json, "nodes", merge.node_now);
  for (const std::int32_t from : merge.from) {
    merge.number.push_back(from >= 0 ? merge.node_now[static_cast<std::size_t>(from)]
                                     : static_cast<std::int32_t>(array_of(json, "nodes").size()));
    if (from < 0) json["nodes"].push_back(Json::object());
  }
  const std::vector<std::vector<std::int32_t>> children = children_of(level.nodes);
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    Json& object = merge.object(i);
    Json numbers = Json::array();
    for (const std::int32_t child : children[i]) numbers.push_back(merge.number[static_cast<std::size_t>(child)]);
    set_or_erase(object, "children", std::move(numbers));
    const LevelNode* before = merge.read(i);
    if (before && same(before->local, level.nodes[i].local)) continue;
    for (const char* key : {"matrix", "translation", "rotation", "scale"}) object.erase(key);
    object.update(transform_json(level.nodes[i].local));
  }
  return merge;
}

// An unnamed node gets its mesh's name or its number when it is read; both may have changed.
void merge_names(Merge& merge) {
  const Json& json = merge.document.json;
  for (std::size_t i = 0; i < merge.level.nodes.size(); ++i) {
    Json& object = merge.object(i);
    std::string read = value_of<std::string>(object, "name", "");
    if (read.empty() && object.contains("mesh"))
      read = value_of<std::string>(json["meshes"][object["mesh"].get<std::size_t>()], "name", "");
    if (read.empty()) read = fmt::format("node_{}", merge.number[i]);
    if (read != merge.level.nodes[i].name) object["name"] = merge.level.nodes[i].name;
  }
}

void merge_scenes(Merge& merge) {
  Json& json = merge.document.json;
  const std::vector<LevelNode>& nodes = merge.level.nodes;
  // Other scenes keep those of their roots that are still roots.
  std::vector<bool> is_root(nodes.size(), false);
  Json shown = Json::array();
  bool all_shown = true, ascending = true;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent >= 0) continue;
    is_root[static_cast<std::size_t>(merge.number[i])] = true;
    all_shown = all_shown && nodes[i].in_scene;
    if (!nodes[i].in_scene) continue;
    ascending = ascending && (shown.empty() || shown.back().get<std::int32_t>() < merge.number[i]);
    shown.push_back(merge.number[i]);
  }
  if (!json.contains("scenes")) {  // every root is shown, by number
    if (all_shown && ascending) return;
    json["scenes"] = Json::array({Json::object()});
    json["scene"] = 0;
  }
  const std::size_t which = value_of<std::size_t>(json, "scene", 0);
  for (std::size_t s = 0; s < json["scenes"].size(); ++s) {
    Json kept = Json::array();
    for (const Json& root : array_of(json["scenes"][s], "nodes")) {
      const std::int32_t now = merge.node_now[root.get<std::size_t>()];
      if (now >= 0 && is_root[static_cast<std::size_t>(now)]) kept.push_back(now);
    }
    set_or_erase(json["scenes"][s], "nodes", s == which ? shown : kept);
  }
}

Result<SourceDocument> merge_document(const Level& level) {
  Merge merge = merge_nodes(level);
  if (const Status status = merge_meshes(merge); !status) return status.error();
  if (const Status status = merge_materials(merge); !status) return status.error();
  merge_names(merge);
  merge_lights_and_cameras(merge);
  merge_scenes(merge);
  merge_animations(merge);
  std::vector<const LevelNode*> read;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) read.push_back(merge.read(i));
  write_extensions(level, merge.number, read, merge.document);
  write_about(level, merge.document.json);
  undeclare_extensions(level.source->json, merge.document.json);
  if (merge.dropped && all_references_known(merge.document.json)) drop_unused_data(merge.document);
  return std::move(merge.document);
}

}  // namespace pliant
