// A device in a hand, in simulated time, with the real servo: the written force is the force on the hand. Device faults
// can be inserted between the two at a given time.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>

#include "devices/servo/servo.h"

namespace pliant {

// One axis, vertical: a mass with a hand's damper and spring (a light grip; 0.15 kg, 5 N s/m, 300 N/m), whose other end
// follows the intended motion.
struct SimulatedHand {
  double mass = 0.15, damping = 5.0, stiffness = 300.0;  // [kg], [N s/m], [N/m]
  double wants = 0.02;                                   // [m] where the hand would be without a force
  double y = 0.02, v = 0.0;                              // [m], [m/s]
  double work = 0.0;                                     // [J] done by the force on it
  double time = 0.0;                                     // [s]

  void step(double force, double dt) {
    constexpr int kParts = 8;
    const double h = dt / kParts;
    for (int i = 0; i < kParts; ++i) {
      // A hand always trembles: 9 Hz.
      time += h;
      const double target = wants + 1e-4 * std::sin(2.0 * 3.14159265358979 * 9.0 * time);
      v += h / mass * (force + stiffness * (target - y) - damping * v);
      y += h * v;
      work += force * h * v;
    }
  }
};

struct FaultyDevice {
  SimulatedHand hand;
  double now = 0.0;      // [s]
  double written = 0.0;  // [N] along y
  double largest = 0.0;  // [N] |written| since it was set to zero
  int writes = 0, made_safe = 0;
  DeviceCapabilities can{.max_force = 3.3,
                         .max_stiffness = 2000.0,
                         .continuous_force = 0.9,
                         .max_velocity = 1.0,
                         .workspace = {0.1, 0.1, 0.1},
                         .rate = 1000.0};
  // Faults of the device; each function may change its argument, or throw. False: no sample.
  std::function<bool(DeviceSample&)> sensing;
  std::function<double(double)> acting;  // [N] asked -> rendered
  std::function<void()> calling;         // at every call: may throw
};

class FaultyDriver final : public Driver {
 public:
  explicit FaultyDriver(FaultyDevice& device) : device_(device) {}
  Status open(const std::string&) override { return Done{}; }
  DeviceCapabilities capabilities() const override { return device_.can; }
  bool read(DeviceSample& sample) override {
    if (device_.calling) device_.calling();
    sample = {};
    sample.position = {0, device_.hand.y, 0};
    sample.time = device_.now + 1e-9;  // 0 would mean the time of reading
    return !device_.sensing || device_.sensing(sample);
  }
  void write(const DeviceWrench& wrench) override {
    if (device_.calling) device_.calling();
    ++device_.writes;
    device_.written = wrench.force.y;
    device_.largest = std::max(device_.largest, length(wrench.force));
  }
  void close() override {}
  void make_safe() noexcept override {
    ++device_.made_safe;
    device_.written = 0.0;
  }

 private:
  FaultyDevice& device_;
};

// A wall at y = 0 in the touch tick, 1 kHz; the hand presses 5 mm into it.
struct WallRig {
  static constexpr double kStiffness = 400.0, kTick = 1e-3;
  FaultyDevice device;
  Servo servo;
  double time = 0.0;
  bool touch_runs = true;
  int every = 1;  // the servo's periods that are run: all, or one of so many
  std::uint64_t periods_run = 0;
  std::function<void(DeviceModel&)> law;  // changes the model
  DeviceSample sample;
  bool heard = false;

  explicit WallRig(const GuardParameters& guard = {}, const DeviceCapabilities* can = nullptr)
      : servo(make(can), guard) {
    EXPECT_TRUE(servo.open(""));
  }
  std::unique_ptr<Driver> make(const DeviceCapabilities* can) {
    if (can) device.can = *can;
    return std::make_unique<FaultyDriver>(device);
  }

  // A touch tick: its model from the newest sample, then the servo's periods and the hand until the next.
  void tick() {
    if (servo.read(sample)) heard = true;
    if (touch_runs && heard) {
      DeviceModel model;
      model.position = sample.position;
      model.time = time;
      model.max_force = 3.3;
      const double depth = -sample.position.y;
      if (depth > 0.0) {
        model.wrench.force.y = kStiffness * depth;
        model.force_by_position[1][1] = -kStiffness;
      }
      if (law) law(model);
      servo.write_model(model, model.wrench);
    }
    const int periods = static_cast<int>(std::lround(device.can.rate * kTick));
    for (int i = 0; i < periods; ++i) {
      time += kTick / periods;
      device.now = time;
      if (++periods_run % static_cast<std::uint64_t>(every) == 0) servo.period(time);
      const double asked = device.written;
      const double rendered = device.acting ? device.acting(asked) : asked;
      device.hand.step(rendered, kTick / periods);
    }
  }
  // The engine is stopped; the hand and the device's last force continue.
  void stall(double seconds) {
    const auto ticks = static_cast<int>(std::lround(seconds / kTick));
    for (int i = 0; i < ticks; ++i) {
      time += kTick;
      device.now = time;
      device.hand.step(device.acting ? device.acting(device.written) : device.written, kTick);
    }
  }
  void run(double seconds) {
    const auto ticks = static_cast<int>(std::lround(seconds / kTick));
    for (int i = 0; i < ticks; ++i) tick();
  }
  // Armed in the air, then pressed until in equilibrium in the wall under about 1 N.
  void press() {
    run(0.4);
    ASSERT_EQ(servo.state(), DeviceState::kActive) << name_of(servo.state());
    for (int i = 0; i < 200; ++i) {
      device.hand.wants = 0.02 - 0.026 * (i + 1) / 200.0;
      tick();
    }
    run(0.3);
    ASSERT_EQ(servo.state(), DeviceState::kActive) << describe(servo.report().transition(0));
    ASSERT_GT(device.written, 0.8);
  }
};

}  // namespace pliant
