#include "player/verbs/inspect_tets.h"

#include <numbers>

#include "content/level/soft_contact.h"
#include "content/level/soft_preview.h"
#include "content/level/spawn_soft.h"
#include "content/level_file.h"
#include "content/tets/lattice_errors.h"
#include "content/tets/step_cost.h"
#include "content/tets/tet_boundary.h"
#include "content/tets/tet_file.h"
#include "content/tets/tet_findings.h"
#include "content/tets/tet_parts.h"
#include "content/tets/tet_quality.h"
#include "lab/console/exit.h"
#include "lab/console/print.h"
#include "systems/soft/under_gravity.h"

namespace pliant {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;

OrderedJson describe(const TetMesh& mesh) {
  Box box;
  for (const dvec3& p : mesh.nodes) box.add(vec3(p));
  const auto corner = [](vec3 p) { return OrderedJson::array({p.x, p.y, p.z}); };
  return {{"name", mesh.name},
          {"nodes", mesh.node_count()},
          {"handle_nodes", mesh.handle_count},
          {"pinned_nodes", mesh.node_count() - mesh.pinned_begin()},
          {"tetrahedra", mesh.tets.size()},
          {"boundary_triangles", boundary_triangles(mesh.tets).size()},
          {"parts", count_parts(mesh)},
          {"cells", mesh.cells.size()},
          {"volume_m3", tissue_volume(mesh)},
          {"smallest_dihedral_deg", mesh.quality.smallest_dihedral * kDegrees},
          {"largest_dihedral_deg", mesh.quality.largest_dihedral * kDegrees},
          {"worst_ratio", mesh.quality.worst_ratio},
          {"median_ratio", mesh.quality.median_ratio},
          {"bounds_m", {{"min", corner(box.min)}, {"max", corner(box.max)}}},
          {"cell_m", mesh.report.cell},
          {"coarsest_cell_m", mesh.report.coarsest},
          {"wall_m", mesh.report.wall},
          {"parts_lost", mesh.report.parts_dropped},
          {"tissue_lost", mesh.report.volume_dropped},
          {"thin_share", mesh.report.thin},
          {"step_ms", step_ms(mesh.tets.size(), machine_slowness())}};
}

// "a cell of 2.1 cm, "; empty: from a file.
std::string cells_text(double cell, double coarsest) {
  if (!(cell > 0.0)) return "";
  if (!(coarsest > cell)) return "a cell of " + length_text(cell) + ", ";
  return "cells of " + length_text(cell) + " in its focus and up to " + length_text(coarsest) + " elsewhere, ";
}

// The level reduced to its tissue: other objects would cost time and add unrelated errors.
Level tissue_of(const Level& level) {
  Level bodies = level;
  bodies.environment.reset();
  std::vector<bool> only_drawn;
  for (const LevelNode& node : level.nodes) only_drawn.push_back(!node.has_pliant());
  for (std::size_t i = 0; i < bodies.nodes.size(); ++i) {
    LevelNode& node = bodies.nodes[i];
    node.probe.reset();
    node.device.reset();
    node.deformable.reset();
    node.rigid_body.reset();
    if (node.handle) node.handle->device.clear();
    if (node.soft_body) continue;
    node.handle.reset();
    if (!only_drawn[i]) node.mesh = -1;  // a mesh that is only drawn may lie inside tissue
  }
  return bodies;
}

// "split"; or "of the lattice", with the engine's reason if the level leaves it to the engine.
std::string contacts_of(const Level& level, std::size_t node, const SoftBody& body, const World& world) {
  const LevelNode& its = level.nodes[node];
  if (body.contact == SoftContact::kSplit || its.deformable) return "split";
  const TetMesh& tets = world.tet_meshes[body.tets];
  if (its.soft_body->contact != SoftContact::kAuto) return "of the lattice";
  std::string why = why_plain(level, its);
  if (why.empty()) why = why_plain(world.meshes[body.collision_mesh], tets, tets.pinned_begin() < tets.node_count());
  return "of the lattice: " + why;
}

}  // namespace

OrderedJson messages(const std::vector<Note>& notes) {
  OrderedJson list = OrderedJson::array();
  for (const Note& note : notes) list.push_back(note.message());
  return list;
}

OrderedJson describe_tissue(const Level& level) {
  OrderedJson list = OrderedJson::array();
  bool any = false;
  for (const LevelNode& node : level.nodes) any = any || (node.in_scene && node.soft_body);
  if (!any) return list;
  Result<World> world = spawn(tissue_of(level));
  if (!world) return OrderedJson::array({{{"problem", world.error().message()}}});
  begin_under_gravity(*world);
  find_sag(*world);
  for (auto [entity, body] : world->registry.view<const SoftBody>()) {
    const TetMesh& tets = world->tet_meshes[body.tets];
    OrderedJson tissue = describe(tets);
    tissue["contacts"] = contacts_of(level, entity.index, body, *world);
    tissue["mass_kg"] = body.density * tissue_volume(tets);
    if (const LatticeErrors errors = expected_errors(tets, world->meshes[body.collision_mesh], body.poisson);
        errors.across > 0.0) {
      tissue["across"] = errors.across;
      tissue["bending_error"] = errors.bending;
      tissue["torsion_error"] = errors.torsion;
      tissue["section_error"] = errors.section;
      tissue["contact_radius_m"] = errors.contact_radius;
      tissue["contact_error"] = errors.contact;
    }
    tissue["problems"] = messages(tets.report.notes);
    for (const Note& finding : tets.report.findings) tissue["problems"].push_back(finding.message());
    if (const std::optional<Note> doubt = locking_doubt(body, tets.tets.size()))
      tissue["problems"].push_back(doubt->message());
    list.push_back(std::move(tissue));
  }
  return list;
}

