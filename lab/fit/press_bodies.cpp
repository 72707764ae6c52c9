#include "lab/fit/press_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/author/object_frame.h"
#include "content/author/touchable.h"
#include "content/level/inner_sheet.h"
#include "content/level/spawn_soft.h"
#include "content/tets/tet_groups.h"
#include "content/tets/tet_quality.h"
#include "engine/choice/surface_truth.h"
#include "lab/console/print.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr double kCellsAcross = 2.0;   // cells per punch radius
constexpr double kFocusRadii = 5.0;    // [1] radius of the lattice's fine region, in punch radii
constexpr double kReachRadii = 4.0;    // [1] radius within which the surface is refined, in punch radii
constexpr std::size_t kTets = 16'000;  // target size of a single body for all places

// The node as tissue; options override the level's values.
Result<LevelNode> tissue_node(const Level& level, std::int32_t number, const FitOptions& options) {
  Level copy = level;
  LevelNode& node = copy.nodes[static_cast<std::size_t>(number)];
  const bool was_soft = node.soft_body.has_value();
  SoftBodyParameters soft;
  if (was_soft)
    soft = *node.soft_body;
  else if (node.deformable && node.deformable->young > 0)
    soft.young = node.deformable->young, soft.poisson = std::min(node.deformable->poisson, 0.49);
  else if (options.young < 0)
    return Error{"--object " + node.name, "says no modulus: it is no soft body and has no `young`",
                 "say --young and --poisson"};
  if (options.young > 0) soft.young = options.young;
  if (options.poisson >= 0) soft.poisson = options.poisson;
  if (options.thickness > 0) soft.thickness = options.thickness, soft.fill = Fill::kWall;
  if (options.cell > 0) soft.mesh.clear();
  if (const Status made = make_soft(copy, number, soft); !made) return made.error();
  if (options.pin.empty() && was_soft) return node;
  const std::string word = options.pin.empty() ? "bottom" : options.pin;
  node.soft_body->pinned = {};
  if (const Status pinned = pin(copy, number, *side_of(word)); !pinned) return pinned.error();
  if (options.pin.empty()) note(fmt::format("`{}` is taken to be held at its bottom; --pin says otherwise", node.name));
  return node;
}

// A body with cells of one size.
Result<TetMesh> even_body(LevelNode& node, const LevelMesh& mesh, const mat4& to_object, const Level& level,
                          const FitOptions& options) {
  if (options.cell > 0) node.soft_body->cell = options.cell;
  const auto make = [&] { return make_soft_parts(node, &mesh, to_object, level.path.parent_path()); };
  Result<SoftParts> parts = make();
  if (!parts) return parts.error();
  if (node.soft_body->mesh.empty() && options.cell <= 0 && parts->tets.tets.size() < kTets) {
    node.soft_body->cell =
        parts->tets.report.cell * std::cbrt(static_cast<double>(parts->tets.tets.size()) / static_cast<double>(kTets));
    parts = make();
    if (!parts) return parts.error();
  }
  return std::move(parts->tets);
}

// [m] Cell of the lattice, or of a lattice with as many tetrahedra: a body-centred cubic cell has twelve.
double cell_of(const TetMesh& tets) {
  if (tets.report.cell > 0) return tets.report.cell;
  return std::cbrt(12 * total_volume(tets) / static_cast<double>(tets.tets.size()));
}

}  // namespace

