// The mouse in a played level. Mouse input comes from the interface, picks come from the picture; both become poses of
// one probe or tool (viewer/hand/mouse_hand.h), tick by tick. Called from three threads.
#pragma once

#include <mutex>
#include <optional>

#include "viewer/hand/mouse_hand.h"

namespace pliant {

class PlayHand {
 public:
  using Over = MouseHand::Over;

  // --- For the run's thread
  // `from` [m] world: the probe's position; empty: a position out of the way.
  void take_probe(const World& world, const Probe& probe, const Viewpoint& view, std::optional<dvec3> from = {});
  void take_tool(const World& world, Entity tool, dvec3 device);
  void watch_tool(Entity tool);  // moves nothing until it is dragged
  bool takes() const;            // the watched tool is being dragged: call take_tool()
  void let_go();                 // stops moving anything
  // The device's target, `dt` [s] after the last call; empty: it moves nothing.
  std::optional<dvec3> update(double dt);
  ProbeHold probe_hold() const { return hand()->probe_hold(); }  // of the moved probe

  // --- For the stage: of the picture drawn last
  void see(const std::optional<Picked>& seen, const ViewRay& ray) { hand()->see(seen, ray); }
  Entity holds() const { return hand()->holds(); }  // for PickQuestion::holds

  // --- For the interface
  Over over() const;
  bool hold(bool held, bool pulls = false);  // true: it grips what is under the mouse
  // While it grips.
  void follow(const ViewRay& ray, const Viewpoint& view) { hand()->follow(ray, view); }
  void wheel(double clicks, const Viewpoint& view) { hand()->wheel(clicks, view); }
  void stand(int steps) { hand()->stand(steps); }  // changes the depth without pressing
  bool pressing() const { return hand()->pressing(); }
  double depth_goal() const { return hand()->depth_goal(); }  // [m]

 private:
  struct Locked {
    std::unique_lock<std::mutex> lock;
    MouseHand& hand;
    MouseHand* operator->() { return &hand; }
  };
  Locked hand() const { return {std::unique_lock(mutex_), hand_}; }

  mutable std::mutex mutex_;
  mutable MouseHand hand_;
  Entity watched_ = kNoEntity;  // a tool that it takes when it is dragged
  bool takes_ = false;
  dvec3 at_{0};  // [m] world, of a probe: it moves smoothly to the target
};

}  // namespace pliant