void print_tissue(const OrderedJson& tissue) {
  for (const OrderedJson& body : tissue) {
    if (body.contains("problem")) {
      print("  tissue: {}\n", body["problem"].get<std::string>());
      continue;
    }
    print(
        "  tissue {}: {} tetrahedra, {} nodes ({} on the handle, {} pinned), {} boundary triangles, {} part{}, {:.4g} "
        "m3\n",
        body["name"].get<std::string>(), body["tetrahedra"].get<std::size_t>(), body["nodes"].get<std::size_t>(),
        body["handle_nodes"].get<std::size_t>(), body["pinned_nodes"].get<std::size_t>(),
        body["boundary_triangles"].get<std::size_t>(), body["parts"].get<std::size_t>(),
        body["parts"].get<std::size_t>() == 1 ? "" : "s", body["volume_m3"].get<double>());
    print("    dihedral angles {:.1f} to {:.1f} degrees, 3 r/R {:.3f} at worst, {:.3f} at the median\n",
          body["smallest_dihedral_deg"].get<double>(), body["largest_dihedral_deg"].get<double>(),
          body["worst_ratio"].get<double>(), body["median_ratio"].get<double>());
    print("    {}about {:.2g} ms a soft step (an estimate)\n",
          cells_text(body["cell_m"].get<double>(), body["coarsest_cell_m"].get<double>()),
          body["step_ms"].get<double>());
    if (!body.contains("mass_kg")) continue;  // a file of tetrahedra alone has no density
    print("    {:.4g} kg", body["mass_kg"].get<double>());
    if (body.contains("across"))
      print(
          ", {:.1f} cells across at the median: its section {:+.0f} %, bending {:+.0f} %, torsion {:+.0f} %, plain "
          "contacts of {} {:+.0f} % of the stiffness (estimates)",
          body["across"].get<double>(), 1e2 * body["section_error"].get<double>(),
          1e2 * body["bending_error"].get<double>(), 1e2 * body["torsion_error"].get<double>(),
          length_text(body["contact_radius_m"].get<double>()), 1e2 * body["contact_error"].get<double>());
    print("\n    contacts {}\n", body["contacts"].get<std::string>());
    for (const OrderedJson& problem : body.value("problems", OrderedJson::array()))
      print("    {}\n", problem.get<std::string>());
  }
}

OrderedJson describe_as_tissue(const BuiltMesh& surface, const std::stop_token& stop) {
  const Result<SoftPreview> preview = preview_soft_body(surface, SoftBody{}, nullptr, stop);
  if (!preview && stop.stop_requested()) return nullptr;
  if (!preview) return {{"problem", preview.error().sentence()}};
  return {{"cell_m", preview->cell},
          {"nodes", preview->nodes.size()},
          {"tetrahedra", preview->tetrahedra},
          {"parts", preview->parts},
          {"parts_lost", preview->parts_lost},
          {"volume_m3", preview->volume},
          {"wall_m", preview->wall},
          {"smallest_dihedral_deg", preview->quality.smallest_dihedral * kDegrees},
          {"largest_dihedral_deg", preview->quality.largest_dihedral * kDegrees},
          {"worst_ratio", preview->quality.worst_ratio},
          {"step_ms", preview->step_ms},
          {"problems", messages(preview->notes)}};
}

void print_as_tissue(const OrderedJson& tissue) {
  if (tissue.is_null()) return;
  if (tissue.contains("problem")) {
    print("    as tissue: {}\n", tissue["problem"].get<std::string>());
    return;
  }
  print(
      "    as tissue: {} tetrahedra, a cell of {}, 3 r/R {:.3f} at worst, about {:.2g} ms a soft step (an estimate)\n",
      tissue["tetrahedra"].get<std::size_t>(), length_text(tissue["cell_m"].get<double>()),
      tissue["worst_ratio"].get<double>(), tissue["step_ms"].get<double>());
  for (const OrderedJson& problem : tissue["problems"]) print("      {}\n", problem.get<std::string>());
}

int inspect_tets(const std::filesystem::path& path, bool as_json) {
  Result<TetFile> file = load_tets(path);
  if (!file) return fail(kFailed, file.error());
  TetMesh mesh;
  mesh.name = path.stem().string();
  mesh.nodes = std::move(file->nodes);
  mesh.tets = std::move(file->tets);
  mesh.free_count = mesh.node_count();
  mesh.quality = measure_quality(mesh.nodes, mesh.tets);
  OrderedJson json = {{"file", path.string()}};
  json.update(describe(mesh));
  json["notes"] = file->notes;
  if (as_json) {
    print_json(json);
    return kDone;
  }
  print("{}\n", path.string());
  print_tissue(OrderedJson::array({json}));
  for (const std::string& sentence : file->notes) print("  note: {}\n", sentence);
  print("  tissue for a level: name it in PLIANT_soft_body/mesh; its boundary can be touched: `pliant run FILE`\n");
  return kDone;
}

}  // namespace pliant
