// The mouse in a level that is played: what the hand does comes from the interface, what stands under it from the
// picture, and both become poses of one probe (window/pointer.h) or tool (window/carrier.h) tick by tick. Calls come
// from three threads.
#pragma once

#include <mutex>
#include <optional>

#include "window/carrier.h"
#include "window/pointer.h"

namespace pliant {

class PlayHand {
 public:
  // What is under the mouse.
  enum class Over : std::uint8_t { kNothing, kTouchable, kBody, kTool };  // kBody: can be pressed, and pulled

  // --- The run's thread
  // `from` [m] world: where the probe is; nothing: where it is best out of the way.
  void take_probe(const World& world, const Probe& probe, const Viewpoint& view, std::optional<dvec3> from = {});
  void take_tool(const World& world, Entity tool, dvec3 device);
  void watch_tool(const World& world, Entity tool);  // moves nothing, until it is taken hold of
  bool takes() const;                                // what it watches has been taken hold of: call take_tool()
  void let_go();                                     // moves nothing from now on
  bool has_any() const;
  // Where the device should be, `dt` [s] after the last call; nothing: it moves nothing.
  std::optional<dvec3> update(double dt);
  ProbeHold probe_hold() const;  // of the probe that it moves

  // --- The stage's: of the picture drawn last
  void see(const std::optional<Picked>& seen, const ViewRay& ray);
  Entity holds() const;  // for PickQuestion::holds

  // --- The interface's
  Over over() const;
  void hold(bool held, bool pulls = false);
  void follow(const ViewRay& ray, const Viewpoint& view);  // of a tool that is held, a body that is pulled
  void wheel(int steps, const Viewpoint& view);            // deeper, or a tool away from the eye
  void stand(int steps);                                   // deeper without holding
  bool pressing() const;
  double depth_goal() const;  // [m]

 private:
  mutable std::mutex mutex_;
  std::optional<Pointer> pointer_;
  std::optional<Carrier> carrier_;
  std::optional<Picked> seen_;
  bool watches_ = false, takes_ = false;
  dvec3 at_{0};  // [m] world, of a probe: it glides after what is pointed at
};

}  // namespace pliant
