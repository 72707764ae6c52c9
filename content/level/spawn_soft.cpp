#include "content/level/spawn_soft.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/level/inner_sheet.h"
#include "content/level/soft_contact.h"
#include "content/mesh/mesh_finer.h"
#include "content/mesh/mesh_refine.h"
#include "content/tets/lattice.h"
#include "content/tets/lattice_inside.h"
#include "content/tets/surface_rays.h"
#include "content/tets/tet_boundary.h"
#include "content/tets/tet_embed.h"
#include "content/tets/tet_file.h"
#include "content/tets/tet_findings.h"
#include "content/tets/tet_groups.h"
#include "content/tets/tet_mass.h"
#include "content/tets/tet_parts.h"
#include "content/tets/tet_quality.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

// [mean edges of the tetrahedra] Tissue is touched through the vertices of its collision mesh. If they are farther
// apart, an object that presses between them moves distant vertices and sinks into the tissue below it.
constexpr double kLongestEdge = 2.0;
constexpr double kEdgeOfSplit = 0.5;    // of split contacts' dents, which are drawn
constexpr double kLeastEdge = 0.15;     // of a DentLaw's, however fine
constexpr double kEdgeOverCell = 0.91;  // [1] mean edge of the lattice's tetrahedra
constexpr double kLeastFocus = 0.01;    // [1] of the diagonal: smallest half diagonal used for the author's focus box
constexpr double kFocusOverBox = 2.0;   // [1] radius of the lattice's focus over half the diagonal of the author's box

// The tetrahedra of the body's file, in the object frame.
Result<TetMesh> read_tets(const std::string& name, const std::string& file, const mat4& to_object,
                          const std::filesystem::path& folder, SoftParts& parts) {
  Result<TetFile> read = load_named_tets(folder, file);
  if (!read) return read.error();
  parts.notes = std::move(read->notes);
  parts.groups = std::move(read->groups);
  const dmat4 m(to_object);
  TetMesh mesh;
  mesh.name = name;
  mesh.nodes = std::move(read->nodes);
  mesh.tets = std::move(read->tets);
  mesh.group = std::move(read->group);
  for (dvec3& p : mesh.nodes) p = dvec3(m * glm::dvec4(p, 1.0));
  if (glm::determinant(dmat3(m)) < 0.0)
    for (Tet& tet : mesh.tets) std::swap(tet[2], tet[3]);
  for (const Tet& tet : mesh.tets)
    if (!(tet_volume(mesh.nodes, tet) > 0.0))
      return Error{file, "has a tetrahedron without volume in the node's frame",
                   "give the node and its parents a scale other than 0"};
  put_in_order(mesh, {});
  return mesh;
}

constexpr double kSameBody = 0.25;  // [1] of volume: tetrahedra of a file and the surface drawn over them

// The tetrahedra of a file weigh what the surface over them encloses, unless that is another body.
void weigh(const Mesh& surface, TetMesh& mesh) {
  const MassProperties whole = mass_properties(surface);
  const double volume = total_volume(mesh);
  if (surface.closed && std::abs(whole.volume - volume) < kSameBody * volume) return match_mass(whole, mesh);
  mesh.report.notes.push_back(
      {surface.closed ? fmt::format("encloses {:.3g} m3, and its tetrahedra fill {:.3g}: these are what it weighs",
                                    whole.volume, volume)
                      : std::string("is an open surface over the tetrahedra of a file: these are what it weighs"),
       surface.closed ? "take the surface that the tetrahedra were made of, or leave its mesh out"
                      : "close it, or leave its mesh out",
       "tissue.weight",
       {}});
}

// [m] Mean over the edges of all tetrahedra.
double mean_edge(const TetMesh& mesh) {
  double sum = 0.0;
  for (const Tet& tet : mesh.tets)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = i + 1; k < 4; ++k) sum += length(mesh.nodes[tet[k]] - mesh.nodes[tet[i]]);
  return sum / static_cast<double>(6 * mesh.tets.size());
}

// [m] Of the surface's edges: tissue is touched through its vertices, and dents are drawn by them.
double longest_edge(const LevelNode& node, bool split, const Mesh& surface, double of_tets) {
  if (!split) return kLongestEdge * of_tets;
  if (!node.deformable) return kEdgeOfSplit * of_tets;
  const double dents = kEdgeOfReach * dent_size(*node.deformable).radius(surface);
  return of_tets * std::clamp(dents / of_tets, kLeastEdge, kEdgeOfSplit);
}

constexpr double kMostLost = 0.5;  // [1] of the tissue, in parts too small to keep

