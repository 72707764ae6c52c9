// save_level: the document that the Level came from, or one built from it, with what has changed since.
#include "content/gltf/gltf_save.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "content/files/image.h"
#include "content/gltf/gltf_container.h"
#include "content/gltf/gltf_model.h"
#include "content/keys/extensions.h"
#include "content/level_file.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

bool same(const LocalTransform& a, const LocalTransform& b) {
  return a.translation == b.translation && a.rotation == b.rotation && a.scale == b.scale;
}

// The document holds every mesh and node of the Level, if perhaps fewer nodes than were added to it since.
bool still_fits(const Level& level) {
  return level.source && level.source->mesh_count == level.meshes.size() &&
         level.source->json_node.size() <= level.nodes.size() && !level.source->json_node.empty();
}

// Replaces the PLIANT_* members of object.extensions.
void set_extensions(Json& json, Json& object, Json pliant) {
  Json extensions = object.contains("extensions") ? object["extensions"] : Json::object();
  for (auto it = extensions.begin(); it != extensions.end();)
    it = it.key().rfind("PLIANT_", 0) == 0 ? extensions.erase(it) : std::next(it);
  for (const auto& [name, value] : pliant.items()) declare_extension(json, name, false);
  extensions.update(pliant);
  if (extensions.empty())
    object.erase("extensions");
  else
    object["extensions"] = std::move(extensions);
}

// A cap is the word of who opened the file and not its maker's: what it lowered is saved as it was read.
LevelNode as_before_cap(LevelNode node, const LevelNode& read, const SafetyCap& cap) {
  const auto restore = [](double& value, double before, double most) {
    if (value == std::min(before, most)) value = before;
  };
  if (node.device && read.device) {
    restore(node.device->max_force, read.device->max_force, cap.max_force);
    restore(node.device->max_slew, read.device->max_slew, cap.max_slew());
  }
  if (node.handle && read.handle) restore(node.handle->max_torque, read.handle->max_torque, cap.max_torque());
  return node;
}

void write_nodes(const Level& level, SourceDocument& document) {
  Json& json = document.json;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    const bool is_new = i >= document.json_node.size();
    if (is_new) {
      const std::size_t number = json["nodes"].size();
      document.json_node.push_back(static_cast<std::int32_t>(number));
      json["nodes"].push_back(transform_json(node.local));
      if (node.mesh >= 0) json["nodes"][number]["mesh"] = node.mesh;
      if (node.parent >= 0)
        json["nodes"][static_cast<std::size_t>(document.json_node[static_cast<std::size_t>(node.parent)])]["children"]
            .push_back(number);
      else if (json.contains("scenes") && node.in_scene)
        json["scenes"][value_of<std::size_t>(json, "scene", 0)]["nodes"].push_back(number);
    }
    Json& object = json["nodes"][static_cast<std::size_t>(document.json_node[i])];
    const LevelNode* before = i < document.nodes_as_read.size() ? &document.nodes_as_read[i] : nullptr;
    if (!before || before->name != node.name) object["name"] = node.name;
    if (before && !same(before->local, node.local)) {
      for (const char* key : {"matrix", "translation", "rotation", "scale"}) object.erase(key);
      object.update(transform_json(node.local));
    }
    const LevelNode& saved = before && document.cap ? as_before_cap(node, *before, *document.cap) : node;
    set_extensions(json, object, node_extensions(saved, object.contains("extensions") ? object["extensions"] : Json()));
  }
}

void write_scene(const Level& level, SourceDocument& document) {
  Json& json = document.json;
  const bool had_scene = json.contains("scenes");
  const Json pliant = scene_extensions(
      level, had_scene && json["scenes"][value_of<std::size_t>(json, "scene", 0)].contains("extensions")
                 ? json["scenes"][value_of<std::size_t>(json, "scene", 0)]["extensions"]
                 : Json());
  if (!had_scene) {
    if (pliant.empty()) return;
    // A document without scenes shows every root.
    Json roots = Json::array();
    for (std::size_t i = 0; i < level.nodes.size(); ++i)
      if (level.nodes[i].parent < 0) roots.push_back(document.json_node[i]);
    json["scenes"] = Json::array({{{"nodes", roots}}});
    json["scene"] = 0;
  }
  set_extensions(json, json["scenes"][value_of<std::size_t>(json, "scene", 0)], pliant);
}

// extensionsUsed keeps only those PLIANT_* that are still there.
void forget_unused(const Level& level, Json& json) {
  if (!json.contains("extensionsUsed")) return;
  Json present = scene_extensions(level, Json());
  for (const Json& scene : array_of(json, "scenes"))
    if (scene.contains("extensions")) present.update(scene["extensions"]);
  for (const LevelNode& node : level.nodes) present.update(node_extensions(node, Json()));
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    Json kept = Json::array();
    for (const Json& name : array_of(json, list))
      if (name.get<std::string>().rfind("PLIANT_", 0) != 0 || present.contains(name.get<std::string>()))
        kept.push_back(name);
    if (kept.empty())
      json.erase(list);
    else
      json[list] = std::move(kept);
  }
}

