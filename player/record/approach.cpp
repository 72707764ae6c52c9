#include "player/record/approach.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "systems/touch/collide/surface_query.h"

namespace pliant {
namespace {

constexpr double kNear = 0.05;  // [1] of a surface's diagonal: a probe farther behind the surface is unrelated to it

double distance_to(const Box& box, dvec3 x) {
  if (box.empty()) return std::numeric_limits<double>::infinity();
  return length(glm::max(glm::max(dvec3(box.min) - x, x - dvec3(box.max)), dvec3(0)));
}

}  // namespace

std::vector<TouchableBox> touchable_boxes(const World& world) {
  std::vector<TouchableBox> boxes;
  for (auto [entity, deformable, pose] : world.registry.view<Deformable, Pose>())
    boxes.push_back({pose, world.meshes[deformable.mesh].box});
  return boxes;
}

void Approach::add(dvec3 position, const std::vector<TouchableBox>& boxes) {
  Place place{position, std::numeric_limits<double>::infinity()};
  for (const TouchableBox& each : boxes)
    place.bound = std::min(place.bound, distance_to(each.box, each.pose.to_local(position)));
  if (filled_ < stride_ && !places_.empty()) {
    if (place.bound < places_.back().bound) places_.back() = place;
    ++filled_;
    return;
  }
  if (places_.size() == kKept) {
    for (std::size_t i = 0; i < kKept / 2; ++i)
      places_[i] = places_[2 * i + 1].bound < places_[2 * i].bound ? places_[2 * i + 1] : places_[2 * i];
    places_.resize(kKept / 2);
    stride_ *= 2;
  }
  places_.push_back(place);
  filled_ = 1;
}

std::optional<Miss> find_miss(const World& world, const Approach& approach, double radius) {
  std::vector<Approach::Place> places = approach.places();
  std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.bound < b.bound; });
  std::optional<Miss> best;
  for (const Approach::Place& place : places) {
    // Farther places may still be behind a surface that was crossed.
    if (best && place.bound - radius >= std::max(best->distance, kNear * best->diagonal)) break;
    for (auto [entity, deformable, pose] : world.registry.view<Deformable, Pose>()) {
      const Mesh& mesh = world.meshes[deformable.mesh];
      const double diagonal = static_cast<double>(mesh.box.diagonal());
      const dvec3 x = pose.to_local(place.position);
      const SurfaceFoot foot = nearest(mesh, x, distance_to(mesh.box, x) + 2 * diagonal);
      if (!foot.valid()) continue;
      const double distance = std::max(0.0, length(x - foot.foot) - radius);
      const bool behind = foot.height < -1e-6 * diagonal && foot.height > -kNear * diagonal;
      if (best && !behind && distance >= best->distance) continue;
      const Name* name = world.registry.find<Name>(entity);
      best = Miss{name ? name->value : mesh.name, distance, diagonal, mesh.vertex_count, behind};
      if (behind) return best;
    }
  }
  return best;
}

Note explain_miss(const std::string& probe, const std::optional<Miss>& miss) {
  const std::string who = "probe `" + probe + "` never touched anything";
  if (!miss)
    return {who + ": the level has no deformable surface (PLIANT_deformable), and the probe met no soft or rigid body",
            "add one, or change the probe's path", kUntouched, probe};
  if (miss->behind)
    return {who + ", although it was below the surface of `" + miss->object +
                "`: it entered through a back face, or stayed inside another probe's dent",
            "approach from outside, or press deeper", kUntouched, probe};
  return {fmt::format("{}: its smallest distance was {:.4g} mm, to `{}` ({} vertices, {:.4g} mm across)", who,
                      miss->distance * 1e3, miss->object, miss->vertices, miss->diagonal * 1e3),
          "move its path there, and check the units of its path (metres) and of the mesh (`pliant inspect`)",
          kUntouched, probe};
}

}  // namespace pliant
