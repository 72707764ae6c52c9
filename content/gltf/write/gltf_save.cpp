// save_level: updates the Level's source document with all changes, or builds a new document.
#include "content/gltf/write/gltf_save.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "content/files/image.h"
#include "content/gltf/check/gltf_check.h"
#include "content/gltf/form/gltf_container.h"
#include "content/gltf/form/gltf_model.h"
#include "content/keys/extensions.h"
#include "content/level_file.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

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

// A safety cap is the user's setting, not the author's: capped values are saved as they were read.
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

// A file name as a relative URI: ambiguous characters are percent-encoded.
std::string as_uri(const std::string& name) {
  std::string uri;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.' || c == '~';
    uri += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

// Rejects output that load_level would reject by its JSON.
Status check_readable(const std::string& text) {
  Json json = Json::parse(text);
  Findings findings;
  check_structure(json, findings);
  if (!any_error(findings)) check_meaning(json, findings);
  for (const Finding& finding : findings)
    if (finding.severity == Severity::kError)
      return Error{finding.pointer, finding.message(), "nothing was saved, for it could not be read again",
                   finding.code};
  return Done{};
}

// Refuses to overwrite an existing .bin that is not a buffer of the replaced .gltf.
Status check_unrelated(const fs::path& bin, const fs::path& gltf) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(bin, ignored))) return Done{};
  Json json;
  Findings findings;
  if (const Result<Bytes> text = read_file(gltf); text && parse_json(*text, json, findings) && json.is_object())
    for (const Json& buffer : array_of(json, "buffers"))
      if (buffer.is_object() && buffer.contains("uri") && buffer["uri"] == as_uri(bin.filename().string()))
        return Done{};
  return Error{bin.string(), "is there already and belongs to something else than " + gltf.filename().string(),
               "move it away, or name another file"};
}

}  // namespace

void write_extensions(const Level& level, const std::vector<std::int32_t>& number,
                      const std::vector<const LevelNode*>& read, SourceDocument& document) {
  Json& json = document.json;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    Json& object = json["nodes"][static_cast<std::size_t>(number[i])];
    const Json before = object.contains("extensions") ? object["extensions"] : Json();
    if (document.cap && read[i])
      set_extensions(json, object, node_extensions(as_before_cap(level.nodes[i], *read[i], *document.cap), before));
    else
      set_extensions(json, object, node_extensions(level.nodes[i], before));
  }
  const std::size_t scene = value_of<std::size_t>(json, "scene", 0);
  const bool had_scene = json.contains("scenes");
  const Json before =
      had_scene && json["scenes"][scene].contains("extensions") ? json["scenes"][scene]["extensions"] : Json();
  const Json pliant = scene_extensions(level, before);
  if (!had_scene) {
    if (pliant.empty()) return;
    // A document without scenes shows every root.
    Json roots = Json::array();
    for (std::size_t i = 0; i < level.nodes.size(); ++i)
      if (level.nodes[i].parent < 0) roots.push_back(number[i]);
    json["scenes"] = Json::array({{{"nodes", roots}}});
    json["scene"] = 0;
  }
  set_extensions(json, json["scenes"][scene], pliant);
}

