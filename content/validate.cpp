#include "content/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "content/files/exr.h"
#include "content/gltf/form/gltf_document.h"
#include "content/keys/extensions.h"
#include "content/keys/unused_keys.h"
#include "content/level/device_request.h"
#include "content/level/device_use.h"
#include "content/level/script.h"
#include "content/level/spawn_soft.h"
#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/tet_file.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

constexpr double kSharp = 0.05;  // [rad] dihedral angle below which an element slows solvers down

void find_in_extensions(const Json& json, Findings& findings) {
  const Json& nodes = array_of(json, "nodes");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    names.push_back(value_of<std::string>(nodes[i], "name", fmt::format("node_{}", i)));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].contains("extensions"))
      find_in_node_extensions(nodes[i]["extensions"], fmt::format("/nodes/{}/extensions", i), names, findings);
  const Json& scenes = array_of(json, "scenes");
  for (std::size_t i = 0; i < scenes.size(); ++i)
    if (scenes[i].contains("extensions"))
      find_in_scene_extensions(scenes[i]["extensions"], fmt::format("/scenes/{}/extensions", i), findings);
}

// JSON pointer of a node; its name if the level is not from glTF.
std::string pointer_of(const Level& level, std::size_t node) {
  const LevelNode& it = level.nodes[node];
  return level.source && it.source >= 0 ? fmt::format("/nodes/{}", it.source) : it.name;
}

// Of the scene that is shown.
std::string scene_pointer(const Level& level) {
  const Json* json = level.source ? &level.source->json : nullptr;
  return fmt::format("/scenes/{}", json ? value_of<int>(*json, "scene", 0) : 0);
}

// Of an entity from spawn, which creates one per node of the scene, in order.
std::string pointer_of(const Level& level, const World& world, Entity entity) {
  std::size_t row = 0;
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (level.nodes[i].in_scene && world.hierarchy.order()[row++].entity == entity) return pointer_of(level, i);
  return scene_pointer(level);
}

Finding from_spawn(const Level& level, const Error& error) {
  if (error.node < 0) return {Severity::kError, scene_pointer(level), error.message()};
  return {Severity::kError, pointer_of(level, static_cast<std::size_t>(error.node)), error.what};
}

// prepare's errors name the node as `name`, or the name alone.
Finding from_prepare(const Level& level, const Error& error) {
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const std::string& name = level.nodes[i].name;
    if (level.nodes[i].in_scene && (error.where == name || error.where.find("`" + name + "`") != std::string::npos))
      return {Severity::kError, pointer_of(level, i), error.what};
  }
  return {Severity::kError, scene_pointer(level), error.message()};
}

// Extensions without effect, because their node is not in the shown scene.
void find_outside(const Level& level, Findings& findings) {
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (node.in_scene || !node.has_pliant()) continue;
    findings.push_back({Severity::kWarning, pointer_of(level, i),
                        "has PLIANT extensions but is not in the scene that is shown, so they do nothing; add it to " +
                            scene_pointer(level) + "/nodes, or to the children of a node there"});
  }
  if (!level.source) return;
  const Json& scenes = array_of(level.source->json, "scenes");
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const std::string here = fmt::format("/scenes/{}", s);
    if (here == scene_pointer(level) || !scenes[s].contains("extensions")) continue;
    for (const auto& [name, value] : scenes[s]["extensions"].items())
      if (name.rfind("PLIANT_", 0) == 0)
        findings.push_back({Severity::kWarning, here + "/extensions/" + name,
                            "is of a scene that is not shown, so it does nothing; move it to " + scene_pointer(level)});
  }
}

// Findings from building the mesh; returns its mean edge [m], or -1 if it cannot be built.
double find_in_mesh(const LevelNode& node, const LevelMesh& mesh, double crease, const std::string& pointer,
                    Findings& findings) {
  const Result<BuiltMesh> built = build_mesh(node.name, mesh.primitives, mat4(1), {crease});
  if (!built) {
    findings.push_back({Severity::kError, pointer, built.error().what});
    return -1.0;
  }
  const auto warn = [&](std::string message) { findings.push_back({Severity::kWarning, pointer, std::move(message)}); };
  const MeshReport& report = built->report;
  if (report.degenerate_triangles + report.duplicate_triangles > 0)
    warn(fmt::format("has {} degenerate and {} duplicate triangles, which are dropped", report.degenerate_triangles,
                     report.duplicate_triangles));
  if (report.border_edges > 0)
    warn(fmt::format("is open along {} edges: volume is not conserved there", report.border_edges));
  if (report.non_manifold_edges > 0)
    warn(fmt::format("has {} edges where more than two triangles, or two of opposite orientation, meet",
                     report.non_manifold_edges));
  if (const std::string turned = winding_note(report); !turned.empty()) warn(turned);
  if (const std::string doubt = winding_doubt(report); !doubt.empty()) warn(doubt);
  return static_cast<double>(built->mesh.mean_edge);
}

