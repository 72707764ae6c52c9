// pliant fit LEVEL --object NAME: a deformable surface (P1) fitted to the object's finite elements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>
#include <optional>

#include "components/kinematic.h"
#include "content/author/object_frame.h"
#include "content/author/touchable.h"
#include "content/level/spawn_soft.h"
#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/console/print.h"
#include "lab/console/progress.h"
#include "lab/files/output_folder.h"
#include "lab/fit/fit.h"
#include "lab/fit/fit_level.h"
#include "lab/fit/press_bodies.h"
#include "lab/fit/surface_check.h"
#include "lab/fit/tissue_fit.h"
#include "lab/study/pareto.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr std::size_t kMapPlaces = 256;      // most places at which the stiffness map is computed
constexpr int kDepths = 4;                   // steps in which a press reaches its depth, a quarter of the reach
constexpr std::ptrdiff_t kEnoughPlaces = 6;  // least number of places away from edges, for law and shape
constexpr double kDeepestShare = 0.25;       // [1] of the reach
constexpr double kHardest = 6.0;             // [1] largest painted stiffness, relative to the usual one
constexpr double kSeenApart = 0.3;           // [1] of the indenter's radius: spacing of a dent's sample points
constexpr std::size_t kRefined = 4;          // number of places repeated with a finer lattice
constexpr double kFiner = 2.0 / 3.0;         // [1] cell size of the finer lattice

// Runs work at many places, in parallel if each place has its own body. Stops early on interruption.
class EachPlace {
 public:
  EachPlace(const PressBodies& bodies, const Interrupt& interrupt, Progress& progress)
      : bodies_(bodies), interrupt_(interrupt), progress_(progress) {}
  // Calls work(i, body) with the body to press at place i. Fails if a body cannot be made, if work fails, or on
  // interruption. `share` [1]: of the total work.
  Status operator()(const std::vector<PressPlace>& places, PressKind kind, double finer, double share,
                    const std::function<Status(std::size_t, TissuePress&)>& work) {
    std::mutex mutex;
    std::optional<Error> error;
    std::size_t done = 0;
    parallel_for(places.size(), bodies_.is_one() ? places.size() : 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        {
          const std::lock_guard lock(mutex);
          if (error || interrupt_.requested()) return;
        }
        auto body = bodies_.at(places[i], kind, finer);
        const Status worked = body ? work(i, **body) : Status(body.error());
        const std::lock_guard lock(mutex);
        if (!worked && !error) error = worked.error();
        progress_.update(so_far_ + share * static_cast<double>(++done) / static_cast<double>(places.size()));
      }
    });
    so_far_ += share;
    if (interrupt_.requested()) return interrupted("fit");
    if (error) return *error;
    return Done{};
  }

 private:
  const PressBodies& bodies_;
  const Interrupt& interrupt_;
  Progress& progress_;
  double so_far_ = 0.0;  // [1]
};

void compare(HeldPlace& held, const Mesh& mesh, double radius) {
  const std::vector<PressedTissue>& presses = held.truth.presses;
  const std::size_t count = std::min(presses.size(), held.model.size());
  if (count == 0) return;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double off = held.model[i].force / presses[i].force - 1;
    sum += off * off;
    held.force_worst = std::max(held.force_worst, std::abs(off));
  }
  held.force_error = std::sqrt(sum / static_cast<double>(count));
  const PressedTissue &truth = presses[count - 1], &model = held.model[count - 1];
  const SurfaceDifference d = surface_difference(held.truth.seen, model.height, truth.height);
  held.surface_error = d.size > 0 ? std::sqrt(d.off / d.size) : 0.0;
  held.surface_of_depth = d.area > 0 ? std::sqrt(d.off / d.area) / truth.depth : 0.0;
  const SurfaceDifference left = radial_remainder(held.truth.seen, held.truth.place, radius, truth.height);
  held.not_radial = left.area > 0 ? std::sqrt(left.off / left.area) / truth.depth : 0.0;
  held.near_edge = is_near_an_edge(mesh, held.truth.place, truth.depth);
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

