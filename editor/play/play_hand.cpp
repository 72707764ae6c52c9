#include "editor/play/play_hand.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// A picture may be late, and its point far from the last one. A jump would be treated as a device fault
// (systems/safety/safety.h), with zero force; so the speed is limited.
constexpr double kGlideTime = 0.015;   // [s] time constant towards the target
constexpr double kFastestFree = 8.0;   // [m/s] away from every surface
constexpr double kFastestSlide = 0.5;  // [m/s] in contact
constexpr double kSwingArc = 0.6;      // [1] of the remaining distance: height of the arc over obstacles

}  // namespace

void PlayHand::take_probe(const World& world, const Probe& probe, const Viewpoint& view, std::optional<dvec3> from) {
  const std::lock_guard lock(mutex_);
  carrier_.reset();
  watches_ = takes_ = false;
  pointer_.emplace(world, probe.radius, view, probe.meets);
  at_ = from.value_or(pointer_->update(0.0));
}

void PlayHand::take_tool(const World& world, Entity tool, dvec3 device) {
  const std::lock_guard lock(mutex_);
  pointer_.reset();
  carrier_ = Carrier::holding(world, tool, device);
  if (takes_ && seen_) carrier_->grab(seen_->point, device);
  watches_ = takes_ = false;
}

void PlayHand::watch_tool(const World& world, Entity tool) {
  const std::lock_guard lock(mutex_);
  pointer_.reset();
  carrier_ = Carrier::holding(world, tool, dvec3(0));
  watches_ = true;
  takes_ = false;
}

bool PlayHand::takes() const {
  const std::lock_guard lock(mutex_);
  return takes_;
}

void PlayHand::let_go() {
  const std::lock_guard lock(mutex_);
  pointer_.reset();
  carrier_.reset();
  watches_ = takes_ = false;
}

bool PlayHand::has_any() const {
  const std::lock_guard lock(mutex_);
  return pointer_ || (carrier_ && !watches_);
}

std::optional<dvec3> PlayHand::update(double dt) {
  const std::lock_guard lock(mutex_);
  if (pointer_) {
    const dvec3 to = pointer_->update(dt);
    const bool free = pointer_->free();
    dvec3 way = to - at_;
    if (free && seen_) way += kSwingArc * length(way) * seen_->normal;
    const double left = length(way), most = (free ? kFastestFree : kFastestSlide) * dt;
    at_ += way * std::min(1.0 - std::exp(-dt / kGlideTime), left > most ? most / left : 1.0);
    return at_;
  }
  if (!carrier_ || watches_) return {};
  carrier_->update(dt);
  return carrier_->position();
}

void PlayHand::see(const std::optional<Picked>& seen, const ViewRay& ray) {
  const std::lock_guard lock(mutex_);
  seen_ = seen;
  if (pointer_) pointer_->see(seen, ray);
}

PlayHand::Over PlayHand::over() const {
  const std::lock_guard lock(mutex_);
  if (pointer_ && pointer_->over_touchable()) return pointer_->over_body() ? Over::kBody : Over::kTouchable;
  if (carrier_ && seen_ && seen_->object == carrier_->tool()) return Over::kTool;
  return Over::kNothing;
}

ProbeHold PlayHand::probe_hold() const {
  const std::lock_guard lock(mutex_);
  return pointer_ ? pointer_->probe_hold() : ProbeHold();
}

Entity PlayHand::holds() const {
  const std::lock_guard lock(mutex_);
  return pointer_ ? pointer_->holds() : kNoEntity;
}

void PlayHand::hold(bool held, bool pulls) {
  const std::lock_guard lock(mutex_);
  if (pointer_ && held && pulls)
    pointer_->grab();
  else if (pointer_)
    pointer_->hold(held);
  if (!carrier_) return;
  if (watches_) {
    takes_ = held && seen_ && seen_->object == carrier_->tool();
    return;
  }
  if (!held)
    carrier_->release();
  else if (seen_)
    carrier_->grab(seen_->point, carrier_->position());
}

void PlayHand::follow(const ViewRay& ray, const Viewpoint& view) {
  const std::lock_guard lock(mutex_);
  if (pointer_) pointer_->follow(ray, view);
  if (carrier_) carrier_->follow(ray, view);
}

void PlayHand::wheel(int steps, const Viewpoint& view) {
  const std::lock_guard lock(mutex_);
  if (pointer_ && pointer_->pulls())
    pointer_->push(steps, view);
  else if (pointer_)
    pointer_->deepen(steps);
  if (carrier_) carrier_->push(steps, view);
}

void PlayHand::stand(int steps) {
  const std::lock_guard lock(mutex_);
  if (pointer_) pointer_->stand(steps);
}

bool PlayHand::pressing() const {
  const std::lock_guard lock(mutex_);
  return (pointer_ && pointer_->pressing()) || (carrier_ && carrier_->holds());
}

double PlayHand::depth_goal() const {
  const std::lock_guard lock(mutex_);
  return pointer_ ? pointer_->depth_goal() : 0.0;
}

}  // namespace pliant