// Meshes that are unsuitable for touch. Common findings of instances are reported for the first one: a mesh can be
// shown ten thousand times, and is built once.
void find_in_meshes(const Level& level, Findings& findings, const std::atomic<bool>* stop) {
  std::map<std::pair<std::int32_t, double>, double> mean_edge;  // per mesh and crease angle
  std::set<std::tuple<std::int32_t, double, double>> seen;      // and the reach
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    if (stop && *stop) return;
    const LevelNode& node = level.nodes[i];
    if (!node.in_scene || node.mesh < 0 || (!node.deformable && !node.rigid_body)) continue;
    const double crease = node.deformable ? node.deformable->crease_angle : 0.0;
    const double reach = node.deformable ? node.deformable->reach : 0.0;
    if (!seen.insert({node.mesh, crease, reach}).second) continue;
    const auto [edge, is_new] = mean_edge.try_emplace({node.mesh, crease});
    if (is_new)
      edge->second =
          find_in_mesh(node, level.meshes[static_cast<std::size_t>(node.mesh)], crease, pointer_of(level, i), findings);
    if (reach > 0.0 && reach < edge->second)
      findings.push_back(
          {Severity::kWarning, pointer_of(level, i),
           fmt::format("has a reach of {} m, less than its mean edge of {:.3g} m: dents will be single vertices", reach,
                       edge->second)});
  }
}

// Conflicts of soft and rigid bodies, and notes on their files.
void find_in_soft_nodes(const Level& level, const fs::path& folder, Findings& findings) {
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (!node.in_scene) continue;
    const std::string pointer = pointer_of(level, i);
    if (const std::string fault = soft_fault(node); !fault.empty())
      findings.push_back({Severity::kError, pointer, fault});
    if (!node.soft_body || node.soft_body->mesh.empty()) continue;
    if (const Result<TetFile> file = load_named_tets(folder, node.soft_body->mesh); file)  // otherwise spawn reports it
      for (const std::string& note : file->notes) findings.push_back({Severity::kNote, pointer, note});
  }
}

// Settings without effect, and probes without a device.
void find_idle(const Level& level, Findings& findings) {
  for (const UnusedKey& key : find_unused_keys(level)) {
    const std::string owner =
        key.node < 0 ? scene_pointer(level) : pointer_of(level, static_cast<std::size_t>(key.node));
    std::string pointer = owner + "/extensions/" + key.pointer;
    std::replace(pointer.begin(), pointer.end(), '.', '/');  // dots in keys are nested objects
    findings.push_back({Severity::kNote, std::move(pointer), key.what});
  }
  for (const DeviceFault& idle : find_unmoved_probes(level))
    findings.push_back({Severity::kNote, pointer_of(level, idle.node), idle.what});
}

// Devices requested by id: lists the allowed ones, and rejects the others as `run` does.
void find_requests(const Level& level, Findings& findings) {
  for (const LevelRequest& asked : device_requests(level)) {
    if (!level.nodes[asked.node].in_scene) continue;
    const std::string pointer = pointer_of(level, asked.node) + "/extensions/PLIANT_haptic_device/id";
    const bool nothing = asked.used && asked.request.allowed.empty();
    for (const std::string& sentence : asked.request.refused)
      findings.push_back({nothing ? Severity::kError : Severity::kWarning, pointer,
                          "asks for more than a level may: " + sentence + "; " + device_cure(asked)});
    if (asked.used && !asked.request.allowed.empty())
      findings.push_back({Severity::kNote, pointer, "asks for the device `" + asked.request.allowed + "`"});
  }
}

// Scripts that are missing or contain no path.
void find_in_scripts(const Level& level, const fs::path& folder, Findings& findings) {
  ScriptLibrary scripts;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    const auto find = [&](const std::string& name, const char* key, bool reads) {
      const std::string pointer = pointer_of(level, i) + "/extensions/" + key;
      const auto error = [&](std::string what) { findings.push_back({Severity::kError, pointer, std::move(what)}); };
      const Result<fs::path> file = confined_path(folder, name);
      if (!file) return error(file.error().message());
      if (!fs::is_regular_file(*file)) return error("names the script " + name + ", which does not exist");
      if (!reads) return;
      if (const Result<const Path*> script = scripts.read(*file, false); !script) error(script.error().message());
    };
    if (node.motion && !node.motion->script.empty()) find(node.motion->script, "PLIANT_motion/script", false);
    if (node.device && !node.device->file.empty())
      find(node.device->file, "PLIANT_haptic_device/file", node.device->driver == DriverKind::kScript);
  }
}

