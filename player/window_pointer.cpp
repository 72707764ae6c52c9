#include "player/window_pointer.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/surface_query.h"

namespace pliant {
namespace {

constexpr double kStep = 0.05;  // [1] of the reach: one click of the wheel
constexpr int kFirstSteps = 4, kMostSteps = 12;
constexpr double kHover = 0.03;       // [1] of the scene's size: how high it hovers
constexpr double kPressTime = 0.12;   // [s] time constant of the way in
constexpr double kLiftTime = 0.05;    // [s] and out
constexpr double kRejoinTime = 0.08;  // [s] of the cursor to the hand

}  // namespace

void HeavyCursor::move_to(double x, double y) {
  if (!placed_) {
    x_ = x;
    y_ = y;
  } else {
    moved_x_ += x - hand_x_;
    moved_y_ += y - hand_y_;
  }
  placed_ = true;
  hand_x_ = x;
  hand_y_ = y;
}

void HeavyCursor::update(bool pressing, double force, double dt) {
  const double share = pressing ? gain(force) : 1.0;
  x_ += share * moved_x_;
  y_ += share * moved_y_;
  moved_x_ = moved_y_ = 0;
  if (pressing) return;
  const double rejoin = 1 - std::exp(-dt / kRejoinTime);
  x_ += rejoin * (hand_x_ - x_);
  y_ += rejoin * (hand_y_ - y_);
}

Pointer::Pointer(const World& world, double radius) : radius_(radius), deep_(kFirstSteps) {
  for (auto [entity, deformable, pose] : world.registry.view<Deformable, Pose>()) {
    const Mesh& mesh = world.meshes[deformable.mesh];
    targets_.push_back({&mesh, pose, deformable.reach});
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 local(corner & 1 ? mesh.box.max.x : mesh.box.min.x, corner & 2 ? mesh.box.max.y : mesh.box.min.y,
                       corner & 4 ? mesh.box.max.z : mesh.box.min.z);
      scene_.add(vec3(pose.to_world(dvec3(local))));
    }
  }
  size_ = scene_.empty() ? 1.0 : static_cast<double>(scene_.diagonal());
  hover_ = kHover * size_;
  height_ = hover_;
  away_ = 2 * size_;
  reach_ = targets_.empty() ? 0.1 * size_ : targets_.front().reach;
}

void Pointer::deepen(int steps) {
  deep_ = std::clamp(deep_ + steps, 1, kMostSteps);
}
void Pointer::stand(int steps) {
  standing_ = std::clamp(standing_ + steps, 0, kMostSteps);
}

double Pointer::depth_goal() const {
  return kStep * reach_ * (held_ ? std::max(deep_, standing_) : standing_);
}

std::optional<Pointer::Hit> Pointer::cast(const Ray& ray) const {
  std::optional<Hit> best;
  const double far = scene_.empty() ? 0.0 : length(dvec3(scene_.center()) - ray.from) + size_;
  const dvec3 to = ray.from + far * ray.along;
  for (const Target& target : targets_) {
    const Entry entry = first_entry(*target.mesh, target.pose.to_local(ray.from), target.pose.to_local(to));
    if (!entry.valid() || (best && entry.fraction * far >= best->distance)) continue;
    const SurfaceFoot p = surface_point(corners(*target.mesh, entry.triangle), entry.triangle, entry.barycentric, 0.0);
    best = Hit{target.pose.to_world(p.foot), target.pose.rotation * p.normal, entry.fraction * far, target.reach};
  }
  return best;
}

dvec3 Pointer::update(const Ray& ray, double dt) {
  const std::optional<Hit> hit = cast(ray);
  over_ = hit.has_value();
  if (hit) reach_ = hit->reach;
  const double goal = hit && pressing() ? -depth_goal() : hover_;
  const double time = goal < height_ ? kPressTime : kLiftTime;
  height_ += (1 - std::exp(-dt / time)) * (goal - height_);
  if (!hit) return ray.from + away_ * ray.along;  // the ray passes everything, so all of it is outside
  away_ = std::max(0.0, hit->distance - radius_ - hover_);
  return hit->point + (radius_ + height_) * hit->normal;
}

dvec3 Pointer::start(const Viewpoint& view) const {
  const dvec3 center = scene_.empty() ? view.target : dvec3(scene_.center());
  const dvec3 back = view.eye - center;
  return center + (0.55 * size_ + radius_) * (length(back) > 0 ? normalize(back) : dvec3(0, 0, 1));
}

}  // namespace pliant
