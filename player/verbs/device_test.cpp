#include "player/verbs/device_test.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <thread>

#include "devices/believable.h"
#include "devices/choose.h"
#include "devices/drop_counter.h"
#include "devices/servo/claim.h"
#include "devices/servo/servo.h"
#include "devices/wrappers/chain.h"
#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/console/print.h"
#include "pliant/drivers.h"
#include "runtime/clock.h"

namespace pliant {
namespace {

constexpr double kRate = 1000.0;      // [Hz] of the loop in place of the touch clock
constexpr double kReportEvery = 0.1;  // [s] between two printed lines
constexpr double kPushForce = 0.5;    // [N] at most
constexpr double kPushShare = 0.15;   // [1] of the device's largest force, at most
constexpr double kPushSeconds = 1.0;  // [s] per direction along an axis: a half wave
constexpr int kPlaneWide = 41, kPlaneHigh = 11;

// The device under test, guarded if it is pushed.
class HeldDevice {
 public:
  Status open(const std::string& request, std::string& shown) {
    auto chosen = choose_device(request, list_devices());
    if (!chosen) return chosen.error();
    for (const std::string& sentence : chosen->notes) note(sentence);
    if (chosen->id.empty())
      return Error{"--test " + request, "the mouse needs no test", "name a device that `pliant devices` lists"};
    shown = chosen->name;
    auto made = make_device(chosen->id);
    if (!made) return made.error();
    if (Status s = claim_.take(chosen->id); !s) return s;
    if (Status s = made->driver->open(made->id); !s) return s;
    driver_ = std::move(made->driver);
    const DeviceCapabilities can = driver_->capabilities();
    if (const std::string wrong = beyond_belief(can); !wrong.empty())
      return Error{"device `" + chosen->id + "`", wrong};
    if (can.simulated || !renders(can))
      claim_.release();
    else if (Status s = claim_.take_opened(chosen->id, *driver_); !s)
      return s;
    if (wants_servo(can)) {
      auto served = std::make_unique<Servo>(std::move(driver_));
      servo_ = served.get();
      driver_ = std::move(served);
      servo_->adopt();
      if (Status s = servo_->start(); !s) return s;
      if (!servo_->note().empty()) note(servo_->note());
    } else if (const std::string sentence = watch_.start(*driver_, can); !sentence.empty()) {
      note(sentence);
    }
    return Done{};
  }
  ~HeldDevice() {
    if (!driver_) return;
    try {
      driver_->write({});
      if (servo_) servo_->halt();
      driver_->close();
    } catch (...) {  // the device's watchdog ends the force
    }
  }
  Driver& driver() { return *driver_; }
  // From the reading thread, or as the servo last reported.
  DroppedFrames dropped() { return servo_ ? servo_->report().dropped : dropped_frames(*driver_); }
  Servo* servo() { return servo_; }

