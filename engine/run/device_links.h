// The devices of a run: one driver for every probe and tool that a device moves (devices/choose.h,
// engine/run/driver_link.h). Opened before the run's clocks start; zero force is written after its last tick.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "components/world.h"
#include "engine/run/device_view.h"
#include "engine/run/driver_link.h"
#include "engine/run/runner.h"
#include "engine/run/simulated_hands.h"

namespace pliant {

class DeviceLinks {
 public:
  // Opens the device that each hand with the driver `external` requests by its `id`, and those of `held`; without an id
  // no device moves the hand. If the mouse is an alternative, it is used instead. `notes`: anything unexpected. Opening
  // may take long (a name server, a vendor's library). If `stop` becomes true it returns an error while its thread
  // continues; the program must then end at once (gave_up()).
  Status open(World& world, SimulatedHands& held, bool windowed, const std::function<bool()>& stop,
              std::vector<std::string>& notes);
  bool gave_up() const { return gave_up_; }
  bool any() const { return !links_.empty(); }
  bool any_real() const;  // and not only simulated hands
  // Before the run: whether simulated hands follow the wall clock or the servo's periods.
  void use_clock(DeviceClock clock);
  bool moves(Entity hand) const;
  // Error if a device cannot run in virtual time.
  Status may_step() const;

  // --- Around a tick
  // Samples are read before it, forces written after it; paused devices are released. Must outlive the runner.
  TickPart tick_part(World& world);
  // --- Owner's thread
  // Fills the view of each device, and of the hands that no device moves; the caller sets `late_ticks`.
  void view(DevicesView& out);
  void order(const DeviceOrders& orders);
  void stop_all();  // zero force until each is armed; thread-safe
  // True if no sample of the device was ready: other findings about its probe are then irrelevant.
  bool never_ready(Entity hand);
  // Per device, transitions that the user should know of.
  std::vector<Note> findings();

 private:
  struct Held {
    std::string name;
    Entity hand, device;
    DriverLink link;
    std::string id, called;                // "falcon:0|scale=2"; display name
    SimulatedDevice* simulated = nullptr;  // in a simulated hand
  };
  Status start();
  void halt() noexcept;
  void begin(World& world, Held opened, dvec3 middle, std::vector<std::string>& notes);
  std::vector<Held> links_;
  std::vector<DevicesView::Other> others_;
  std::vector<DeviceInfo> unusable_;
  bool gave_up_ = false;
};

}  // namespace pliant