// The body is thinner than the cell and falls into small parts.
Error in_crumbs(const TetMesh& tets, const SoftBody& body, const Mesh& surface) {
  const TetReport& report = tets.report;
  const std::string cell = length_text(report.cell);
  const std::string what = fmt::format("falls into {} bits, which hold {:.0f} % of its tissue: ", report.parts_dropped,
                                       1e2 * report.volume_dropped);
  if (report.wall > 0.0 && body.fill == Fill::kWall)
    return {"mesh `" + tets.name + "`",
            what + fmt::format("a wall of {} is thinner than the cell of {}",
                               length_text(std::max(report.wall, body.thickness)), cell),
            fmt::format("fill the inside (\"fill\": \"solid\"), or give it a `thickness` of at least {}",
                        length_text(least_wall(surface, true))),
            kFillNote};
  return {"mesh `" + tets.name + "`", what + fmt::format("it is thinner than the cell of {}", cell),
          std::string("make `cell` smaller") + (body.fill == Fill::kWall ? ", or `thickness` larger" : "")};
}

// Cells within the author's box are at most 1.5 times as wide and 2.4 times as long as in its middle.
std::optional<LatticeFocus> focus_of(const SoftBody& body, const Mesh& surface) {
  if (body.focus.empty() || !body.mesh.empty()) return std::nullopt;
  const double half =
      std::max(0.5 * length(dvec3(body.focus.size())), kLeastFocus * static_cast<double>(surface.box.diagonal()));
  return LatticeFocus{dvec3(body.focus.center()), kFocusOverBox * half, dmat3(1.0)};
}
bool meet(const Box& a, const Box& b) {
  return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

// Mesh::of_source for the given primitives, from which the touched ones were refined. Each given primitive's vertices
// come first in its refined one. A primitive that was left out is in no triangle.
std::vector<std::uint32_t> given_sources(const std::vector<Primitive>& given, const std::vector<Primitive>& touched,
                                         const std::vector<std::uint32_t>& of_touched) {
  std::vector<std::uint32_t> out;
  std::size_t next = 0, first = 0;
  for (const Primitive& p : given) {
    const bool kept = next < touched.size() && touched[next].position.size() >= p.position.size() &&
                      std::equal(p.position.begin(), p.position.end(), touched[next].position.begin());
    for (std::size_t i = 0; i < p.position.size(); ++i) out.push_back(kept ? of_touched[first + i] : kBorder);
    if (kept) first += touched[next++].position.size();
  }
  return out;
}

Primitive boundary_primitive(const TetMesh& mesh) {
  Primitive p;
  p.position.assign(mesh.nodes.begin(), mesh.nodes.end());
  for (const uvec3& t : boundary_triangles(mesh.tets)) p.index.insert(p.index.end(), {t.x, t.y, t.z});
  return p;
}

}  // namespace

namespace {

// Where the tissue of each node is: the nodes of whole cells that lie outside stand for the surface next to them.
std::vector<dvec3> tissue_places(const TetMesh& mesh, const Mesh& surface) {
  std::vector<dvec3> places = mesh.nodes;
  if (mesh.cells.empty()) return places;
  const Inside inside(surface);
  parallel_for(places.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      if (!inside(places[n])) places[n] = closest_of(surface, places[n]).place;
  });
  return places;
}

Result<FilledBody> fill_body(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle,
                             const std::optional<LatticeFocus>& focus, const std::stop_token& stop) {
  Result<TetMesh> tets = fill_surface(surface.mesh, {body.cell, body.fill, body.thickness, stop, focus, body.elements});
  if (!tets) return tets.error();
  Result<std::vector<NodeGroup>> group = group_nodes(tissue_places(*tets, surface.mesh), surface, body, handle);
  if (!group) return group.error();
  FilledBody tissue{std::move(*tets), std::move(*group)};
  const std::uint32_t kept = drop_small_parts(tissue.tets, tissue.group);
  if (tissue.tets.report.volume_dropped > kMostLost) return in_crumbs(tissue.tets, body, surface.mesh);
  report_parts(kept, count_parts(surface.mesh), tissue.tets.report);
  if (std::find(tissue.group.begin(), tissue.group.end(), NodeGroup::kFree) == tissue.group.end())
    return Error{"PLIANT_soft_body", "has no free node: what is not pinned or on the handle was too small to keep"};
  return tissue;
}

}  // namespace

Result<FilledBody> make_tissue(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle,
                               const std::stop_token& stop) {
  if (!body.focus.empty() && !meet(body.focus, surface.mesh.box))
    return Error{"PLIANT_soft_body/focus", "lies beside the tissue, which reaches from " + text_of(surface.mesh.box),
                 "move its box"};
  return fill_body(surface, body, handle, focus_of(body, surface.mesh), stop);
}