// Tissue that can be simulated, but poorly.
void find_in_tissue(const Level& level, const World& world, Findings& findings) {
  for (auto [entity, soft_body] : world.registry.view<const SoftBody>()) {
    const std::string node = pointer_of(level, world, entity);  // clang 14 captures no structured bindings
    const TetMesh& tets = world.tet_meshes[soft_body.tets];
    const auto warn = [&](std::string what) { findings.push_back({Severity::kWarning, node, std::move(what)}); };
    for (const std::string& finding : tets.report.findings) warn(finding);
    if (const std::string doubt = locking_doubt(soft_body, tets.tets.size()); !doubt.empty()) warn(doubt);
    if (tets.quality.smallest_dihedral < kSharp)
      warn(
          fmt::format("has a dihedral angle of {:.2g} degrees: steps may need more work; mesh it again, or leave "
                      "`mesh` out for a lattice",
                      glm::degrees(tets.quality.smallest_dihedral)));
  }
}

}  // namespace

Findings validate_level(const fs::path& path, const std::function<Status(World&)>& prepare) {
  Findings findings;
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  std::optional<SourceDocument> document;
  Findings of_document;
  if (extension == ".gltf" || extension == ".glb") {
    document = open_gltf(path, of_document);
    findings = of_document;
    if (!document) return findings;
    find_in_extensions(document->json, findings);
    if (any_error(findings)) return findings;
  }
  Result<Level> level = document ? load_document(std::move(*document), of_document, path) : load_level(path);
  document.reset();
  if (!level) {
    findings.push_back({Severity::kError, level.error().pointer, level.error().what});
    return findings;
  }
  for (std::size_t i = level->document_notes; i < level->notes.size(); ++i)  // those before are already in the findings
    findings.push_back({Severity::kNote, "", level->notes[i]});
  level->path = path;
  const Findings of_level = validate_level(*std::move(level), prepare);
  findings.insert(findings.end(), of_level.begin(), of_level.end());
  return findings;
}

Findings validate_level(Level level, const std::function<Status(World&)>& prepare, const std::atomic<bool>* stop) {
  Findings findings;
  const auto stopped = [stop] { return stop && *stop; };
  const bool bare = !level.has_pliant();
  if (bare) {
    findings.push_back(
        {Severity::kNote, "", "has no Pliant extension: a bare mesh, touchable with defaults sized to its bounds"});
    make_touchable(level);
  }
  find_outside(level, findings);
  if (const Status size = check_level_size(level); !size) {  // before a mesh is built
    findings.push_back(from_spawn(level, size.error()));
    return findings;
  }
  find_in_meshes(level, findings, stop);
  if (stopped()) return findings;
  for (const DeviceFault& fault : find_shared_devices(level))
    findings.push_back({Severity::kError, pointer_of(level, fault.node), fault.what});
  find_idle(level, findings);
  find_requests(level, findings);
  // Files that the level names.
  const fs::path folder = level.path.parent_path();
  find_in_soft_nodes(level, folder, findings);
  find_in_scripts(level, folder, findings);
  if (level.environment && !level.environment->panorama.empty()) {
    std::vector<std::string> notes;
    const Result<Panorama> panorama = load_named_panorama(folder, level.environment->panorama, &notes);
    const std::string pointer = scene_pointer(level) + "/extensions/PLIANT_environment/panorama";
    if (!panorama) findings.push_back({Severity::kError, pointer, panorama.error().message()});
    for (const std::string& note : notes) findings.push_back({Severity::kNote, pointer, note});
  }
  if (any_error(findings) || stopped()) return findings;
  Result<World> world = spawn_moving_images(level);
  if (!world) {
    findings.push_back(from_spawn(level, world.error()));
    return findings;
  }
  if (stopped()) return findings;
  Status prepared = Done{};
  if (prepare) prepared = prepare(*world);  // may add findings on tissue (TetReport::findings)
  find_in_tissue(level, *world, findings);
  if (!prepared && !stopped()) findings.push_back(from_prepare(level, prepared.error()));
  return findings;
}

}  // namespace pliant
