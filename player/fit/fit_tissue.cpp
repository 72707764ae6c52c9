// pliant fit LEVEL --object NAME: a deformable surface (P1) from the object's finite elements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/kinematic.h"
#include "content/author/object_frame.h"
#include "content/author/touchable.h"
#include "content/level/spawn_soft.h"
#include "content/level_file.h"
#include "player/exit.h"
#include "player/fit/fit.h"
#include "player/fit/fit_level.h"
#include "player/fit/surface_check.h"
#include "player/fit/tissue_fit.h"
#include "player/interrupt.h"
#include "player/print.h"
#include "player/progress.h"
#include "player/record/output_folder.h"
#include "player/study/pareto.h"
#include "player/verbs/left_behind.h"

namespace pliant {
namespace {

constexpr std::size_t kTets = 16'000;        // aimed at
constexpr double kRadiusOverCell = 2.0;      // [1] what a press must span to be smooth
constexpr std::size_t kMapPlaces = 1000;     // at most, that the stiffness map is computed at
constexpr int kDepths = 4;                   // a quarter of the reach is gone to in so many parts
constexpr std::ptrdiff_t kEnoughPlaces = 6;  // away from edges, for law and shape
constexpr double kDeepestShare = 0.25;       // [1] of the reach
constexpr double kHardest = 3.0;             // [1] of the usual stiffness: beyond it lies what is held

// A body as its elements are made.
struct TissueBody {
  LevelNode node;  // with a soft body
  SoftParts parts;
  double cell = 0.0;
};

// The node as tissue, with what the options say instead of the level.
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
    return Error{"--object " + node.name,
                 "says no modulus: it is no soft body and has no `young`; say --young and --poisson"};
  if (options.young > 0) soft.young = options.young;
  if (options.poisson >= 0) soft.poisson = options.poisson;
  if (options.thickness > 0) soft.thickness = options.thickness, soft.fill = Fill::kWall;
  if (options.cell > 0) soft.cell = options.cell, soft.mesh.clear();
  if (const Status made = make_soft(copy, number, soft); !made) return made.error();
  if (options.pin.empty() && was_soft) return node;
  const std::string word = options.pin.empty() ? "bottom" : options.pin;
  node.soft_body->pinned = {};
  if (const Status pinned = pin(copy, number, *side_of(word)); !pinned) return pinned.error();
  if (options.pin.empty()) note(fmt::format("`{}` is taken to be held at its bottom; --pin says otherwise", node.name));
  return node;
}

Result<TissueBody> make_body(const Level& level, std::int32_t number, const FitOptions& options) {
  Result<LevelNode> node = tissue_node(level, number, options);
  if (!node) return node.error();
  TissueBody out{std::move(*node), {}, 0.0};
  const LevelMesh& mesh = level.meshes[static_cast<std::size_t>(out.node.mesh)];
  const mat4 to_object = mat4(object_frame(level, number).to_object);
  const auto make = [&]() -> Status {
    Result<SoftParts> parts = make_soft_parts(out.node, &mesh, to_object, level.path.parent_path());
    if (!parts) return parts.error();
    out.parts = std::move(*parts);
    return Done{};
  };
  if (const Status made = make(); !made) return made.error();
  if (out.node.soft_body->mesh.empty() && options.cell <= 0 && out.parts.tets.tets.size() < kTets) {
    out.node.soft_body->cell =
        out.parts.tets.report.cell * std::cbrt(static_cast<double>(out.parts.tets.tets.size()) / kTets);
    if (const Status made = make(); !made) return made.error();
  }
  const TetMesh& tets = out.parts.tets;
  double volume = 0.0;
  for (const Tet& t : tets.tets)
    volume += dot(cross(tets.nodes[t[1]] - tets.nodes[t[0]], tets.nodes[t[2]] - tets.nodes[t[0]]),
                  tets.nodes[t[3]] - tets.nodes[t[0]]) /
              6;
  // Twelve tetrahedra of a body-centred cubic lattice fill a cell.
  out.cell = tets.report.cell > 0 ? tets.report.cell : std::cbrt(12 * volume / static_cast<double>(tets.tets.size()));
  return out;
}

void compare(HeldPlace& held, const Mesh& mesh, double radius) {
  double sum = 0.0;
  const std::size_t count = std::min(held.truth.size(), held.model.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double off = held.model[i].force / held.truth[i].force - 1;
    sum += off * off;
    held.force_worst = std::max(held.force_worst, std::abs(off));
  }
  if (count == 0) return;
  held.force_error = std::sqrt(sum / static_cast<double>(count));
  const PressedTissue &truth = held.truth[count - 1], &model = held.model[count - 1];
  const SurfaceDifference d = surface_difference(mesh, held.place, kAroundPress * radius, model.height, truth.height);
  held.surface_error = d.size > 0 ? std::sqrt(d.off / d.size) : 0.0;
  held.surface_of_depth = d.area > 0 ? std::sqrt(d.off / d.area) / truth.depth : 0.0;
  const SurfaceDifference left = radial_remainder(mesh, held.place, radius, truth.height);
  held.not_radial = left.area > 0 ? std::sqrt(left.off / left.area) / truth.depth : 0.0;
  held.near_edge = is_near_an_edge(mesh, held.place, truth.depth);
}

Side side_of_normal(const Level& level, dvec3 world) {
  Side best = Side::kTop;
  double most = -2.0;
  for (const Side side : {Side::kBottom, Side::kTop, Side::kLeft, Side::kRight, Side::kFront, Side::kBack}) {
    const double along = dot(world, direction_of(level, side));
    if (along > most) most = along, best = side;
  }
  return best;
}

// The mesh in the object frame, with these factors painted on the vertices of the file.
std::vector<Primitive> painted_primitives(const LevelMesh& mesh, const mat4& to_object,
                                          const std::vector<std::uint32_t>& of_source,
                                          const std::vector<double>& factor) {
  std::vector<Primitive> out = mesh.primitives;
  std::size_t at = 0;
  const mat3 normals = glm::transpose(glm::inverse(mat3(to_object)));
  for (Primitive& primitive : out) {
    primitive.stiffness.assign(primitive.position.size(), 1.0f);
    for (std::size_t i = 0; i < primitive.position.size(); ++i, ++at) {
      if (at < of_source.size() && of_source[at] != kBorder)
        primitive.stiffness[i] = static_cast<float>(factor[of_source[at]]);
      primitive.position[i] = vec3(to_object * vec4(primitive.position[i], 1.0f));
      if (i < primitive.normal.size()) primitive.normal[i] = normalize(normals * primitive.normal[i]);
    }
    if (glm::determinant(mat3(to_object)) < 0)
      for (std::size_t i = 0; i + 2 < primitive.index.size(); i += 3)
        std::swap(primitive.index[i + 1], primitive.index[i + 2]);
  }
  return out;
}

// All but files.
Result<TissueFit> fit_object(Level& level, std::int32_t number, const FitOptions& options, const Interrupt& interrupt) {
  Result<TissueBody> body = make_body(level, number, options);
  if (!body) return body.error();
  const SoftBody& soft = *body->node.soft_body;
  if (const std::string doubt = locking_doubt(soft, body->parts.tets.tets.size()); !doubt.empty())
    note("`" + body->node.name + "` " + doubt);
  LevelNode& node = level.nodes[static_cast<std::size_t>(number)];
  const mat4 to_object = mat4(object_frame(level, number).to_object);
  const double crease = node.deformable ? node.deformable->crease_angle : 0.0;
  const auto build = [&](double reach) {
    return build_mesh(node.name, level.meshes[static_cast<std::size_t>(node.mesh)].primitives, to_object,
                      {crease, reach});
  };
  TissueFit out;
  out.object = node.name;
  out.young = soft.young;
  out.poisson = soft.poisson;
  out.linear = options.linear;
  out.tets = body->parts.tets.tets.size();
  out.cell = body->cell;
  out.radius = options.radius > 0 ? options.radius : kRadiusOverCell * body->cell;
  if (out.radius < 1.5 * body->cell)
    note(
        fmt::format("the indenter's radius, {:.3g} mm, spans fewer than 1.5 cells of {:.3g} mm: the elements are too "
                    "coarse for it; make --cell smaller",
                    out.radius * 1e3, body->cell * 1e3));
  Result<BuiltMesh> built = build(options.reach > 0 ? options.reach : 4 * out.radius);
  if (!built) return built.error();
  const Mesh& mesh = built->mesh;
  TissueMaterial material;
  material.young = soft.young;
  material.poisson = soft.poisson;
  material.strain = options.linear ? Strain::kLinear : Strain::kCorotational;
  Progress progress("fit " + node.name);
  Result<TissuePress> tissue = TissuePress::make(body->parts.tets, mesh, material);
  if (!tissue) return tissue.error();

  // How stiff a small press is, all over.
  std::vector<std::uint32_t> one_of(mesh.vertex_count, kBorder);  // a triangle of each vertex
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (one_of[mesh.triangles[t][i]] == kBorder) one_of[mesh.triangles[t][i]] = 3 * t + static_cast<std::uint32_t>(i);
  std::vector<std::uint32_t> at;
  std::vector<double> stiffness;
  const std::vector<std::uint32_t> wanted = farthest_vertices(mesh, kMapPlaces);
  for (const std::uint32_t v : wanted) {
    if (interrupt.requested()) return interrupted("fit");
    if (one_of[v] == kBorder) continue;
    dvec3 corner(0);
    corner[static_cast<int>(one_of[v] % 3)] = 1.0;
    const double k = tissue->stiffness(place_at(mesh, one_of[v] / 3, corner), out.radius);
    if (!(k > 0)) continue;
    at.push_back(v);
    stiffness.push_back(k);
    progress.update(0.3 * static_cast<double>(at.size()) / static_cast<double>(wanted.size()));
  }
  if (at.empty())
    return Error{"--object " + node.name, "cannot be pressed anywhere: what is held leaves no surface free; see --pin"};
  std::vector<double> sorted = stiffness;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (double& k : stiffness) k = std::min(k, 2 * kHardest * usual);
  const std::vector<double> map = spread(mesh, at, stiffness);
  std::vector<std::uint8_t> allowed(mesh.vertex_count);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    allowed[v] = map[v] < kHardest * usual;
    out.left_out += !allowed[v];
  }
  out.mapped = at.size();