Result<FilledBody> make_tissue(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle,
                               const LatticeFocus& focus, const std::stop_token& stop) {
  return fill_body(surface, body, handle, focus, stop);
}

std::optional<Note> locking_doubt(const SoftBody& body, std::size_t tetrahedra) {
  if (body.mesh.empty() && body.elements == Elements::kHexahedra) return std::nullopt;  // mean gradients do not lock
  const double bound = tetrahedra < kManyTets ? kLockingPoisson : kLockingPoissonOfMany;
  if (body.poisson < bound) return std::nullopt;
  return Note{fmt::format("has a Poisson's ratio of {:g}: from {:g} on its {} tetrahedra lock, and it is over 10 % too "
                          "stiff where it is pressed in",
                          body.poisson, bound, tetrahedra),
              "lower `poisson`, to 0.45 for instance, or make `cell` smaller",
              "tissue.locks",
              {}};
}

std::optional<Note> law_fault(const LevelNode& node) {
  if (!node.soft_body) return std::nullopt;
  const SoftBody& body = *node.soft_body;
  if (body.mesh.empty() && body.elements == Elements::kHexahedra && body.law != TissueLaw::kCorotational)
    return Note{"has a `law` for large strain, and hexahedra are co-rotational",
                "leave out `law`, or take `elements` `tetrahedra`", "level.law_of_hexahedra", node.name};
  if (!body.rigid.empty() && body.law != TissueLaw::kCorotational)
    return Note{"has `rigid` parts and a `law` for large strain, whose step would not be passive with them",
                "leave out one of them", "level.not_with_rigid", node.name};
  if (body.mesh.empty() && body.elements == Elements::kHexahedra && (body.fibres.young > 0.0 || !body.cavities.empty()))
    return Note{"has `fibres` or `cavities`, which are of tetrahedra", "leave out `elements` `hexahedra`",
                "level.not_of_hexahedra", node.name};
  if ((body.prony.count > 0 || body.fibres.young > 0.0) && contact_of(node) == SoftContact::kSplit)
    return Note{"has `prony` or `fibres`, and the analytic dent of `contact` `split` neither relaxes nor has fibres",
                "take `contact` `lattice` and no PLIANT_deformable", "level.not_with_split", node.name};
  if (body.integrator != StepMethod::kEuler &&
      (body.prony.count > 0 || body.fibres.young > 0.0 || !body.cavities.empty()))
    return Note{"has `prony`, `fibres` or `cavities`, which only the step of `integrator` `euler` takes",
                "leave out `integrator`", "level.not_with_integrator", node.name};
  return std::nullopt;
}

namespace {

// Keys that tissue with rigid parts cannot have.
std::optional<Note> rigid_fault(const LevelNode& node) {
  const SoftBody& body = *node.soft_body;
  if (body.rigid.empty()) return std::nullopt;
  for (std::size_t i = 0; i < body.rigid.size(); ++i) {
    const std::string& name = body.rigid[i].name;
    if (name.empty() || name == kHandlePart)
      return Note{"has a rigid part named `" + name + "`", "name it otherwise", "level.rigid_name", node.name};
    for (std::size_t k = 0; k < i; ++k)
      if (body.rigid[k].name == name)
        return Note{"has two rigid parts named `" + name + "`", "rename one", "level.rigid_name", node.name};
    if (body.rigid[i].box.empty())
      return Note{"has a rigid part `" + name + "` without a `box`", "give it one", "level.rigid_box", node.name};
  }
  const auto fault = [&](const char* what) {
    return Note{std::string("has `rigid` parts and ") + what, "leave out one of them", "level.not_with_rigid",
                node.name};
  };
  if (body.integrator != StepMethod::kEuler) return fault("an `integrator`, which only free tissue has");
  if (!body.cavities.empty()) return fault("`cavities`");
  if (contact_of(node) == SoftContact::kSplit) return fault("split contacts, which act on tissue alone");
  return std::nullopt;
}

}  // namespace

