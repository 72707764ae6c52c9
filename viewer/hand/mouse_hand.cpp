#include "viewer/hand/mouse_hand.h"

#include <algorithm>
#include <cmath>

namespace pliant {

void MouseHand::take(Pointer probe) {
  let_go();
  pointer_ = std::move(probe);
}

void MouseHand::take(Carrier tool) {
  let_go();
  carrier_ = std::move(tool);
}

void MouseHand::let_go() {
  pointer_.reset();
  carrier_.reset();
  grip_ = Grip::kNone;
}

void MouseHand::begin(dvec3 device) {
  if (!carrier_) return;
  carrier_->grab(device, device);
  carrier_->release();
}

void MouseHand::see(const std::optional<Picked>& seen, const ViewRay& ray) {
  seen_ = seen;
  if (pointer_) pointer_->see(seen, ray);
}

MouseHand::Over MouseHand::over() const {
  if (pointer_ && pointer_->over_body()) return Over::kBody;
  if (pointer_ && pointer_->over_touchable()) return Over::kTouchable;
  return carrier_ && seen_ && seen_->object == carrier_->tool() ? Over::kTool : Over::kNothing;
}

MouseHand::Grip MouseHand::press(bool pulls, dvec3 tool_device) {
  const Over on = over();
  grip_ = Grip::kNone;
  if (on == Over::kBody && pulls) {
    grip_ = Grip::kPull;
    pointer_->grab();
  } else if (pointer_ && pointer_->over_touchable()) {
    grip_ = Grip::kPress;
    pointer_->hold(true);
  } else if (on == Over::kTool) {
    grip_ = Grip::kCarry;
    carrier_->grab(seen_->point, tool_device);
  }
  return grip_;
}

void MouseHand::release() {
  grip_ = Grip::kNone;
  if (pointer_) pointer_->hold(false);
  if (carrier_) carrier_->release();
}

void MouseHand::follow(const ViewRay& ray, const Viewpoint& view) {
  if (pointer_) pointer_->follow(ray, view);
  if (carrier_) carrier_->follow(ray, view);
}

void MouseHand::wheel(double clicks, const Viewpoint& view) {
  const int steps = std::max(1, static_cast<int>(std::lround(std::abs(clicks))));
  if (grip_ == Grip::kPress) pointer_->deepen(clicks > 0 ? steps : -steps);
  if (grip_ == Grip::kPull) pointer_->push(clicks, view);
  if (grip_ == Grip::kCarry) carrier_->push(clicks, view);
}

std::optional<dvec3> MouseHand::update(double dt) {
  if (pointer_) return pointer_->update(dt);
  if (!carrier_) return {};
  carrier_->update(dt);
  return carrier_->position();
}

}  // namespace pliant