  // Law and shape, from presses that are as deep as they will be used.
  std::vector<PressedPlace> places;
  double reach = options.reach > 0 ? options.reach : 4 * out.radius;
  for (const PressPlace& place : scatter(mesh, options.points, 1, allowed)) {
    if (interrupt.requested()) return interrupted("fit");
    places.push_back({place, tissue->stiffness(place, out.radius),
                      tissue->press_to(place, out.radius, kDeepestShare * reach, kDepths)});
    progress.update(0.3 + 0.4 * static_cast<double>(places.size()) / options.points);
  }
  // Near an edge the surface has no law of its own; those places count only where there are few others.
  const auto inner = std::stable_partition(places.begin(), places.end(), [&](const PressedPlace& each) {
    return each.presses.empty() || !is_near_an_edge(mesh, each.place, each.presses.back().depth);
  });
  if (inner - places.begin() >= kEnoughPlaces) places.erase(inner, places.end());
  out.places = places.size();
  out.shape = fit_shape(mesh, places, out.radius, options.reach);
  out.force = fit_force(places);
  if (out.force.error > 1e29)
    return Error{"--object " + node.name, "gave way without a resting place at every press; try a larger --radius"};
  DeformableParameters& surface = out.surface;
  if (node.deformable) surface = *node.deformable;
  surface.young = 0.0;
  surface.thickness = 0.0;
  surface.spring = out.force.spring;
  surface.stiffness = out.force.factor * usual;
  surface.cubic = out.force.spring == SpringLaw::kCubic ? out.force.curvature * surface.stiffness : surface.cubic;
  surface.stiffening = out.force.spring == SpringLaw::kExponential ? out.force.curvature : surface.stiffening;
  surface.shape = out.shape.shape;
  surface.reach = reach = out.shape.reach;
  surface.volume = out.shape.volume;
  surface.contact_radius = out.shape.contact;
  std::vector<double> factor;
  for (const double k : map) factor.push_back(k / usual);
  const auto [softest, stiffest] = std::minmax_element(map.begin(), map.end());
  out.softest = *softest * out.force.factor;
  out.stiffest = *stiffest * out.force.factor;
  const std::vector<Primitive> primitives =
      painted_primitives(level.meshes[static_cast<std::size_t>(node.mesh)], to_object, mesh.of_source, factor);

