// The mouse in a played level. Mouse input comes from the interface, picks come from the picture. Both become poses of
// one probe (window/pointer.h) or tool (window/carrier.h), tick by tick. Called from three threads.
#pragma once

#include <mutex>
#include <optional>

#include "window/carrier.h"
#include "window/pointer.h"

namespace pliant {

class PlayHand {
 public:
  // The object under the mouse.
  enum class Over : std::uint8_t { kNothing, kTouchable, kBody, kTool };  // kBody: can be pressed and dragged

  // --- For the run's thread
  // `from` [m] world: the probe's position; empty: a position out of the way.
  void take_probe(const World& world, const Probe& probe, const Viewpoint& view, std::optional<dvec3> from = {});
  void take_tool(const World& world, Entity tool, dvec3 device);
  void watch_tool(const World& world, Entity tool);  // moves nothing until it is dragged
  bool takes() const;                                // the watched tool is being dragged: call take_tool()
  void let_go();                                     // stops moving anything
  bool has_any() const;
  // The device's target, `dt` [s] after the last call; empty: it moves nothing.
  std::optional<dvec3> update(double dt);
  ProbeHold probe_hold() const;  // of the moved probe

  // --- For the stage: of the picture drawn last
  void see(const std::optional<Picked>& seen, const ViewRay& ray);
  Entity holds() const;  // for PickQuestion::holds

  // --- For the interface
  Over over() const;
  void hold(bool held, bool pulls = false);
  void follow(const ViewRay& ray, const Viewpoint& view);  // while dragging a tool or body
  void wheel(int steps, const Viewpoint& view);            // changes the depth, or moves a tool away from the eye
  void stand(int steps);                                   // changes the depth without pressing
  bool pressing() const;
  double depth_goal() const;  // [m]

 private:
  mutable std::mutex mutex_;
  std::optional<Pointer> pointer_;
  std::optional<Carrier> carrier_;
  std::optional<Picked> seen_;
  bool watches_ = false, takes_ = false;
  dvec3 at_{0};  // [m] world, of a probe: it moves smoothly to the target
};

}  // namespace pliant