 private:
  DeviceClaim claim_;
  std::unique_ptr<Driver> driver_;
  Servo* servo_ = nullptr;
  LineWatch watch_;  // without a servo
};

// x to the right, y up; z in a separate bar.
std::string plane(dvec3 at, dvec3 half) {
  const auto cell = [](double v, double most, int count) {
    return static_cast<int>(std::lround((std::clamp(v / most, -1.0, 1.0) + 1.0) * 0.5 * (count - 1)));
  };
  const int column = cell(at.x, half.x, kPlaneWide), row = kPlaneHigh - 1 - cell(at.y, half.y, kPlaneHigh),
            depth = kPlaneHigh - 1 - cell(at.z, half.z, kPlaneHigh);
  std::string out;
  for (int r = 0; r < kPlaneHigh; ++r) {
    out += "  |";
    for (int c = 0; c < kPlaneWide; ++c)
      out += r == row && c == column ? 'o' : r == kPlaneHigh / 2 && c == kPlaneWide / 2 ? '+' : ' ';
    out += "|  ";
    out += r == depth ? '=' : '|';
    out += r == 0 ? "  z: towards you\n" : r == kPlaneHigh - 1 ? "  z: away\n" : "\n";
  }
  return out;
}

std::string line_of(const DeviceSample& sample, const DeviceCapabilities& can, double rate, Servo* servo) {
  std::string line = fmt::format("  x {:7.1f}  y {:7.1f}  z {:7.1f} mm", 1e3 * sample.position.x,
                                 1e3 * sample.position.y, 1e3 * sample.position.z);
  if (can.senses_rotation) {
    const dvec3 turned = glm::degrees(glm::eulerAngles(sample.rotation));
    line += fmt::format("  turned {:4.0f} {:4.0f} {:4.0f} deg", turned.x, turned.y, turned.z);
  }
  if (can.senses_grip) line += fmt::format("  grip {:3.0f} %", 100 * sample.grip);
  line += fmt::format("  buttons {:x}  {:.0f} samples/s", sample.buttons, rate);
  if (sample.battery >= 0.0)
    line += fmt::format("  battery {:.0f} %{}", 100 * sample.battery, sample.charging ? ", charging" : "");
  if (sample.warnings & kDeviceBatteryLow) line += "  battery low";
  if (sample.warnings & kDeviceWarm) line += "  warm";
  if (servo) {
    const DeviceReport& report = servo->report();
    line += fmt::format("  {}  {:.2f} N", name_of(report.state), report.force);
  } else if (!sample.ready) {
    line += "  not ready";
  }
  return line;
}

// Reads and prints for `seconds`, or until interrupted; `force` is called every tick.
template <class Force>
void look(HeldDevice& held, double seconds, const Interrupt& interrupt, Force&& force) {
  const DeviceCapabilities can = held.driver().capabilities();
  const bool drawn = ::isatty(STDOUT_FILENO);
  dvec3 half = can.workspace;
  for (int i = 0; i < 3; ++i)
    if (!(half[i] > 0.0)) half[i] = 0.1;
  RealtimeClock clock(kRate);
  DeviceSample sample;
  std::uint64_t samples = 0, reported_samples = 0, not_ready = 0;
  double reported_at = 0.0;
  bool drew = false;
  while (!interrupt.requested()) {
    const Tick tick = clock.next();
    if (tick.time > seconds) break;
    if (held.driver().read(sample)) {
      ++samples;
      if (!sample.ready) ++not_ready;
    }
    held.driver().write({.force = force(tick.time)});
    if (tick.time - reported_at < (drawn ? kReportEvery : 1.0)) continue;
    const double rate = static_cast<double>(samples - reported_samples) / (tick.time - reported_at);
    if (drawn && drew)
      std::fputs(fmt::format("\033[{}A", kPlaneHigh + 1).c_str(), stdout);  // back over the last drawing
    if (drawn) std::fputs(plane(sample.position, half).c_str(), stdout);
    print("{}{}\n", line_of(sample, can, rate, held.servo()), drawn ? "    " : "");
    std::fflush(stdout);
    drew = true;
    reported_at = tick.time;
    reported_samples = samples;
  }
  held.driver().write({});
  const DroppedFrames dropped = held.dropped();
  if (const std::string frames = describe(dropped); !frames.empty())
    note(fmt::format("{} frames or lines were dropped: {}; {}", dropped.dropped(), frames, cure_for(dropped)));
  if (samples == 0)
    note("no sample arrived; is the device switched on, and free of other programs?");
  else if (not_ready > 0)
    note(
        fmt::format("{} of {} samples say that the device is not ready; calibrate or home it, release its emergency "
                    "stop, let it cool",
                    not_ready, samples));
}

bool confirmed(double most) {
  print("It will push with at most {:.2f} N along x, y and z, a second each. Hold it lightly, and type yes: ", most);
  std::fflush(stdout);
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "yes";
}

}  // namespace

int test_device(const DeviceTestOptions& options) {
  register_all_drivers();
  HeldDevice held;
  std::string name;
  if (Status s = held.open(options.id, name); !s) return fail(kFailed, s.error());
  print("{}; Ctrl-C ends the test\n", name);
  const Interrupt interrupt;
  const DeviceCapabilities can = held.driver().capabilities();
  if (!options.push) {
    look(held, options.seconds, interrupt, [](double) { return dvec3(0); });
    return kDone;
  }
  if (!can.renders_force || can.resists_only) return fail(kUsage, {"--push", name + " does not push", "leave it out"});
  const double most = can.max_force > 0.0 ? std::min(kPushForce, kPushShare * can.max_force) : kPushForce;
  if (!confirmed(most)) {
    note("nothing was pushed, because the answer was not `yes`");
    return kDone;
  }
  look(held, 1.0 + 3 * kPushSeconds, interrupt, [&](double time) {
    const double since = time - 0.5;
    const int axis = static_cast<int>(std::floor(since / kPushSeconds));
    dvec3 force(0);
    if (since > 0.0 && axis < 3) force[axis] = most * std::sin(2 * 3.14159265358979 * since / kPushSeconds);
    return force;
  });
  if (Servo* servo = held.servo()) {
    const DeviceReport& report = servo->report();
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(report.transitions, DeviceReport::kKept); ++i)
      print("  {}\n", describe(report.transition(i)));
  }
  return kDone;
}

}  // namespace pliant
