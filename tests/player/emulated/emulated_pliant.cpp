// The command `pliant` with two emulated devices, a SpaceMouse and a DualSense: the drivers are the real ones, and the
// firmware is emulated behind their ports. The hand on each device lifts it, moves down onto the object below, slides,
// and repeats this; its clock starts at the first read. PLIANT_UNPLUG=FROM:TO [s] unplugs the SpaceMouse for that time.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include "devices/drivers/sony_pad.h"
#include "devices/drivers/spacemouse.h"
#include "player/verbs/command_line.h"
#include "tests/drivers/emulated_sony.h"
#include "tests/drivers/emulated_spacemouse.h"

namespace pliant {
namespace {

// [s] since a driver first read a report; 0 before.
double seconds(bool looks = false) {
  using Clock = std::chrono::steady_clock;
  static Clock::time_point began{};
  if (began == Clock::time_point{} && looks) began = Clock::now();
  return began == Clock::time_point{} ? 0.0 : std::chrono::duration<double>(Clock::now() - began).count();
}

// Deflection by the hand, as a share of the full one: x right, y up, z towards the user.
dvec3 deflection(double t) {
  const auto within = [t](double from, double to) { return t >= from && t < to; };
  if (within(0.3, 0.6)) return {0, 0.8, 0};   // 24 mm up
  if (within(0.6, 1.1)) return {0, -0.7, 0};  // and 35 mm down, into the object at the centre
  if (within(1.4, 4.5)) return {0.12 * std::sin(1.5 * (t - 1.4)), 0, 0.12 * std::cos(1.5 * (t - 1.4))};
  if (within(4.5, 4.9)) return {0, 0.8, 0};
  if (within(5.2, 5.7)) return {0, -0.7, 0};
  return {0, 0, 0};
}

struct Bench {
  std::mutex mutex;  // opened by one thread, read by another
  EmulatedSpaceMouse cap{false};
  EmulatedSony pad{SonyModel::kDualSense, false};
  double from = -1.0, to = -1.0;          // [s] the cap is unplugged
  double cap_said = 0.0, pad_said = 0.0;  // [s]
  bool cap_rests = true;

  bool unplugged(double t) const { return t >= from && t < to; }
  void run_cap(double t) {
    cap.hid.unplugged = unplugged(t);
    if (t - cap_said < 0.008) return;
    cap_said = t;
    const dvec3 d = deflection(t);
    if (cap.hid.unplugged || (d == dvec3(0) && cap_rests)) return;  // a cap at rest sends no reports
    cap_rests = d == dvec3(0);
    const auto counts = [](double share) { return static_cast<int>(350 * share); };
    cap.deflect({counts(d.x), counts(d.z), counts(-d.y), 0, 0, 0});
    cap.press(t > 1.4 && t < 3.0 ? 1 : 0);
  }
  void run_pad(double t) {
    if (t - pad_said < 0.004) return;
    const double dt = pad_said > 0.0 ? t - pad_said : 0.004;
    pad_said = t;
    const dvec3 d = deflection(t);
    EmulatedHold hold;
    hold.sticks = {d.x, d.z, 0.0, -d.y};
    hold.right = 0.35;
    hold.turning = {0.0, 0.0, 0.2 * std::cos(t)};
    pad.hold(hold, dt);
  }
};

Bench& bench() {
  static Bench one;
  return one;
}

// Runs the firmware up to the current time whenever the driver reads.
class BenchPort final : public PacketPort {
 public:
  BenchPort(EmulatedHid& hid, void (Bench::*run)(double)) : line_(hid), run_(run) {}
  Status send(std::span<const std::uint8_t> packet) override {
    const std::lock_guard lock(bench().mutex);
    return line_.send(packet);
  }
  Result<std::size_t> receive(std::span<std::uint8_t> into, double wait) override {
    const std::lock_guard lock(bench().mutex);
    (bench().*run_)(seconds(true));
    return line_.receive(into, wait);
  }
  Result<std::size_t> feature(std::uint8_t number, std::span<std::uint8_t> into) override {
    const std::lock_guard lock(bench().mutex);
    return line_.feature(number, into);
  }
  std::vector<std::uint8_t> descriptor() override { return line_.descriptor(); }

 private:
  EmulatedPort line_;
  void (Bench::*run_)(double);
};

Result<std::unique_ptr<PacketPort>> open_line(EmulatedHid& hid, void (Bench::*run)(double)) {
  const std::lock_guard lock(bench().mutex);
  if (&hid == &bench().cap.hid && bench().unplugged(seconds()))
    return Error{"emulated", "none is there; plug it in and switch it on"};
  hid.unplugged = false;
  return std::unique_ptr<PacketPort>(std::make_unique<BenchPort>(hid, run));
}

Status add_devices() {
  const auto listed = [](const char* driver, const char* name, DeviceCapabilities can) {
    return [=] { return std::vector<DeviceInfo>{{driver, "emulated", name, "", can}}; };
  };
  const auto cap = [] {
    return make_spacemouse([](const std::string&) { return open_line(bench().cap.hid, &Bench::run_cap); });
  };
  const auto pad = [] {
    return make_sony_pad(SonyModel::kDualSense,
                         [](const std::string&) { return open_line(bench().pad.hid, &Bench::run_pad); });
  };
  if (Status s = register_driver("spacemouse", cap, listed("spacemouse", "SpaceMouse Compact", cap()->capabilities()));
      !s)
    return s;
  return register_driver("dualsense", pad, listed("dualsense", "DualSense", pad()->capabilities()));
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  if (const char* times = std::getenv("PLIANT_UNPLUG"))
    if (std::sscanf(times, "%lf:%lf", &pliant::bench().from, &pliant::bench().to) != 2) return 2;
  if (!pliant::add_devices()) return 2;
  return pliant::command_line(argc, argv);
}
