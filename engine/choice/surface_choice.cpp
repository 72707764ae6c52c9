// Chooses the shape and width of a surface's dent and its distance function, by presses of the touch tick.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "content/keys/enum_words.h"
#include "engine/choice/choice_parts.h"
#include "engine/choice/press_bench.h"
#include "engine/choice/surface_cost.h"

namespace pliant {
namespace {

constexpr double kDepths[] = {0.2, 0.5};              // [1] of the punch's radius, in turn
constexpr double kReaches[] = {3.0, 5.0, 8.0, 12.0};  // [1] of the punch's radius
constexpr double kContacts[] = {1.0, 1.5, 2.0};  // [1] likewise: a window that brings a shape to zero makes it narrower
constexpr double kGpuAgrees = 1.9e-7;            // [1] of the largest height, as measured (bench/results/README.md)
constexpr double kBytes = 16.0;                  // per awake vertex, for drawing a field that is on the CPU

struct SurfaceModel {
  Shape shape;
  Distance distance;
  double reach, contact;  // [m]; contact 0: the shape has none, or a fifth of the reach
  double bulge;           // [m] largest bulge of curved patches on the mesh for this reach
};

// Keys that the author left open.
struct OpenKeys {
  std::vector<Shape> shapes;
  std::vector<Distance> ways;
  std::vector<double> reaches, contacts;  // [m]
};

OpenKeys open_keys(const LevelNode& node, const SurfaceTruth& truth) {
  const auto said = [&](const char* key) { return states(node, "deformable", key); };
  const Deformable& its = *node.deformable;
  OpenKeys open;
  for (std::size_t i = 0; i < std::size(kShapeRows); ++i) open.shapes.push_back(static_cast<Shape>(i));
  if (said("shape") || said("volume"))
    open.shapes = {its.shape};
  else if (said("contact_radius"))
    std::erase_if(open.shapes, [](Shape shape) { return !depends_on_contact(shape); });
  open.ways = {Distance::kChord, Distance::kSurface};
  if (said("distance")) open.ways = {its.distance};
  if (said("reach"))
    open.reaches = {its.reach};  // 0: the usual one
  else
    for (const double share : kReaches) open.reaches.push_back(share * truth.radius());
  if (said("contact_radius"))
    open.contacts = {its.contact_radius};
  else
    for (const double share : kContacts) open.contacts.push_back(share * truth.radius());
  return open;
}

// Models that share a mesh: it is refined for the reach, and for the contact radius of shapes that have one.
struct Meshed {
  double reach, contact;  // [m]
  std::vector<Shape> shapes;
};
std::vector<Meshed> meshes_of(const OpenKeys& open, double diagonal) {
  std::vector<Shape> depending, others;
  for (const Shape shape : open.shapes) (depends_on_contact(shape) ? depending : others).push_back(shape);
  std::vector<Meshed> meshes;
  for (const double said : open.reaches) {
    const double reach = said > 0.0 ? said : kDefaultReach * diagonal;
    for (const double contact : open.contacts)
      if (!depending.empty() && contact <= kMostContactShare * reach) meshes.push_back({reach, contact, depending});
    if (!others.empty()) meshes.push_back({reach, 0.0, others});
  }
  return meshes;
}

std::string label_of(const SurfaceModel& it) {
  std::string label =
      fmt::format("shape {}, distance {}, reach {:.3g} mm", word_of(it.shape), word_of(it.distance), 1e3 * it.reach);
  if (depends_on_contact(it.shape))
    label += it.contact > 0.0 ? fmt::format(", contact {:.3g} mm", 1e3 * it.contact) : ", contact a fifth of it";
  return label;
}

// Empty if no place could be pressed.
std::optional<ModelCandidate> measure(PressBench& bench, const SurfaceModel& model, const SurfaceTruth& truth) {
  Deformable& its = bench.surface();
  its.shape = model.shape;
  its.contact_radius = model.contact;
  double off = 0.0, vertices = 0.0, ms = 0.0, count = 0.0;
  for (std::size_t k = 0; k < kPressPlaces; ++k) {
    const PressBench::Press press = bench.press(k, kDepths[k % 2] * truth.radius(), truth);
    if (!(press.size > 0.0)) continue;
    off += press.off / press.size;
    vertices += press.vertices;
    ms += press.ms;
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  const double vertex = shape_ns(model.shape) + (model.distance == Distance::kSurface ? kSurfaceNs : 0.0);
  return ModelCandidate{label_of(model), std::sqrt(off / count), kTickUs + 1e-3 * vertices / count * vertex, ms / count,
                        vertices / count};
}

// Remarks on aspects without cost or without a key.
void remark(double bulge, const SurfaceTruth& truth, ModelChoice& choice) {
  choice.remarks.push_back("truth: " + truth.words());
  choice.remarks.push_back(fmt::format(
      "patches: curved where the normals are not the facets' own, at most {:.2g} mm off them ({:.2g} of the punch's "
      "radius); flat ones would save less than a tenth of a tick, so there is no key and nothing to choose",
      1e3 * bulge, bulge / truth.radius()));
  const ModelCandidate& it = choice.tried[choice.chosen];
  choice.remarks.push_back(fmt::format(
      "field back end: the force is the CPU's with either, the heights of the two agree to {:.2g} of the largest, so "
      "that no budget distinguishes them; `run --field gpu` spares {:.2g} KB a picture here",
      kGpuAgrees, kBytes * 1e-3 * it.vertices));
}

}  // namespace

Result<ModelChoice> choose_surface(Level& level, std::size_t index, ChoiceProgress& progress) {
  LevelNode& node = level.nodes[index];
  ModelChoice choice{node.name, "surface", node.deformable->error, {}, 0, false, {}, {}};
  const auto say = [&] { progress.say("choosing a model for `" + node.name + "`"); };
  Level alone = level_alone(level, index);
  // The surface under a press does not depend on the law.
  alone.nodes[index].deformable->spring = SpringLaw::kLinear;
  const auto usual = spawn_level(alone);
  if (!usual) return usual.error();
  double diagonal = 0.0;
  for (auto [entity, its] : usual->registry.view<const Deformable>())
    diagonal = static_cast<double>(usual->meshes[its.mesh].box.diagonal());
  if (!(diagonal > 0.0)) return Error{node.name, "has an error budget but no surface to press", "leave out `error`"};
  const SurfaceTruth truth(level, index, diagonal);
  for (const char* key : {"shape", "volume", "distance", "spring", "response", "reach", "contact_radius"})
    if (states(node, "deformable", key)) choice.kept.emplace_back(key);

  const OpenKeys open = open_keys(node, truth);
  std::optional<PressPlaces> places;  // of the finest mesh, which comes first
  std::vector<std::pair<ModelCandidate, SurfaceModel>> tried;
  std::optional<PressBench> bench;
  for (const Meshed& of : meshes_of(open, diagonal)) {
    Deformable& asks = *alone.nodes[index].deformable;
    asks.reach = of.reach;
    asks.contact_radius = of.contact;
    asks.shape = of.shapes.front();
    auto made = PressBench::make(alone, places ? &*places : nullptr, 0.0);
    if (!made) return made.error();
    bench = std::move(made).value();
    if (!places) places = bench->places();
    for (const Distance distance : open.ways) {
      bench->surface().distance = distance;
      if (const Status ready = bench->prepare(); !ready) return ready.error();
      for (const Shape shape : of.shapes) {
        say();
        const SurfaceModel model{shape, distance, of.reach, of.contact, static_cast<double>(bench->mesh().tree.bulge)};
        if (const auto candidate = measure(*bench, model, truth)) tried.emplace_back(*candidate, model);
      }
    }
  }
  if (tried.empty()) return Error{node.name, "could not be pressed to measure an error", "leave out `error`"};
  const SurfaceModel taken = take_cheapest(choice, tried);
  remark(taken.bulge, truth, choice);
  for (const ChoosableKey& key : choosable_keys(level, index))
    if (!key.said && (key.key == "shape" || key.key == "distance" || key.key == "reach" ||
                      (key.key == "contact_radius" && depends_on_contact(taken.shape))))
      choice.keys.push_back(key);
  node.deformable->shape = taken.shape;
  node.deformable->distance = taken.distance;
  if (!states(node, "deformable", "reach")) node.deformable->reach = taken.reach;
  if (!states(node, "deformable", "contact_radius")) node.deformable->contact_radius = taken.contact;
  return choice;
}

}  // namespace pliant
