#include "viewer/hand/carrier.h"

#include <algorithm>

#include "components/soft_body.h"
#include "systems/visual/viewpoint.h"

namespace pliant {
namespace {

constexpr double kStepShare = 0.01;   // [1] of the scene's size per click of the wheel
constexpr double kLeastAlong = 0.05;  // [1] cosine: rays more parallel to the plane are ignored

double step_in(const World& world) {
  return kStepShare * std::max(1e-3, static_cast<double>(drawn_box(world, true).diagonal()));
}

}  // namespace

std::optional<Carrier> Carrier::of(World& world) {
  std::optional<Carrier> led;
  for (auto [entity, handle] : world.registry.view<Handle6>()) {
    const Entity named = handle.device.empty() ? entity : find_by_name(world, handle.device);
    HapticDevice* device = named == kNoEntity ? nullptr : world.registry.find<HapticDevice>(named);
    if (!device || (device->driver != DriverKind::kMouse && !device->path.valid())) continue;
    Carrier carrier;
    carrier.tool_ = entity;
    carrier.device_ = named;
    carrier.follows_path_ = device->driver != DriverKind::kMouse;
    if (carrier.follows_path_ && led) continue;
    carrier.step_ = step_in(world);
    if (const Pose* pose = world.registry.find<Pose>(entity)) {
      carrier.position_ = carrier.wanted_ = pose->position;
      if (!carrier.follows_path_) device->rotation = pose->rotation;
    }
    if (!carrier.follows_path_) return carrier;
    led = carrier;
  }
  return led;
}

Carrier Carrier::holding(const World& world, Entity tool, dvec3 at) {
  Carrier carrier;
  carrier.tool_ = tool;
  carrier.step_ = step_in(world);
  carrier.position_ = carrier.wanted_ = at;
  return carrier;
}

Carrier Carrier::waiting(const World& world, Entity tool, Entity device) {
  Carrier carrier = holding(world, tool, dvec3(0));
  carrier.device_ = device;
  carrier.follows_path_ = true;
  return carrier;
}

void Carrier::grab(const dvec3& point, const dvec3& device) {
  held_ = point;
  if (follows_path_) position_ = wanted_ = device;
  follows_path_ = false;
}

void Carrier::follow(const ViewRay& ray, const Viewpoint& view) {
  if (!held_) return;
  const dvec3 forward = normalize(view.target - view.eye);
  const double along = dot(ray.along, forward);
  if (along < kLeastAlong) return;
  const dvec3 now = ray.from + dot(*held_ - ray.from, forward) / along * ray.along;
  wanted_ += now - *held_;
  held_ = now;
}

void Carrier::push(double clicks, const Viewpoint& view) {
  const dvec3 way = clicks * step_ * normalize(view.target - view.eye);
  wanted_ += way;
  if (held_) *held_ += way;
}

void Carrier::release() {
  held_.reset();
  wanted_ = position_;
}

void Carrier::update(double dt) {
  const double most = kFastestCarry * std::min(dt, kMouseSlowestFrame);  // the touch clock travels this distance in the
                                                                         // same time
  const dvec3 way = wanted_ - position_;
  const double left = length(way);
  position_ = left > most ? position_ + way * (most / left) : wanted_;
}

}  // namespace pliant
