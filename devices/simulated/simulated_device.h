// A simulated device in a simulated hand: a driver with the effects of a real device on a loop: mass, friction,
// quantisation of encoder and force, saturation, amplifier lag, transport delay, its own sample clock.
//
// Its axes are the world's. The three axes are uncoupled, each with its friction, like the joints of a real device. The
// workspace has end stops. If a profile renders torque, three more axes rotate the grip relative to the hand's intended
// rotation, by a rotation vector that the hand's own stiffness keeps small. They are uncoupled too, and the intended
// rotation costs no work. Otherwise the rotation of its sample is the intended one.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "devices/simulated/axis.h"
#include "devices/simulated/profiles.h"
#include "pliant/driver.h"

namespace pliant {

enum class DeviceClock : std::uint8_t {
  kWall,  // samples at their own times, from the first read on: a clock of another thread, like a real device
  kTick   // one sample per read(): lockstep, deterministic
};

struct SimulatedOptions {
  DeviceProfile profile = device_profiles().front();
  HandImpedance hand = hand_impedances()[3];
  Will will;
  DeviceClock clock = DeviceClock::kWall;
  bool stops = true;  // at the ends of the profile's workspace
};

// PROFILE[,KEY=VALUE...]: keys are hand, path, push (X Y Z with ':' between), at (the same), clock (wall or tick), rate
// [Hz], delay, lag (with ms, us or s), friction [N], damping [N s/m], mass [kg], encoder, force_step, max_force,
// max_torque [N m], stops (on or off). An empty id is the first profile.
Result<SimulatedOptions> parse_simulated(const std::string& id);

class SimulatedDevice : public Driver {
 public:
  SimulatedDevice() = default;                         // open(id) configures it
  explicit SimulatedDevice(SimulatedOptions options);  // open() starts it, whatever the id
  SimulatedDevice(const SimulatedDevice&) = delete;
  SimulatedDevice& operator=(const SimulatedDevice&) = delete;
  Status open(const std::string& id) override;
  void use_clock(DeviceClock clock) { options_.clock = clock; }  // before its first sample
  DeviceCapabilities capabilities() const override { return capabilities_of(options_.profile); }
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  void close() override { open_ = false; }

  // True values, which no encoder measures; for tests and plots.
  dvec3 true_position() const;
  dvec3 true_velocity() const;
  dvec3 motor_force() const;
  dvec3 true_turn() const;  // [rad] relative to the intended rotation
  dvec3 motor_torque() const;
  double time() const { return time_; }  // [s] on its own clock
  const SimulatedOptions& options() const { return options_; }

 private:
  struct Command {
    double from = 0.0;  // [s] of its clock
    dvec3 force{0};     // [N]
    dvec3 torque{0};    // [N m]
  };
  void begin();
  void advance_to(double time);
  void apply_commands(double until);
  dvec3 wants(double time, dquat& rotation);

  SimulatedOptions options_;
  bool configured_ = false, open_ = false;
  std::vector<Axis> axes_, turns_;  // turns_: empty, or three
  std::vector<Command> line_;       // a ring: transport delay
  std::size_t first_ = 0, waiting_ = 0;
  std::optional<PathCursor> cursor_;
  dvec3 start_{0}, wanted_{0};
  dquat rotation_{1, 0, 0, 0};
  double time_ = 0.0, began_ = 0.0;  // [s] on its clock; on the wall clock
  std::uint64_t index_ = 0;          // samples so far
};

// Registers `simulated` (pliant/driver.h), with its profiles listed. Further calls have no effect.
void register_simulated();

}  // namespace pliant
