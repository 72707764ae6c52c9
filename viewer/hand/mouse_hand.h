// The mouse's hand in a level: it presses or pulls with a probe (pointer.h), or carries a tool (carrier.h).
#pragma once

#include "viewer/hand/carrier.h"
#include "viewer/hand/pointer.h"

namespace pliant {

class MouseHand {
 public:
  // Kind of the object under the mouse. kBody can be pressed and pulled.
  enum class Over : std::uint8_t { kNothing, kTouchable, kBody, kTool };
  enum class Grip : std::uint8_t { kNone, kPress, kPull, kCarry };

  void take(Pointer probe);
  void take(Carrier tool);
  void let_go();             // moves nothing from now on
  void begin(dvec3 device);  // a tool's device is taken where it is [m] world, before a press
  bool has_probe() const { return pointer_.has_value(); }
  bool has_tool() const { return carrier_.has_value(); }

  // The picked point of a ray; empty: background.
  void see(const std::optional<Picked>& seen, const ViewRay& ray);
  const std::optional<Picked>& seen() const { return seen_; }
  Over over() const;

  // Effect of a press on the point seen; `pulls`: pulls a body instead of pressing it. `tool_device` [m] world: where
  // the device of a tool is that has followed its path so far.
  Grip press(bool pulls, dvec3 tool_device);
  void release();
  Grip grip() const { return grip_; }
  // While gripping.
  void follow(const ViewRay& ray, const Viewpoint& view);
  void wheel(double clicks, const Viewpoint& view);  // depth of a press; pulls and carries away from the eye

  // Of a probe. stand() changes the depth that is kept without a press.
  void stand(int steps) {
    if (pointer_) pointer_->stand(steps);
  }
  bool free() const { return pointer_ && pointer_->free(); }                     // away from every surface
  double depth_goal() const { return pointer_ ? pointer_->depth_goal() : 0.0; }  // [m]
  Entity holds() const { return pointer_ ? pointer_->holds() : kNoEntity; }      // for PickQuestion::holds
  ProbeHold probe_hold() const { return pointer_ ? pointer_->probe_hold() : ProbeHold(); }
  // Of a tool; kNoEntity: none. Its device is taken once the mouse moves it.
  Entity tool() const { return carrier_ ? carrier_->tool() : kNoEntity; }
  Entity taken_device() const { return carrier_ ? carrier_->taken() : kNoEntity; }

  bool pressing() const { return (pointer_ && pointer_->pressing()) || (carrier_ && carrier_->holds()); }
  std::optional<dvec3> update(double dt);  // [m] world, target of the device; `dt` [s] since the last call

 private:
  std::optional<Pointer> pointer_;
  std::optional<Carrier> carrier_;
  std::optional<Picked> seen_;
  Grip grip_ = Grip::kNone;
};

}  // namespace pliant
