// Moves a tool with the mouse. While dragged, the tool's device follows the pointer in the plane that faces the eye;
// the wheel moves it away or nearer. Released, it stays. The device follows a jump of the pointer with limited speed,
// like a hand. A tool on a script or `orbit` follows its path until first dragged.
#pragma once

#include <optional>

#include "components/world.h"
#include "systems/device/mouse.h"
#include "viewer/hand/camera_control.h"

namespace pliant {

inline constexpr double kFastestCarry = kMouseFastest;  // [m/s]

class Carrier {
 public:
  // For the first tool (Handle6) whose device is the mouse, else for the first that follows a path; empty if there is
  // none. The device starts at the tool's pose.
  static std::optional<Carrier> of(World& world);

  // For this tool, whose device is at `at` [m] world.
  static Carrier holding(const World& world, Entity tool, dvec3 at);
  // For this tool, whose device follows something else until the mouse takes it.
  static Carrier waiting(const World& world, Entity tool, Entity device);

  Entity tool() const { return tool_; }
  // `point` [m] world, on the tool; `device` [m] world, where its device is.
  void grab(const dvec3& point, const dvec3& device);
  Entity taken() const { return follows_path_ ? kNoEntity : device_; }  // the device, once the mouse controls it
  void release();
  bool holds() const { return held_.has_value(); }
  void follow(const ViewRay& ray, const Viewpoint& view);
  void push(double clicks, const Viewpoint& view);  // > 0: away from the eye
  void update(double dt);                           // [s] since the last call; the device continues to its goal
  dvec3 position() const { return position_; }      // [m] world, of the device

 private:
  Entity tool_, device_;
  bool follows_path_ = false;      // by its path, not yet by the mouse
  double step_ = 0.01;             // [m] per click
  dvec3 position_{0}, wanted_{0};  // [m] world, of the device: current and wanted
  std::optional<dvec3> held_;      // [m] world, the point under the cursor
};

}  // namespace pliant
