#include "viewer/hand/pointer.h"

#include <algorithm>
#include <cmath>

#include "components/soft_body.h"
#include "systems/visual/viewpoint.h"

namespace pliant {
namespace {

constexpr double kPointerStep = 0.05;  // [1] of the reach per click of the wheel
constexpr int kFirstSteps = 4, kMostSteps = 12;
constexpr double kHover = 0.03;       // [1] of the scene's size: height above the surface without contact
constexpr double kPressTime = 0.12;   // [s] time constant of pressing in
constexpr double kLiftTime = 0.05;    // [s] and of retracting
constexpr double kRejoinTime = 0.08;  // [s] time constant of the drawn cursor's return to the pointer
constexpr double kFromBehind = 0.5;   // [1] cosine between view direction and normal beyond which a sheet is seen from
                                      // behind
// [1] Of a body's diagonal: the equivalent of a surface's reach. A body deforms as a whole, a surface's dent is local.
constexpr double kBodyReach = 0.12;
constexpr double kLeastFacing = 0.05;  // [1] cosine: rays more parallel to the plane are ignored
constexpr double kPushShare = 0.01;    // [1] of the scene's size per click of the wheel, along the view
constexpr double kFirstAway = 0.55;    // [1] of the scene's size, from its centre: outside of everything

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

Pointer::Pointer(const World& world, double radius, const Viewpoint& view, ProbeMeets meets)
    : radius_(radius), deep_(kFirstSteps) {
  if (meets != ProbeMeets::kBodies)
    for (auto [entity, deformable] : world.registry.view<Deformable>()) targets_.push_back({entity, deformable.reach});
  if (meets != ProbeMeets::kSurfaces) add_bodies(world);
  const Box scene = drawn_box(world, true);
  if (!scene.empty()) size_ = static_cast<double>(scene.diagonal());
  hover_ = kHover * size_;
  height_ = hover_;
  reach_ = targets_.empty() ? 0.1 * size_ : targets_.front().reach;
  // On the side of the eye.
  const dvec3 center = scene.empty() ? view.target : dvec3(scene.center()), back = view.eye - center;
  aside_ = center + (kFirstAway * size_ + radius_) * (length(back) > 0 ? normalize(back) : dvec3(0, 0, 1));
  away_ = length(view.eye - aside_);
}

void Pointer::add_bodies(const World& world) {
  const auto add = [&](Entity entity, Handle<Mesh> mesh, bool moves) {
    if (!mesh.valid()) return;
    const double size = static_cast<double>(world.meshes[mesh].box.diagonal());
    targets_.push_back({entity, kBodyReach * size, true, moves ? entity : kNoEntity});
  };
  for (auto [entity, body] : world.registry.view<SoftBody>()) add(entity, body.collision_mesh, true);
  for (auto [entity, body] : world.registry.view<RigidBody>()) add(entity, body.collision_mesh, !body.fixed);
  // A vessel that protrudes from an organ cannot be pressed as a surface, but it can be dragged.
  for (auto [entity, carried] : world.registry.view<Carried>())
    if (world.registry.has<SoftBody>(carried.by)) targets_.push_back({entity, 0.0, true, carried.by});
}

void Pointer::hold(bool held) {
  held_ = held;
  note_pressed();
  if (held || !grip_) return;
  grip_.reset();
  hold_.body = kNoEntity;
}

void Pointer::note_pressed() {
  if (!pressing())
    pressed_ = kNoEntity;
  else if (pressed_ == kNoEntity && hit_ && hit_->is_body && hit_->reach > 0)
    pressed_ = hit_->object;
}

void Pointer::grab() {
  if (!over_body()) return;
  held_ = false;
  pressed_ = kNoEntity;
  grip_ = hit_->drawn;
  hold_ = {false, hit_->pulls, hit_->drawn, hold_.number + 1};
}

void Pointer::follow(const ViewRay& ray, const Viewpoint& view) {
  if (!grip_) return;
  const dvec3 forward = normalize(view.target - view.eye);
  const double along = dot(ray.along, forward);
  if (along >= kLeastFacing) grip_ = ray.from + dot(*grip_ - ray.from, forward) / along * ray.along;
}

void Pointer::push(double clicks, const Viewpoint& view) {
  if (grip_) *grip_ += clicks * kPushShare * size_ * normalize(view.target - view.eye);
}

ProbeHold Pointer::probe_hold() const {
  ProbeHold hold = hold_;
  hold.hovers = !grip_ && free();
  return hold;
}

void Pointer::deepen(int steps) {
  deep_ = std::clamp(deep_ + steps, 1, kMostSteps);
}
void Pointer::stand(int steps) {
  standing_ = std::clamp(standing_ + steps, 0, kMostSteps);
  note_pressed();
}

double Pointer::depth_goal() const {
  return kPointerStep * reach_ * (held_ ? std::max(deep_, standing_) : standing_);
}

void Pointer::see(const std::optional<Picked>& seen, const ViewRay& ray) {
  if (!seen) {
    hit_.reset();
    aside_ = ray.from + away_ * ray.along;  // this ray hits nothing, so its points are outside
    return;
  }
  const bool behind = dot(seen->normal, ray.along) > kFromBehind;
  hit_ = Hit{seen->rest, behind ? -seen->normal : seen->normal, 0.0, seen->object, kNoEntity, false, seen->point};
  for (const Target& target : targets_) {
    if (!(target.object == seen->object)) continue;
    hit_->is_body = target.is_body;
    hit_->pulls = target.pulls;
    if (!behind) hit_->reach = target.reach;
  }
  if (hit_->reach > 0) reach_ = hit_->reach;
  note_pressed();
  away_ = std::max(0.0, length(seen->rest - ray.from) - radius_ - hover_);
}

dvec3 Pointer::update(double dt) {
  if (grip_) {
    height_ = hover_;
    return *grip_;
  }
  const double goal = over_touchable() && pressing() ? -depth_goal() : hover_;
  const double time = goal < height_ ? kPressTime : kLiftTime;
  height_ += (1 - std::exp(-dt / time)) * (goal - height_);
  return hit_ ? hit_->point + (radius_ + height_) * hit_->normal : aside_;
}

}  // namespace pliant