std::optional<Note> soft_fault(const LevelNode& node) {
  const auto fault = [&](const char* code, const char* what, const char* cure) {
    return Note{what, cure, code, node.name};
  };
  if (std::optional<Note> of_law = law_fault(node)) return of_law;
  if (std::optional<Note> of_rigid = node.soft_body ? rigid_fault(node) : std::nullopt) return of_rigid;
  if (node.soft_body && node.rigid_body)
    return fault("level.soft_and_rigid", "has both PLIANT_soft_body and PLIANT_rigid_body",
                 "keep one, or mark the rigid part with PLIANT_handle");
  if (node.rigid_body && node.deformable)
    return fault("level.rigid_and_deformable", "has both PLIANT_rigid_body and PLIANT_deformable",
                 "keep one, a deformable surface does not move");
  if (node.handle && node.soft_body && !node.soft_body->cavities.empty())
    return fault("level.cavities_of_tool", "has PLIANT_handle and `cavities`, which a tool's tissue does not have",
                 "leave out one of them");
  if (node.handle && !node.soft_body && !node.rigid_body)
    return fault("level.handle_of_nothing", "has PLIANT_handle but neither PLIANT_soft_body nor PLIANT_rigid_body",
                 "add what the handle holds, or remove it");
  if (node.handle && node.rigid_body && node.rigid_body->fixed)
    return fault("level.handle_of_fixed", "has PLIANT_handle on a rigid body that is `fixed`",
                 "remove `fixed`, so that a hand can move it, or remove the handle");
  if (node.soft_body && node.mesh < 0 && node.soft_body->mesh.empty())
    return fault("level.no_mesh", "has PLIANT_soft_body but neither a mesh nor a tetrahedra file",
                 "give the node a mesh, or name a file in `mesh`");
  if (node.rigid_body && node.mesh < 0)
    return fault("level.no_mesh", "has PLIANT_rigid_body but no mesh", "give the node a mesh, or remove the extension");
  return std::nullopt;
}

Result<SoftParts> make_soft_parts(const LevelNode& node, const LevelMesh* mesh, const mat4& to_object,
                                  const std::filesystem::path& folder) {
  const SoftBody& body = *node.soft_body;
  SoftParts parts;
  const auto build = [&](std::span<const Primitive> primitives, const mat4& frame) -> Status {
    Result<BuiltMesh> built = build_mesh(node.name, primitives, frame);
    if (!built) return built.error();
    parts.surface = std::move(*built);
    return Done{};
  };
  if (mesh)
    if (Status s = build(mesh->primitives, to_object); !s) return s.error();
  const Handle6* const handle = node.handle ? &*node.handle : nullptr;
  std::vector<NodeGroup> group;
  if (body.mesh.empty()) {
    Result<FilledBody> tissue = make_tissue(parts.surface, body, handle);
    if (!tissue) return tissue.error();
    parts.tets = std::move(tissue->tets);
    group = std::move(tissue->group);
  } else {
    Result<TetMesh> tets = read_tets(node.name, body.mesh, to_object, folder, parts);
    if (!tets) return tets.error();
    parts.tets = std::move(*tets);
    const Primitive boundary = boundary_primitive(parts.tets);
    if (!mesh)
      if (Status s = build({&boundary, 1}, mat4(1.0f)); !s) return s.error();
    if (mesh) weigh(parts.surface.mesh, parts.tets);
    parts.tets.quality = measure_quality(parts.tets.nodes, parts.tets.tets);
    Result<std::vector<NodeGroup>> grouped = group_nodes(parts.tets.nodes, parts.surface, body, handle);
    if (!grouped) return grouped.error();
    group = std::move(*grouped);
    report_parts(count_parts(parts.tets), count_parts(parts.surface.mesh), parts.tets.report);
  }
  const SoftContact contact = contact_of(node);
  const bool pinned = std::find(group.begin(), group.end(), NodeGroup::kPinned) != group.end();
  parts.split = contact == SoftContact::kSplit ||
                (contact == SoftContact::kAuto && why_plain(parts.surface.mesh, parts.tets, pinned).empty());
  if (mesh) {
    const std::optional<LatticeFocus> focus = focus_of(body, parts.surface.mesh);
    std::vector<Primitive> touched = mesh->primitives;
    const bool filled = parts.tets.report.wall > 0.0 && body.fill == Fill::kSolid;
    const bool outer = filled && leave_out(find_inner_sheet(parts.surface.mesh), parts.surface.mesh, touched);
    const double mean = focus ? kEdgeOverCell * parts.tets.report.cell : mean_edge(parts.tets);
    const double longest = longest_edge(node, parts.split, parts.surface.mesh, mean);
    const bool finer =
        refine(touched, to_object, [&](dvec3 at) { return focus ? longest * focus->width_at(at) : longest; });
    if (outer || finer) {
      if (Status s = build(touched, to_object); !s) return s.error();
      Mesh& surface = parts.surface.mesh;
      surface.of_source = given_sources(mesh->primitives, touched, surface.of_source);
    }
  }
  parts.tets.embedding = embed(parts.surface.mesh, parts.tets.nodes, parts.tets.tets);
  put_in_order(parts.tets, group);
  return parts;
}

}  // namespace pliant
