// load_level: a checked glTF document -> Level. Nodes are ordered parents first. Meshes, materials and pictures keep
// their glTF numbers; skinned instances follow after the meshes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "content/files/mesh_import.h"
#include "content/gltf/form/gltf_document.h"
#include "content/gltf/read/gltf_animation.h"
#include "content/gltf/read/gltf_appearance.h"
#include "content/gltf/read/gltf_mesh.h"
#include "content/keys/extensions.h"
#include "content/level_file.h"
#include "content/tets/tet_file.h"
#include "content/tets/tet_level.h"
#include "runtime/long_work.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSupported[] = {"KHR_mesh_quantization",
                                      "KHR_draco_mesh_compression",
                                      "KHR_lights_punctual",
                                      "KHR_materials_ior",
                                      "KHR_materials_transmission",
                                      "KHR_materials_volume",
                                      "KHR_materials_emissive_strength",
                                      "KHR_texture_transform",
                                      "KHR_materials_unlit",
                                      "KHR_node_visibility",
                                      "KHR_materials_variants",
                                      "KHR_animation_pointer",
                                      "KHR_materials_specular",
                                      "KHR_materials_sheen",
                                      "KHR_materials_clearcoat",
                                      "KHR_materials_diffuse_transmission",
                                      "KHR_materials_anisotropy",
                                      "KHR_materials_dispersion",
                                      "KHR_materials_iridescence"};

LocalTransform transform_of(const tinygltf::Node& node) {
  LocalTransform local;
  if (const std::vector<double>& m = node.matrix; !m.empty()) {
    dmat3 axes(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    dvec3 scale(length(axes[0]), length(axes[1]), length(axes[2]));
    if (glm::determinant(axes) < 0.0) scale.x = -scale.x;
    for (int i = 0; i < 3; ++i) axes[i] /= scale[i];
    local.translation = vec3(dvec3(m[12], m[13], m[14]));
    local.rotation = quat(glm::normalize(glm::quat_cast(axes)));
    local.scale = vec3(scale);
    return local;
  }
  local.translation = vector_of(node.translation, local.translation);
  local.scale = vector_of(node.scale, local.scale);
  const vec4 q = vector_of(node.rotation, vec4(0, 0, 0, 1));
  local.rotation = quat(q.w, q.x, q.y, q.z);
  // A quaternion of unit length in single precision is kept bit for bit, so that saving does not change it.
  const dquat exact(local.rotation);
  if (std::abs(glm::length(exact) - 1.0) > 1e-6) local.rotation = quat(glm::normalize(exact));
  return local;
}

std::size_t shown_scene(const SourceDocument& document) {
  return static_cast<std::size_t>(std::max(document.model.defaultScene, 0));
}

// Parents first, roots of the shown scene first; every node keeps its number as its source.
void order_nodes(const SourceDocument& document, Level& level) {
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  const std::vector<tinygltf::Scene>& scenes = document.model.scenes;
  std::vector<std::int32_t> parent(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const int child : nodes[i].children) parent[static_cast<std::size_t>(child)] = static_cast<std::int32_t>(i);
  struct Visit {
    std::size_t node;
    std::int32_t parent;
    bool in_scene;
  };
  std::vector<Visit> roots;
  std::vector<bool> placed(nodes.size(), false);
  if (!scenes.empty())
    for (const int root : scenes[shown_scene(document)].nodes) {
      roots.push_back({static_cast<std::size_t>(root), -1, true});
      placed[static_cast<std::size_t>(root)] = true;
    }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (parent[i] < 0 && !placed[i]) roots.push_back({i, -1, scenes.empty()});
  std::vector<Visit> stack(roots.rbegin(), roots.rend());
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const std::int32_t here = static_cast<std::int32_t>(level.nodes.size());
    LevelNode node;
    node.parent = visit.parent;
    node.in_scene = visit.in_scene;
    node.source = static_cast<std::int32_t>(visit.node);
    level.nodes.push_back(std::move(node));
    if (visit.parent >= 0) level.nodes[static_cast<std::size_t>(visit.parent)].children.push_back(here);
    const std::vector<int>& children = nodes[visit.node].children;
    for (std::size_t c = children.size(); c-- > 0;)
      stack.push_back({static_cast<std::size_t>(children[c]), here, visit.in_scene});
  }
}