template <class T>
T median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The mesh in the object frame, with these stiffness factors painted on the vertices of the file.
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

// Stiffness of a small press over the whole object, and where it may be pressed.
struct StiffnessMap {
  std::vector<double> at_vertex;     // [N/m]
  double usual = 0.0;                // [N/m] median over the places
  std::size_t places = 0, tets = 0;  // tets: median over the bodies
};
Result<StiffnessMap> map_stiffness(const PressBodies& bodies, EachPlace& each_place) {
  const Mesh& mesh = bodies.surface();
  std::vector<PressPlace> places;
  std::vector<std::uint32_t> one_of(mesh.vertex_count, kBorder);  // for each vertex, one triangle corner that uses it
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (one_of[mesh.triangles[t][i]] == kBorder) one_of[mesh.triangles[t][i]] = 3 * t + static_cast<std::uint32_t>(i);
  const std::vector<std::uint8_t> free = bodies.is_free(mesh, bodies.radius());
  for (const std::uint32_t v : farthest_vertices(mesh, kMapPlaces)) {
    if (one_of[v] == kBorder || !free[v]) continue;
    dvec3 corner(0);
    corner[static_cast<int>(one_of[v] % 3)] = 1.0;
    places.push_back(place_at(mesh, one_of[v] / 3, corner));
  }
  std::vector<double> stiffness(places.size());
  std::vector<std::size_t> tets(places.size());
  const Status pressed =
      each_place(places, PressKind::kSmall, 1.0, 0.4, [&](std::size_t i, TissuePress& body) -> Status {
        const auto punch = body.punch(mesh, places[i], bodies.radius());
        if (!punch) return punch.error();
        stiffness[i] = punch->stiffness();
        tets[i] = body.tets().tets.size();
        return Done{};
      });
  if (!pressed) return pressed.error();
  StiffnessMap out;
  std::vector<PressPlace> at;
  std::vector<double> value;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (stiffness[i] > 0) at.push_back(places[i]), value.push_back(stiffness[i]);
  if (at.empty())
    return Error{"--object " + mesh.name, "cannot be pressed anywhere: what is held leaves no surface free; see --pin"};
  out.usual = median(value);
  out.tets = median(tets);
  out.places = at.size();
  for (double& k : value) k = std::min(k, kHardest * out.usual);
  out.at_vertex = spread(bodies.object(), at, value);
  return out;
}

// Presses every place to this depth [m] in four steps.
Status press_all(const PressBodies& bodies, EachPlace& each_place, double depth, double share,
                 std::vector<PressedPlace>& places, const Mesh& mesh) {
  std::vector<PressPlace> at;
  for (const PressedPlace& each : places) at.push_back(each.place);
  const double radius = bodies.radius();
  return each_place(at, PressKind::kDeep, 1.0, share, [&](std::size_t i, TissuePress& body) -> Status {
    PressedPlace& each = places[i];
    const auto punch = body.punch(mesh, each.place, radius);
    if (!punch) return punch.error();
    each.stiffness = punch->stiffness();
    each.seen = samples_around(mesh, each.place, kAroundPress * radius, kSeenApart * radius);
    each.presses = body.press_to(*punch, each.seen, depth, kDepths);
    return Done{};
  });
}

// Richardson extrapolation: the excess stiffness of the elements from two lattices at the same places, with order two.
Status extrapolate(const PressBodies& bodies, EachPlace& each_place, const std::vector<PressedPlace>& places,
                   TissueFit& out) {
  std::vector<PressPlace> at;
  std::vector<double> coarse;
  for (std::size_t i = 0; i < places.size() && at.size() < kRefined;
       i += std::max<std::size_t>(1, places.size() / kRefined))
    if (!places[i].presses.empty()) at.push_back(places[i].place), coarse.push_back(places[i].stiffness);
  std::vector<double> share(at.size());
  const Status pressed =
      each_place(at, PressKind::kSmall, kFiner, 0.2, [&](std::size_t i, TissuePress& body) -> Status {
        const auto punch = body.punch(bodies.surface(), at[i], bodies.radius());
        if (!punch) return punch.error();
        const double fine = punch->stiffness();
        share[i] = coarse[i] / (fine - (coarse[i] - fine) * kFiner * kFiner / (1 - kFiner * kFiner));
        return Done{};
      });
  if (!pressed || at.empty()) return pressed;
  out.too_stiff = median(share);
  double squares = 0.0;
  for (const double each : share)
    squares += (each / out.too_stiff - 1) * (each / out.too_stiff - 1) / static_cast<double>(share.size());
  out.too_stiff_off = std::sqrt(squares);
  return Done{};
}

