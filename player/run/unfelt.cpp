#include "player/run/unfelt.h"

#include <algorithm>
#include <vector>

#include "components/soft_body.h"
#include "systems/device/hands.h"

namespace pliant {
namespace {

constexpr float kNearShare = 0.1f;  // [1] of a surface's diagonal: a path that comes this near is meant to touch it
constexpr std::size_t kNamed = 5;   // bodies named in the sentence

struct UnfeltBody {
  std::string name;
  Pose pose;
  Box box;  // [m] object frame
};

std::string unfelt_name(const World& world, Entity entity) {
  const Name* name = world.registry.find<Name>(entity);
  return name ? name->value : std::string();
}

// Soft and rigid bodies that are not tools.
std::vector<UnfeltBody> bodies(const World& world) {
  std::vector<UnfeltBody> list;
  for (auto [entity, body, pose] : world.registry.view<SoftBody, Pose>())
    if (!world.registry.find<Handle6>(entity) && !world.registry.find<Deformable>(entity) &&
        body.collision_mesh.valid())
      list.push_back({unfelt_name(world, entity), pose, world.meshes[body.collision_mesh].box});
  for (auto [entity, body, pose] : world.registry.view<RigidBody, Pose>())
    if (!world.registry.find<Handle6>(entity) && !world.registry.find<Deformable>(entity) &&
        body.collision_mesh.valid())
      list.push_back({unfelt_name(world, entity), pose, world.meshes[body.collision_mesh].box});
  return list;
}

std::vector<UnfeltBody> surfaces(const World& world) {
  std::vector<UnfeltBody> list;
  for (auto [entity, deformable, pose] : world.registry.view<Deformable, Pose>()) {
    Box box = world.meshes[deformable.mesh].box;
    const vec3 margin(kNearShare * box.diagonal());
    box.min -= margin;
    box.max += margin;
    list.push_back({unfelt_name(world, entity), pose, box});
  }
  return list;
}

bool inside(const UnfeltBody& body, dvec3 x, double radius) {
  const dvec3 local = body.pose.to_local(x);
  for (int i = 0; i < 3; ++i)
    if (local[i] < static_cast<double>(body.box.min[i]) - radius ||
        local[i] > static_cast<double>(body.box.max[i]) + radius)
      return false;
  return true;
}

// Names, each once: "`a`, `b`".
class Names {
 public:
  void add(const std::string& name) {
    if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
  }
  std::size_t size() const { return names_.size(); }
  std::string list() const {
    std::string list;
    for (std::size_t i = 0; i < names_.size() && i < kNamed; ++i) list += (i ? ", `" : "`") + names_[i] + "`";
    return names_.size() > kNamed ? list + ", ..." : list;
  }

 private:
  std::vector<std::string> names_;
};

}  // namespace

std::optional<std::string> unfelt_bodies(const World& world) {
  const std::vector<UnfeltBody> felt = surfaces(world), unfelt = bodies(world);
  Names probes, passed;
  for (auto [entity, probe] : world.registry.view<Probe>()) {
    if (probe.meets != ProbeMeets::kSurfaces) continue;
    const std::string name = unfelt_name(world, entity);
    const auto pass = [&](const UnfeltBody& body) {
      probes.add(name);
      passed.add(body.name);
    };
    if (felt.empty())
      for (const UnfeltBody& body : unfelt) pass(body);
    const HapticDevice* device = find_device(world, entity);
    if (!device || !device->path.valid()) continue;
    const double radius = probe.radius;  // clang 14 cannot capture structured bindings
    const std::vector<PathRow>& rows = world.paths[device->path].rows;
    const auto enters = [&](const UnfeltBody& body) {
      return std::any_of(rows.begin(), rows.end(),
                         [&](const PathRow& row) { return inside(body, row.position, radius); });
    };
    if (std::any_of(felt.begin(), felt.end(), enters)) continue;
    for (const UnfeltBody& body : unfelt)
      if (enters(body)) pass(body);
  }
  if (probes.size() == 0) return {};
  const bool one = probes.size() == 1;
  return "the probe" + std::string(one ? " " : "s ") + probes.list() + (one ? " passes" : " pass") +
         " through soft and rigid bodies (here " + passed.list() + "), because " + (one ? "its" : "their") +
         " PLIANT_probe/meets is `surfaces`; set it to `all` or `bodies` where they shall be felt";
}

}  // namespace pliant