// A file name as a relative URI: whatever could be read otherwise is percent-encoded.
std::string as_uri(const std::string& name) {
  std::string uri;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.' || c == '~';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

// Refuses to replace a .bin that is there but is no buffer of the .gltf that is replaced.
Status check_unrelated(const fs::path& bin, const fs::path& gltf) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(bin, ignored))) return Done{};
  Json json;
  Findings findings;
  if (const Result<Bytes> text = read_file(gltf); text && parse_json(*text, json, findings) && json.is_object())
    for (const Json& buffer : array_of(json, "buffers"))
      if (buffer.is_object() && buffer.contains("uri") && buffer["uri"] == as_uri(bin.filename().string()))
        return Done{};
  return Error{bin.string(), "is there already and belongs to something else than " + gltf.filename().string() +
                                 "; move it away, or name another file"};
}

}  // namespace

Bytes pack_document(SourceDocument& document, bool keep_image_uris) {
  Json& json = document.json;
  Bytes packed;
  const auto add = [&](const Bytes& bytes) {
    packed.resize((packed.size() + 7) / 8 * 8);
    packed.insert(packed.end(), bytes.begin(), bytes.end());
    return packed.size() - bytes.size();
  };
  // Where each buffer went; placeholders without data stay as they are, behind the packed one.
  std::vector<std::size_t> offset(document.buffers.size()), number(document.buffers.size(), 0);
  Json placeholders = Json::array();
  for (std::size_t i = 0; i < document.buffers.size(); ++i) {
    if (!document.buffers[i].empty())
      offset[i] = add(document.buffers[i]);
    else
      placeholders.push_back(json["buffers"][i]);
  }
  Json images = array_of(json, "images");
  std::vector<std::size_t> embedded;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const bool has_uri = images[i].contains("uri");
    const bool external = has_uri && images[i]["uri"].get_ref<const std::string&>().rfind("data:", 0) != 0;
    if (images[i].contains("bufferView") || document.images[i].empty() || (external && keep_image_uris)) continue;
    embedded.push_back(i);
  }
  const std::size_t first_placeholder = packed.empty() && embedded.empty() ? 0 : 1;
  for (std::size_t i = 0, placeholder = first_placeholder; i < document.buffers.size(); ++i)
    if (document.buffers[i].empty()) number[i] = placeholder++;
  if (json.contains("bufferViews"))
    for (Json& view : json["bufferViews"]) {
      const std::size_t buffer = view["buffer"].get<std::size_t>();
      const std::size_t at = value_of<std::size_t>(view, "byteOffset", 0) + offset[buffer];
      view["buffer"] = number[buffer];
      if (at != 0) view["byteOffset"] = at;
    }
  for (const std::size_t i : embedded) {
    const std::size_t at = add(document.images[i]);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", at}, {"byteLength", document.images[i].size()}});
    images[i].erase("uri");
    images[i]["bufferView"] = json["bufferViews"].size() - 1;
    images[i]["mimeType"] = image_format(document.images[i]) == ImageFormat::kPng ? "image/png" : "image/jpeg";
  }
  if (!images.empty()) json["images"] = std::move(images);
  Json buffers = Json::array();
  if (!packed.empty()) buffers.push_back({{"byteLength", packed.size()}});
  buffers.insert(buffers.end(), placeholders.begin(), placeholders.end());
  if (buffers.empty())
    json.erase("buffers");
  else
    json["buffers"] = std::move(buffers);
  return packed;
}

Result<Bytes> level_as_glb(const Level& level) {
  Result<SourceDocument> document = build_document(level);
  if (!document) return document.error();
  Bytes bin = pack_document(*document, false);
  return as_glb(document->json.dump(), bin);
}

Status save_level(const Level& level, const fs::path& path, const SaveOptions& options) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".gltf" && extension != ".glb")
    return Error{path.string(), "is neither .gltf nor .glb; name one of them"};
  SourceDocument document;
  if (still_fits(level)) {
    document = *level.source;
  } else {
    Result<SourceDocument> built = build_document(level);
    if (!built) return Error{path.string() + " " + built.error().where, built.error().what};
    document = std::move(*built);
  }
  write_nodes(level, document);
  write_scene(level, document);
  forget_unused(level, document.json);
  if (options.no_draco || options.draco_bits != 0)
    if (const Status status = decompress_document(document, options.no_draco); !status) return status;
  if (options.draco_bits != 0)
    if (const Status status = compress_document(document, options.draco_bits); !status) return status;

  const bool glb = extension == ".glb";
  std::error_code ignored;
  const bool same_folder =
      !document.folder.empty() &&
      fs::equivalent(document.folder, path.parent_path().empty() ? "." : path.parent_path(), ignored);
  Bytes bin = pack_document(document, !glb && same_folder);
  if (glb) {
    const Bytes whole = as_glb(document.json.dump(), bin);
    return write_file(path, whole, options.existing);
  }
  std::vector<FileToWrite> files;
  const fs::path beside = fs::path(path).replace_extension(".bin");
  if (!bin.empty()) {
    document.json["buffers"][0]["uri"] = as_uri(beside.filename().string());
    if (const Status status = check_unrelated(beside, path); !status) return status;
    files.push_back({beside, bin});
  }
  const std::string text = document.json.dump(2) + "\n";
  files.push_back({path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())});
  return write_files(files, options.existing);
}

}  // namespace pliant