// Node-to-world matrices by glTF number.
std::vector<dmat4> matrices_by_number(const Level& level) {
  const std::vector<dmat4> world = world_matrices(level.nodes);
  std::vector<dmat4> by_number(world.size());
  for (std::size_t i = 0; i < world.size(); ++i) by_number[static_cast<std::size_t>(level.nodes[i].source)] = world[i];
  return by_number;
}

Status read_nodes(const SourceDocument& document, MeshReader& meshes, Level& level) {
  const std::vector<tinygltf::Node>& nodes = document.model.nodes;
  order_nodes(document, level);
  std::vector<std::string> json_names(nodes.size());
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const std::size_t number = static_cast<std::size_t>(level.nodes[i].source);
    LevelNode& node = level.nodes[i];
    node.local = transform_of(nodes[number]);
    node.mesh = nodes[number].mesh;
    node.name = nodes[number].name;
    if (node.name.empty() && node.mesh >= 0) node.name = level.meshes[static_cast<std::size_t>(node.mesh)].name;
    if (node.name.empty()) node.name = fmt::format("node_{}", number);
    json_names[number] = node.name;
    node.light = light_of(document, number);
    node.camera = camera_of(document, number, level);
  }
  const std::vector<dmat4> world = matrices_by_number(level);
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const std::size_t number = static_cast<std::size_t>(level.nodes[i].source);
    if (nodes[number].skin >= 0) {
      Result<LevelMesh> mesh = meshes.read_skinned(static_cast<std::size_t>(nodes[number].mesh),
                                                   static_cast<std::size_t>(nodes[number].skin), world, number);
      if (!mesh) return mesh.error();
      level.notes.push_back("skins are read at rest: " + level.nodes[i].name);
      mesh->source = level.nodes[i].mesh;
      mesh->skinned = level.nodes[i].source;
      level.nodes[i].mesh = static_cast<std::int32_t>(level.meshes.size());
      level.meshes.push_back(std::move(*mesh));
    }
    const Json& json = document.json["nodes"][number];
    if (!json.contains("extensions")) continue;
    const Status status = parse_node_extensions(json["extensions"], fmt::format("/nodes/{}/extensions", number),
                                                json_names, level.nodes[i]);
    if (!status) return status;
  }
  return check_references(level);
}

Status read_scene(const SourceDocument& document, Level& level) {
  const Json& scenes = array_of(document.json, "scenes");
  if (scenes.empty()) return Done{};
  const std::size_t shown = shown_scene(document);
  if (!scenes[shown].contains("extensions")) return Done{};
  return parse_scene_extensions(scenes[shown]["extensions"], fmt::format("/scenes/{}/extensions", shown), level);
}

Status fill(SourceDocument& document, Level& level) {
  for (const std::string& wanted : document.model.extensionsRequired) {
    const bool known = wanted.rfind("PLIANT_", 0) == 0 ||
                       std::find(std::begin(kSupported), std::end(kSupported), wanted) != std::end(kSupported);
    if (!known)
      return Error{"/extensionsRequired", "asks for " + wanted.substr(0, 100) + ", which is not supported",
                   "export without it"};
  }
  if (const Status status = read_images(document, level); !status) return status;
  for (std::size_t m = 0; m < document.model.materials.size(); ++m)
    level.materials.push_back(material_of(document, m, level));
  MeshReader meshes(document);
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
    check_in("reading meshes", static_cast<double>(m) / static_cast<double>(document.model.meshes.size()));
    Result<LevelMesh> mesh = meshes.read(m);
    if (!mesh) return mesh.error();
    mesh->source = static_cast<std::int32_t>(m);
    level.meshes.push_back(std::move(*mesh));
  }
  if (const Status status = read_nodes(document, meshes, level); !status) return status;
  if (const Status status = read_animations(document, level); !status) return status;
  if (const Status status = read_scene(document, level); !status) return status;
  level.notes.insert(level.notes.end(), meshes.notes().begin(), meshes.notes().end());
  // Keep each note once, in order of first appearance.
  std::vector<std::string> once;
  std::size_t of_document = 0;
  for (std::size_t i = 0; i < level.notes.size(); ++i) {
    std::string& note = level.notes[i];
    if (once.size() >= 100 || std::find(once.begin(), once.end(), note) != once.end()) continue;
    of_document += i < level.document_notes;
    once.push_back(std::move(note));
  }
  level.notes = std::move(once);
  level.about = about_of(document.json);
  level.document_notes = of_document;
  document.nodes_as_read = level.nodes;
  for (const LevelMesh& mesh : level.meshes) {
    check_in("reading meshes", 1.0);
    document.meshes_as_read.push_back(fingerprint(mesh));
  }
  for (const LevelAnimation& animation : level.animations) {
    std::vector<ChannelAsRead>& channels = document.animations_as_read.emplace_back();
    for (const LevelChannel& channel : animation.channels)
      channels.push_back(fingerprint(channel, level.nodes[static_cast<std::size_t>(channel.node)].source));
  }
  return Done{};
}

}  // namespace