Result<PressBodies> PressBodies::make(const Level& level, std::int32_t number, const FitOptions& options) {
  Result<LevelNode> node = tissue_node(level, number, options);
  if (!node) return node.error();
  PressBodies out;
  out.node_ = std::move(*node);
  const SoftBody& soft = *out.node_.soft_body;
  out.material_.young = soft.young;
  out.material_.poisson = soft.poisson;
  out.material_.strain = options.linear ? Strain::kLinear : Strain::kCorotational;
  const LevelMesh& mesh = level.meshes[static_cast<std::size_t>(out.node_.mesh)];
  const ObjectFrame frame = object_frame(level, number);
  const mat4 to_object(frame.to_object);
  const UsualPunch usual =
      usual_punch(level, static_cast<std::size_t>(number), static_cast<double>(frame.box.diagonal()));
  out.radius_ = options.radius > 0 ? options.radius : usual.radius;
  out.why_ = options.radius > 0 ? "--radius" : usual.why;
  out.cell_ = options.cell > 0 ? options.cell : out.radius_ / kCellsAcross;
  if (!soft.mesh.empty() || soft.fill == Fill::kWall) {
    Result<TetMesh> tets = even_body(out.node_, mesh, to_object, level, options);
    if (!tets) return tets.error();
    out.cell_ = cell_of(*tets);
    if (options.radius <= 0) out.radius_ = kCellsAcross * out.cell_, out.why_ = "two cells";
    Result<TissuePress> press = TissuePress::make(std::move(*tets), out.material_, PressKind::kDeep);
    if (!press) return press.error();
    out.one_ = std::make_shared<TissuePress>(std::move(*press));
  }
  const std::optional<Deformable>& was = level.nodes[static_cast<std::size_t>(number)].deformable;
  const double crease = was ? was->crease_angle : 0.0;
  const double reach = options.reach > 0 ? options.reach : kReachRadii * out.radius_;
  Result<BuiltMesh> surface = build_mesh(out.node_.name, mesh.primitives, to_object, {crease, DentSize{reach, 0.0}});
  if (!surface) return surface.error();
  out.surface_ = out.object_ = std::make_shared<const BuiltMesh>(std::move(*surface));
  if (!out.one_)
    if (const Status done = out.leave_out_inner(mesh.primitives, to_object, {crease, DentSize{reach, 0.0}}); !done)
      return done.error();
  if (out.radius_ < 1.5 * out.cell_)
    note(
        fmt::format("the indenter's radius, {:.3g} mm, spans fewer than 1.5 cells of {:.3g} mm: the elements are too "
                    "coarse for it; make --cell smaller",
                    out.radius_ * 1e3, out.cell_ * 1e3));
  return out;
}

Status PressBodies::leave_out_inner(std::vector<Primitive> primitives, const mat4& to_object,
                                    const MeshOptions& options) {
  const Result<BuiltMesh> plain = build_mesh(node_.name, primitives, to_object, {options.crease_angle, {}});
  if (!plain) return plain.error();
  const InnerSheet sheet = find_inner_sheet(plain->mesh);
  if (!leave_out(sheet, plain->mesh, primitives)) return Done{};
  Result<BuiltMesh> outer = build_mesh(node_.name, primitives, to_object, options);
  if (!outer) return outer.error();
  note(
      fmt::format("`{}` is a wall of {:.3g} mm: its inside is taken to be filled, and nothing is pressed on its inner "
                  "sheet; --thickness makes it a wall",
                  node_.name, sheet.wall * 1e3));
  surface_ = std::make_shared<const BuiltMesh>(std::move(*outer));
  return Done{};
}

std::vector<std::uint8_t> PressBodies::is_free(const Mesh& mesh, double within) const {
  const Mesh& all = surface();
  std::vector<dvec3> position;
  for (std::uint32_t v = 0; v < all.vertex_count; ++v) position.emplace_back(all.position(v));
  const Result<std::vector<NodeGroup>> group =
      group_nodes(position, *surface_, *node_.soft_body, node_.handle ? &*node_.handle : nullptr);
  std::vector<std::uint8_t> out(mesh.vertex_count, 1);
  if (surface_ != object_ && &mesh != &all) {
    const InnerSheet sheet = find_inner_sheet(mesh);
    for (std::size_t t = 0; t < sheet.inner.size(); ++t)
      for (int c = 0; c < 3 && sheet.inner[t]; ++c) out[mesh.triangles[t][c]] = 0;
  }
  if (!group) return out;  // the pinned region lies between the surface's vertices
  std::vector<std::uint32_t> held;
  for (std::uint32_t v = 0; v < all.vertex_count; ++v)
    if ((*group)[v] != NodeGroup::kFree) held.push_back(v);
  parallel_for(out.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v)
      out[v] =
          out[v] && std::none_of(held.begin(), held.end(), [&](std::uint32_t h) {
            const vec3 away = mesh.position(v) - all.position(h);
            return dot(away, away) < static_cast<float>(within * within) && dot(mesh.normal(v), all.normal(h)) > 0.0f;
          });
  });
  return out;
}

Result<std::shared_ptr<TissuePress>> PressBodies::at(const PressPlace& place, PressKind kind, double share) const {
  if (one_) return one_;
  const dvec3 side = std::abs(place.normal.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 x = normalize(cross(side, place.normal));
  SoftBody body = *node_.soft_body;
  body.cell = share * cell_;
  Result<FilledBody> filled =
      make_tissue(*surface_, body, node_.handle ? &*node_.handle : nullptr,
                  LatticeFocus{place.position, kFocusRadii * radius_, dmat3(x, cross(place.normal, x), place.normal)});
  if (!filled) return filled.error();
  put_in_order(filled->tets, filled->group);
  Result<TissuePress> press = TissuePress::make(std::move(filled->tets), material_, kind);
  if (!press) return press.error();
  return std::make_shared<TissuePress>(std::move(*press));
}

}  // namespace pliant