void divide_forces(std::vector<PressedPlace>& places, double by) {
  for (PressedPlace& each : places) {
    each.stiffness /= by;
    for (PressedTissue& press : each.presses) press.force /= by;
  }
}

// Sets the keys of the surface from the fitted places and the map.
void take_keys(const TissueFit& fitted, double usual, DeformableParameters& surface) {
  surface.young = 0.0;
  surface.thickness = 0.0;
  surface.spring = fitted.force.spring;
  surface.stiffness = fitted.force.factor * usual;
  if (reads_key(surface.spring, "cubic")) surface.cubic = fitted.force.curvature * surface.stiffness;
  if (reads_key(surface.spring, "stiffening")) surface.stiffening = fitted.force.curvature;
  surface.shape = fitted.shape.shape;
  surface.reach = fitted.shape.reach;
  surface.volume = fitted.shape.volume;
  surface.contact_radius = fitted.shape.contact;
}

// Presses places spread over the surface as deep as those in use: law and shape are fitted to them.
Status press_places(const PressBodies& bodies, EachPlace& each_place, const FitOptions& options,
                    std::vector<PressedPlace>& places, TissueFit& out) {
  const Mesh& mesh = bodies.surface();
  const double reach = options.reach > 0 ? options.reach : kUsualReach * out.radius;
  out.deepest = kDeepestShare * reach;
  const std::vector<std::uint8_t> free = bodies.is_free(mesh, reach);
  out.left_out = static_cast<std::size_t>(std::count(free.begin(), free.end(), 0));
  for (const PressPlace& place : scatter(mesh, options.points, 1, free)) places.push_back({place, 0.0, {}, {}});
  if (const Status done = press_all(bodies, each_place, out.deepest, 0.2, places, mesh); !done) return done;
  // Near an edge the surface law is not representative. Places there are used only if there are few others.
  const auto inner = std::stable_partition(places.begin(), places.end(), [&](const PressedPlace& each) {
    return each.presses.empty() || !is_near_an_edge(mesh, each.place, each.presses.back().depth);
  });
  if (inner - places.begin() >= kEnoughPlaces) places.erase(inner, places.end());
  out.places = places.size();
  return Done{};
}

// Compares finite elements and engine at the same held-out places.
Status compare_unseen(const Level& level, std::int32_t number, const FitOptions& options, const PressBodies& bodies,
                      EachPlace& each_place, const std::vector<Primitive>& primitives, TissueFit& out) {
  const LevelNode& node = level.nodes[static_cast<std::size_t>(number)];
  const double crease = node.deformable ? node.deformable->crease_angle : 0.0;
  Result<BuiltMesh> final_mesh = build_mesh(node.name, primitives, mat4(1.0f), {crease, dent_size(out.surface)});
  if (!final_mesh) return final_mesh.error();
  const Mesh& checked = final_mesh->mesh;
  const Pose pose = object_frame(level, number).pose;
  std::vector<PressedPlace> unseen;
  for (const PressPlace& place : scatter(
           checked, options.held, 2, bodies.is_free(checked, std::min(out.surface.reach, kUsualReach * out.radius))))
    unseen.push_back({place, 0.0, {}, {}});
  if (const Status done = press_all(bodies, each_place, out.deepest, 0.2, unseen, checked); !done) return done;
  divide_forces(unseen, out.too_stiff);
  auto model = press_surface(primitives, out.surface, checked, unseen);
  if (!model) return model.error();
  for (std::size_t i = 0; i < unseen.size(); ++i) {
    HeldPlace& held = out.held.emplace_back();
    held.side = side_of_normal(level, pose.rotation * unseen[i].place.normal);
    held.truth = std::move(unseen[i]);
    held.model = std::move((*model)[i]);
    compare(held, bodies.surface(), out.radius);
  }
  return Done{};
}