  // The same places in the elements and in the engine.
  Result<BuiltMesh> final_mesh = build_mesh(node.name, primitives, mat4(1.0f), {crease, reach});
  if (!final_mesh) return final_mesh.error();
  const Mesh& checked = final_mesh->mesh;
  tissue->embed_in(checked);
  std::vector<std::uint8_t> free(checked.vertex_count);
  for (std::uint32_t v = 0; v < checked.vertex_count; ++v)
    free[v] = checked.stiffness_factor.empty() || static_cast<double>(checked.stiffness_factor[v]) < kHardest;
  const Pose pose = object_frame(level, number).pose;
  std::vector<PressPlace> unseen;
  std::vector<std::vector<double>> depths;
  for (const PressPlace& place : scatter(checked, options.held, 2, free)) {
    if (interrupt.requested()) return interrupted("fit");
    HeldPlace held{place, side_of_normal(level, pose.rotation * place.normal), {}, {}};
    held.truth = tissue->press_to(place, out.radius, kDeepestShare * reach, kDepths);
    unseen.push_back(place);
    std::vector<double>& its = depths.emplace_back();
    for (const PressedTissue& press : held.truth) its.push_back(press.depth);
    out.held.push_back(std::move(held));
    progress.update(0.7 + 0.3 * static_cast<double>(out.held.size()) / options.held);
  }
  auto model = press_surface(primitives, surface, unseen, depths);
  if (!model) return model.error();
  for (std::size_t i = 0; i < out.held.size(); ++i) {
    out.held[i].model = std::move((*model)[i]);
    compare(out.held[i], checked, out.radius);
  }

