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
#include "content/level/probe_damage.h"
#include "content/level/script.h"
#include "content/level/spawn_soft.h"
#include "content/level/unfelt_relief.h"
#include "content/level/unit.h"
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

// With the place of the error in the text.
Finding in_scene(const Level& level, Error error, const char* family) {
  if (!error.where.empty()) error.what = error.where + ": " + error.what;
  return finding_of(error, scene_pointer(level), family);
}

Finding from_spawn(const Level& level, const Error& error) {
  constexpr const char* kFamily = "level.build";
  if (error.node < 0) return in_scene(level, error, kFamily);
  return finding_of(error, pointer_of(level, static_cast<std::size_t>(error.node)), kFamily);
}

// prepare's errors name the node as `name`, or the name alone.
Finding from_prepare(const Level& level, const Error& error) {
  constexpr const char* kFamily = "level.prepare";
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const std::string& name = level.nodes[i].name;
    if (level.nodes[i].in_scene && (error.where == name || error.where.find("`" + name + "`") != std::string::npos))
      return finding_of(error, pointer_of(level, i), kFamily);
  }
  return in_scene(level, error, kFamily);
}

// Extensions without effect, because their node is not in the shown scene.
void find_outside(const Level& level, Findings& findings) {
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (node.in_scene || !node.has_pliant()) continue;
    findings.push_back({Severity::kWarning, pointer_of(level, i),
                        "has PLIANT extensions but is not in the scene that is shown, so they do nothing",
                        "add it to " + scene_pointer(level) + "/nodes, or to the children of a node there",
                        "level.not_shown"});
  }
  if (!level.source) return;
  const Json& scenes = array_of(level.source->json, "scenes");
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const std::string here = fmt::format("/scenes/{}", s);
    if (here == scene_pointer(level) || !scenes[s].contains("extensions")) continue;
    for (const auto& [name, value] : scenes[s]["extensions"].items())
      if (name.rfind("PLIANT_", 0) == 0)
        findings.push_back({Severity::kWarning, here + "/extensions/" + name,
                            "is of a scene that is not shown, so it does nothing", "move it to " + scene_pointer(level),
                            "level.not_shown"});
  }
}

// Findings from building the mesh; returns its mean edge [m], or -1 if it cannot be built.
double find_in_mesh(const LevelNode& node, const LevelMesh& mesh, double crease, const std::string& pointer,
                    Findings& findings) {
  const Result<BuiltMesh> built = build_mesh(node.name, mesh.primitives, mat4(1), {crease});
  if (!built) {
    findings.push_back(finding_of(built.error(), pointer, "mesh.build"));
    return -1.0;
  }
  const auto warn = [&](const char* code, std::string what) {
    findings.push_back({Severity::kWarning, pointer, std::move(what), {}, code});
  };
  const MeshReport& report = built->report;
  if (report.degenerate_triangles + report.duplicate_triangles > 0)
    warn("mesh.degenerate", fmt::format("has {} degenerate and {} duplicate triangles, which are dropped",
                                        report.degenerate_triangles, report.duplicate_triangles));
  if (report.border_edges > 0)
    warn("mesh.open_edges", fmt::format("is open along {} edges: volume is not conserved there", report.border_edges));
  if (report.non_manifold_edges > 0)
    warn("mesh.non_manifold",
         fmt::format("has {} edges where more than two triangles, or two of opposite orientation, meet",
                     report.non_manifold_edges));
  for (const std::optional<Note>& found : {winding_note(report), winding_doubt(report)})
    if (found) findings.push_back(finding_of(*found, Severity::kWarning, pointer));
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
          {Severity::kWarning,
           pointer_of(level, i),
           fmt::format("has a reach of {} m, less than its mean edge of {:.3g} m: dents will be single vertices", reach,
                       edge->second),
           {},
           "mesh.coarse"});
  }
}

// Conflicts of soft and rigid bodies, and notes on their files.
void find_in_soft_nodes(const Level& level, const fs::path& folder, Findings& findings) {
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (!node.in_scene) continue;
    const std::string pointer = pointer_of(level, i);
    if (const std::optional<Note> fault = soft_fault(node))
      findings.push_back(finding_of(*fault, Severity::kError, pointer));
    if (!node.soft_body || node.soft_body->mesh.empty()) continue;
    if (const Result<TetFile> file = load_named_tets(folder, node.soft_body->mesh); file)  // otherwise spawn reports it
      for (const std::string& note : file->notes) findings.push_back({Severity::kNote, pointer, note, {}, "tets.note"});
  }
}

// Settings without effect, and probes without a device.
void find_idle(const Level& level, Findings& findings) {
  for (const UnusedKey& key : find_unused_keys(level)) {
    const std::string owner =
        key.node < 0 ? scene_pointer(level) : pointer_of(level, static_cast<std::size_t>(key.node));
    std::string pointer = owner + "/extensions/" + key.pointer;
    std::replace(pointer.begin(), pointer.end(), '.', '/');  // dots in keys are nested objects
    findings.push_back({Severity::kNote, std::move(pointer), key.what, key.cure, "key.unused"});
  }
  for (const std::optional<Note>& note : {unfelt_relief(level), undamaged_by_bodies(level)})
    if (note) findings.push_back(finding_of(*note, Severity::kNote, scene_pointer(level)));
  for (const DeviceFault& idle : find_unmoved_probes(level))
    findings.push_back(finding_of(idle.what, Severity::kNote, pointer_of(level, idle.node)));
}