// The whole fit, without file output.
Result<TissueFit> fit_object(Level& level, std::int32_t number, const FitOptions& options, const Interrupt& interrupt) {
  Result<PressBodies> made = PressBodies::make(level, number, options);
  if (!made) return made.error();
  const PressBodies& bodies = *made;
  LevelNode& node = level.nodes[static_cast<std::size_t>(number)];
  TissueFit out;
  out.object = node.name;
  out.young = bodies.body().young;
  out.poisson = bodies.body().poisson;
  out.linear = options.linear;
  out.cell = bodies.cell();
  out.radius = bodies.radius();
  out.why = bodies.why();
  Progress progress("fit " + node.name);
  EachPlace each_place(bodies, interrupt, progress);

  Result<StiffnessMap> map = map_stiffness(bodies, each_place);
  if (!map) return map.error();
  out.mapped = map->places;
  out.tets = map->tets;
  if (const std::string doubt = locking_doubt(bodies.body(), out.tets); !doubt.empty())
    note("`" + node.name + "` " + doubt);

  std::vector<PressedPlace> places;
  if (const Status done = press_places(bodies, each_place, options, places, out); !done) return done.error();
  if (!bodies.is_one())
    if (const Status done = extrapolate(bodies, each_place, places, out); !done) return done.error();
  divide_forces(places, out.too_stiff);
  const double usual = map->usual / out.too_stiff;
  out.shape = fit_shape(places, out.radius, options.reach);
  out.force = fit_force(places);
  if (out.force.error > 1e29)
    return Error{"--object " + node.name, "gave way without a resting place at every press; try a larger --radius"};
  if (node.deformable) out.surface = *node.deformable;
  take_keys(out, usual, out.surface);
  out.deepest = std::min(out.deepest, kDeepestShare * out.surface.reach);
  std::vector<double> factor;
  for (const double k : map->at_vertex) factor.push_back(k / map->usual);
  const auto [softest, stiffest] = std::minmax_element(factor.begin(), factor.end());
  out.softest = *softest * out.surface.stiffness;
  out.stiffest = *stiffest * out.surface.stiffness;
  const mat4 to_object = mat4(object_frame(level, number).to_object);
  const std::vector<Primitive> primitives = painted_primitives(level.meshes[static_cast<std::size_t>(node.mesh)],
                                                               to_object, bodies.object().of_source, factor);

  if (const Status done = compare_unseen(level, number, options, bodies, each_place, primitives, out); !done)
    return done.error();

  // Writes the fit into the level.
  LevelMesh& own = own_mesh(level, number);
  for (std::size_t i = 0; i < own.primitives.size(); ++i) own.primitives[i].stiffness = primitives[i].stiffness;
  if (const Status done = make_touchable_surface(level, number, out.surface); !done) return done.error();
  return out;
}

}  // namespace

int fit_tissue(const FitOptions& options) {
  if (const Status out = check_out(options); !out) return fail(kUsage, out.error());
  Result<Level> level = level_to_fit(options.in, options.unit);
  if (!level) return fail(kFailed, level.error());
  const Result<std::int32_t> object = object_to_fit(*level, options.object);
  if (!object) return fail(kUsage, object.error());
  const Interrupt interrupt(kAllOrNothing);
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
  if (interrupt.requested()) return fail(kFailed, interrupted("fit"));
  if (!options.out.empty())
    if (const Status saved = save_fitted(*level, options); !saved) return fail(kFailed, saved.error());
  if (const Status placed = out->commit(); !placed) return fail(kFailed, placed.error());
  say(*fitted);
  if (!options.out.empty()) print("{}: a level\n", options.out);
  print("{}: {} files{}\n", out->shown().string(), out->written().size(),
        out->moved() ? " (the folder that was meant has results already, which stay; --force replaces them)" : "");
  return kDone;
}

}  // namespace pliant
