#include "editor/play/play_hand.h"

namespace pliant {

void PlayHand::take_probe(const World& world, double radius, const Viewpoint& view) {
  const std::lock_guard lock(mutex_);
  carrier_.reset();
  pointer_.emplace(world, radius, view);
}

void PlayHand::take_tool(const World& world, Entity tool, dvec3 device) {
  const std::lock_guard lock(mutex_);
  pointer_.reset();
  carrier_ = Carrier::holding(world, tool, device);
}

void PlayHand::let_go() {
  const std::lock_guard lock(mutex_);
  pointer_.reset();
  carrier_.reset();
}

bool PlayHand::has_any() const {
  const std::lock_guard lock(mutex_);
  return pointer_ || carrier_;
}

std::optional<dvec3> PlayHand::update(double dt) {
  const std::lock_guard lock(mutex_);
  if (pointer_) return pointer_->update(dt);
  if (!carrier_) return {};
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
  if (pointer_ && pointer_->over_touchable()) return Over::kTouchable;
  if (carrier_ && seen_ && seen_->object == carrier_->tool()) return Over::kTool;
  return Over::kNothing;
}

void PlayHand::hold(bool held) {
  const std::lock_guard lock(mutex_);
  if (pointer_) pointer_->hold(held);
  if (!carrier_) return;
  if (!held)
    carrier_->release();
  else if (seen_)
    carrier_->grab(seen_->point, carrier_->position());
}

void PlayHand::follow(const ViewRay& ray, const Viewpoint& view) {
  const std::lock_guard lock(mutex_);
  if (carrier_) carrier_->follow(ray, view);
}

void PlayHand::wheel(int steps, const Viewpoint& view) {
  const std::lock_guard lock(mutex_);
  if (pointer_) pointer_->deepen(steps);
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