Bytes pack_document(SourceDocument& document, bool keep_image_uris) {
  Json& json = document.json;
  Bytes packed;
  const auto add = [&](const Bytes& bytes) {
    packed.resize((packed.size() + 7) / 8 * 8);
    packed.insert(packed.end(), bytes.begin(), bytes.end());
    return packed.size() - bytes.size();
  };
  // New place of each buffer; placeholders without data stay, after the packed one.
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
  if (!packed.empty()) {
    // A single buffer keeps its other members.
    Json whole = document.buffers.size() == 1 && !document.buffers[0].empty() ? json["buffers"][0] : Json::object();
    whole.erase("uri");
    whole["byteLength"] = packed.size();
    buffers.push_back(std::move(whole));
  }
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

namespace {

// The document as text; fails if a name is not UTF-8.
Result<std::string> json_text(const Json& json, int indent) {
  try {
    return json.dump(indent);
  } catch (const Json::exception&) {
    return Error{"", "holds a name or a text that is not UTF-8", "type it anew"};
  }
}

// Reads the output back before writing the file, as a run and the editor would.
Status check_opens(Json json, const Bytes& bin, std::size_t size, const fs::path& path) {
  if (!bin.empty()) json["buffers"][0].erase("uri");
  const Result<std::string> text = json_text(json, -1);
  if (!text) return text.error().at(path.string());
  const std::string cannot = "is not written, as it could not be opened again: ";
  if (size > most(limits::kFile))
    return error_at(path.string(), beyond(cannot + "it", limits::kFile, static_cast<double>(size), "split the level"));
  const Result<Level> again = load_gltf(as_glb(*text, bin), true, path.parent_path());
  if (again) return Done{};
  Error error = again.error();
  error.what = cannot + error.where + (error.where.empty() ? "" : " ") + error.what;
  if (error.cure.empty()) error.cure = "undo what was set last";
  return error.at(path.string());
}

}  // namespace

Result<std::vector<MadeFile>> make_level_files(const Level& level, const fs::path& path, const SaveOptions& options) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".gltf" && extension != ".glb")
    return Error{path.string(), "is neither .gltf nor .glb", "name one of them"};
  Result<SourceDocument> made = level.source ? merge_document(level) : build_document(level);
  if (!made) return made.error().at(path.string() + " " + made.error().where);
  SourceDocument& document = *made;
  if (!level.source) {
    std::vector<std::int32_t> number(level.nodes.size());
    std::iota(number.begin(), number.end(), 0);
    write_extensions(level, number, {}, document);
  }
  if (options.no_draco || options.draco_bits != 0) {
    Findings findings;
    if (level.source) reread_model(document, findings);
    if (any_error(findings)) return error_of(findings.back()).at(path.string() + " " + findings.back().pointer);
    if (const Status status = decompress_document(document, options.no_draco); !status) return status.error();
  }
  if (options.draco_bits != 0)
    if (const Status status = compress_document(document, options.draco_bits); !status) return status.error();

  const bool glb = extension == ".glb";
  std::error_code ignored;
  const bool same_folder =
      !document.folder.empty() &&
      fs::equivalent(document.folder, path.parent_path().empty() ? "." : path.parent_path(), ignored);
  Bytes bin = pack_document(document, !glb && same_folder);
  const fs::path beside = fs::path(path).replace_extension(".bin");
  if (!glb && !bin.empty()) document.json["buffers"][0]["uri"] = as_uri(beside.filename().string());
  Result<std::string> text = json_text(document.json, glb ? -1 : 2);
  if (!text) return text.error().at(path.string());
  if (!glb) *text += "\n";
  if (const Status status = check_readable(*text); !status)
    return status.error().at(path.string() + " " + status.error().where);
  std::vector<MadeFile> files;
  if (glb) {
    files.push_back({path, as_glb(*text, bin)});
  } else {
    if (!bin.empty()) {
      if (const Status status = check_unrelated(beside, path); !status) return status.error();
      files.push_back({beside, bin});
    }
    files.push_back({path, Bytes(text->begin(), text->end())});
  }
  if (const Status status = check_opens(std::move(document.json), bin, files.back().bytes.size(), path); !status)
    return status.error();
  return files;
}

Status write_made(const std::vector<MadeFile>& files, Existing existing) {
  std::vector<FileToWrite> all;
  for (const MadeFile& each : files) all.push_back({each.path, each.bytes});
  return write_files(all, existing);
}

Status save_level(const Level& level, const fs::path& path, const SaveOptions& options) {
  const Result<std::vector<MadeFile>> files = make_level_files(level, path, options);
  if (!files) return files.error();
  return write_made(*files, options.existing);
}

}  // namespace pliant
