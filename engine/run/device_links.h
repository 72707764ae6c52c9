// The devices of a run: a driver for every probe and tool that one moves (devices/choose.h, engine/run/driver_link.h),
// opened before its clocks start, and written zero with the last of its ticks.
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
  // Opens what each hand with the driver `external` asks for by its `id`, and takes those of `held`; one without an id
  // is moved by nobody. Where the mouse is an alternative, it takes its place. `notes`: what is not as one might
  // expect.
  // Opening may take long (a name server, a maker's library): where `stop` becomes true it is given up, with an error,
  // and goes on on a thread of its own, so that the program must end at once (gave_up()).
  Status open(World& world, SimulatedHands& held, bool windowed, const std::function<bool()>& stop,
              std::vector<std::string>& notes);
  bool gave_up() const { return gave_up_; }
  bool any() const { return !links_.empty(); }
  bool any_real() const;  // and not only simulated hands
  // Before the run: whether simulated hands go by the wall's clock, or by the servo's periods.
  void use_clock(DeviceClock clock);
  bool moves(Entity hand) const;
  // Why they cannot run in virtual time, if one cannot.
  Status may_step() const;

  // --- Around a tick
  // Samples come in before it, forces leave after it; paused devices are let go. Outlives the runner.
  TickPart tick_part(World& world);
  // --- The thread's that started them
  // What is shown of each, and of the hands that none moves; `late_ticks` is left to the caller.
  void view(DevicesView& out);
  void order(const DeviceOrders& orders);
  void stop_all();  // no force until each is armed; from any thread
  // No sample has come of it that said where it is: nothing else that can be said of its probe helps.
  bool never_ready(Entity hand);
  // What became of each: transitions that a person should know of.
  std::vector<std::string> findings();

 private:
  struct Held {
    std::string name;
    Entity hand, device;
    DriverLink link;
    std::string id, called;                // "falcon:0|scale=2"; as people call it
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
