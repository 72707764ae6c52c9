// The mouse as the hand that holds a tool: taken hold of, the tool's device follows the pointing hand in the plane that
// faces the eye, and the wheel pushes it away or pulls it nearer. Let go, it stays where it is. A pointer may jump, a
// hand does not: the device glides after it. A tool that a script or `orbit` leads is led until it is first taken hold
// of.
#pragma once

#include <optional>

#include "components/world.h"
#include "systems/device/mouse.h"
#include "window/camera_control.h"

namespace pliant {

inline constexpr double kFastestCarry = kMouseFastest;  // [m/s]

class Carrier {
 public:
  // Of the first tool (Handle6) whose device is the mouse, else of the first that follows a path; nothing where there
  // is none. The device begins where the tool stands.
  static std::optional<Carrier> of(World& world);

  // Of this tool, whose device stands at `at` [m] world.
  static Carrier holding(const World& world, Entity tool, dvec3 at);

  Entity tool() const { return tool_; }
  // `point` [m] world, on the tool; `device` [m] world, where its device is.
  void grab(const dvec3& point, const dvec3& device);
  Entity taken() const { return led_ ? kNoEntity : device_; }  // the device, once it is the mouse's
  void release();
  bool holds() const { return held_.has_value(); }
  void follow(const ViewRay& ray, const Viewpoint& view);
  void push(double clicks, const Viewpoint& view);  // > 0: away from the eye
  void update(double dt);                           // [s] since the last time; the device glides on
  dvec3 position() const { return position_; }      // [m] world, of the device

 private:
  Entity tool_, device_;
  bool led_ = false;               // by its path, not yet by the mouse
  double step_ = 0.01;             // [m] of a click
  dvec3 position_{0}, wanted_{0};  // [m] world, of the device: where it is, where the hand has it
  std::optional<dvec3> held_;      // [m] world, what is under the cursor
};

}  // namespace pliant