// Devices requested by id: lists the allowed ones, and rejects the others as `run` does.
void find_requests(const Level& level, Findings& findings) {
  for (const LevelRequest& asked : device_requests(level)) {
    if (!level.nodes[asked.node].in_scene) continue;
    const std::string pointer = pointer_of(level, asked.node) + "/extensions/PLIANT_haptic_device/id";
    const bool nothing = asked.used && asked.request.allowed.empty();
    for (const std::string& sentence : asked.request.refused)
      findings.push_back({nothing ? Severity::kError : Severity::kWarning, pointer,
                          "asks for more than a level may: " + sentence, device_cure(asked), "device.refused"});
    if (asked.used && !asked.request.allowed.empty())
      findings.push_back(
          {Severity::kNote, pointer, "asks for the device `" + asked.request.allowed + "`", {}, "device.asked"});
  }
}

// Scripts that are missing or contain no path.
void find_in_scripts(const Level& level, const fs::path& folder, Findings& findings) {
  ScriptLibrary scripts;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    const auto find = [&](const std::string& name, const char* key, bool reads) {
      const std::string pointer = pointer_of(level, i) + "/extensions/" + key;
      const auto error = [&](Error fault, const char* code) {
        if (!fault.where.empty()) fault.what = fault.where + ": " + fault.what;
        findings.push_back(finding_of(fault, pointer, code));
      };
      const Result<fs::path> file = confined_path(folder, name);
      if (!file) return error(file.error(), "script.place");
      if (!fs::is_regular_file(*file))
        return error({"", "names the script " + name + ", which does not exist"}, "script.missing");
      if (!reads) return;
      if (const Result<const Path*> script = scripts.read(*file, false); !script)
        error(script.error(), "script.unreadable");
    };
    if (node.motion && !node.motion->script.empty()) find(node.motion->script, "PLIANT_motion/script", false);
    if (node.effect && !node.effect->path.empty())
      find(node.effect->path, "PLIANT_effect/path", node.effect->kind == EffectKind::kGuidance);
    if (node.device && !node.device->file.empty())
      find(node.device->file, "PLIANT_haptic_device/file", node.device->driver == DriverKind::kScript);
  }
}

// Tissue that can be simulated, but poorly.
void find_in_tissue(const Level& level, const World& world, Findings& findings) {
  for (auto [entity, soft_body] : world.registry.view<const SoftBody>()) {
    const std::string node = pointer_of(level, world, entity);  // clang 14 captures no structured bindings
    const TetMesh& tets = world.tet_meshes[soft_body.tets];
    for (const Note& note : tets.report.notes) findings.push_back(finding_of(note, Severity::kWarning, node));
    for (const Note& note : tets.report.findings) findings.push_back(finding_of(note, Severity::kWarning, node));
    if (const std::optional<Note> doubt = locking_doubt(soft_body, tets.tets.size()))
      findings.push_back(finding_of(*doubt, Severity::kWarning, node));
    if (tets.quality.smallest_dihedral < kSharp)
      findings.push_back({Severity::kWarning, node,
                          fmt::format("has a dihedral angle of {:.2g} degrees: steps may need more work",
                                      glm::degrees(tets.quality.smallest_dihedral)),
                          "mesh it again, or leave `mesh` out for a lattice", "tissue.sharp"});
  }
}

}  // namespace

Findings validate_level(const fs::path& path, const std::function<Status(World&)>& prepare,
                        std::optional<double> unit) {
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
    findings.push_back(finding_of(level.error(), level.error().pointer, "file.unreadable"));
    return findings;
  }
  for (std::size_t i = level->document_notes; i < level->notes.size(); ++i)  // those before are already in the findings
    findings.push_back({Severity::kNote, "", level->notes[i], {}, "file.note"});
  level->path = path;
  for (const Status& status : {check_unit(*level, unit), check_unit_said(*level, unit)})
    if (!status) findings.push_back(finding_of(status.error(), "", "mesh.unit"));
  if (any_error(findings)) return findings;
  scale_roots(*level, unit.value_or(1.0));
  const Findings of_level = validate_level(*std::move(level), prepare);
  findings.insert(findings.end(), of_level.begin(), of_level.end());
  return findings;
}

Findings validate_level(Level level, const std::function<Status(World&)>& prepare, const std::atomic<bool>* stop) {
  Findings findings;
  const auto stopped = [stop] { return stop && *stop; };
  const bool bare = !level.has_pliant();
  if (bare) {
    findings.push_back({Severity::kNote,
                        "",
                        "has no Pliant extension: a bare mesh, touchable with defaults sized to its bounds",
                        {},
                        "level.bare"});
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
    findings.push_back(finding_of(fault.what, Severity::kError, pointer_of(level, fault.node)));
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
    if (!panorama) {
      Error error = panorama.error();
      if (!error.where.empty()) error.what = error.where + ": " + error.what;
      findings.push_back(finding_of(error, pointer, "panorama.unreadable"));
    }
    for (const std::string& note : notes) findings.push_back({Severity::kNote, pointer, note, {}, "panorama.note"});
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