std::string about_of(const Json& root) {
  const Json none = Json::object();
  const Json asset = value_of(root, "asset", none), extras = asset.is_object() ? value_of(asset, "extras", none) : none;
  if (!extras.is_object() || !extras.contains("about") || !extras["about"].is_string()) return {};
  return extras["about"].get<std::string>();
}

Result<std::string> read_about(const fs::path& path) {
  Findings findings;
  const std::optional<SourceDocument> document = open_gltf(path, findings);
  if (!document) return Error{path.string(), "cannot be read", "`pliant validate` says why"};
  return about_of(document->json);
}

namespace {

// Adds the file's name to the error or the Level.
Result<Level> from_file(Result<Level> level, const fs::path& path) {
  if (!level) {
    const std::string where = level.error().where;
    if (where.empty() || where == path.string()) return level.error().at(path.string());
    Error error = level.error().at(path.string() + " " + where);
    error.pointer = where;
    return error;
  }
  level->name = path.stem().string();
  level->path = path;
  return level;
}

Result<Level> level_of(SourceDocument document, const Findings& findings) {
  Level level;
  for (const Finding& finding : findings)
    if (finding.severity == Severity::kWarning)
      level.notes.push_back(finding.pointer.empty() ? finding.message() : finding.pointer + ": " + finding.message());
  level.document_notes = level.notes.size();
  if (const Status status = fill(document, level); !status) return status.error();
  level.source = std::make_shared<SourceDocument>(std::move(document));
  return level;
}

// Formats whose files may name their unit; importers scale by it.
bool says_unit(const std::string& extension) {
  for (const char* each : {".dae", ".fbx", ".3mf", ".amf", ".ifc", ".step", ".stp", ".usd", ".usda", ".usdc", ".usdz"})
    if (extension == each) return true;
  return false;
}

// Catches exceptions of failed allocations, and of faults that the checks have missed.
Result<Level> guarded(const std::function<Result<Level>()>& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    return Error{"", "needs more memory than there is", "split the level"};
  } catch (const Json::exception& e) {
    return Error{"", std::string("cannot be read: ") + e.what()};
  }
}

}  // namespace

Result<Level> load_gltf(std::span<const std::uint8_t> bytes, bool expect_glb, const fs::path& folder) {
  return guarded([&]() -> Result<Level> {
    Findings findings;
    std::optional<SourceDocument> document = open_gltf(bytes, expect_glb, folder, findings);
    if (document) return level_of(std::move(*document), findings);
    for (const Finding& finding : findings) {
      if (finding.severity != Severity::kError) continue;
      Error error = error_of(finding);
      if (error.where.empty() && error.cure.empty()) error.cure = "export or save it again";
      return error;
    }
    return Error{"", "cannot be read", "export it again"};
  });
}

Result<Level> load_document(SourceDocument document, const Findings& findings, const fs::path& path) {
  return from_file(guarded([&] { return level_of(std::move(document), findings); }), path);
}

Result<Level> load_level(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".gltf" && extension != ".glb") {
    Result<Level> level = from_file(is_tet_file(path) ? import_tets(path) : import_mesh(path), path);
    if (level) level->unitless = !says_unit(extension);
    return level;
  }
  Result<Bytes> bytes = read_file(path);
  if (!bytes) return bytes.error();
  return from_file(load_gltf(*bytes, extension == ".glb", path.parent_path()), path);
}

}  // namespace pliant