  // Into the level.
  LevelMesh& own = own_mesh(level, number);
  for (std::size_t i = 0; i < own.primitives.size(); ++i) own.primitives[i].stiffness = primitives[i].stiffness;
  if (const Status made = make_touchable_surface(level, number, surface); !made) return made.error();
  return out;
}

}  // namespace

int fit_tissue(const FitOptions& options) {
  if (const Status out = check_out(options); !out) return fail(kUsage, out.error());
  Result<Level> level = level_to_fit(options.in, options.unit);
  if (!level) return fail(kFailed, level.error());
  const Result<std::int32_t> object = object_to_fit(*level, options.object);
  if (!object) return fail(kUsage, object.error());
  const Interrupt interrupt({"ending; press Ctrl-C again to quit at once", "quit at once; nothing was written"});
  const Result<TissueFit> fitted = fit_object(*level, *object, options, interrupt);
  if (!fitted) return fail(kFailed, fitted.error());
  auto out = OutputFolder::create(options.report.empty() ? "out/fit" : options.report, options.force);
  if (!out) return fail(kFailed, out.error());
  interrupt.remove_if_forced(out->staging());
  Status done = write_text(*out, "fit.json", json_of(*fitted, *level));
  if (done) done = write_text(*out, "fit_held_out.csv", places_csv(*fitted));
  if (done)
    done = draw_png_and_svg(out->stage("fit.png"), out->stage("fit.svg"), 1600, 800,
                            [&](Pen& pen) { draw(pen, *fitted); });
  if (!done) return fail(kFailed, out->at_place(done.error()));
  if (!options.out.empty()) {
    if (const Status saved =
            save_level(*level, options.out, {0, false, options.force ? Existing::kReplace : Existing::kRefuse});
        !saved)
      return fail(kFailed, saved.error());
    say_left_behind(*level, options.out);
  }
  if (const Status placed = out->commit(); !placed) return fail(kFailed, placed.error());
  say(*fitted);
  if (!options.out.empty()) print("{}: a level\n", options.out);
  print("{}: {} files{}\n", out->shown().string(), out->written().size(),
        out->moved() ? " (the folder that was meant has results already, which stay; --force replaces them)" : "");
  return kDone;
}

}  // namespace pliant
