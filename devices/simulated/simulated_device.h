// A simulated device in a simulated hand: a driver like any other, with what a real one does to a loop - mass,
// friction, encoder and force counts, saturation, the amplifier's lag, transport delay, samples of its own clock.
//
// World axes are its own; three axes that do not couple, each with its friction, as each joint of a real one has. The
// workspace ends in stops. Where a profile renders torque, three more axes turn the grip beside where the hand wants to
// turn it, by a rotation vector that the hand's own stiffness keeps small: they do not couple either, and the turn that
// the hand wants costs nothing. Elsewhere the rotation of its sample is the will's.
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
  kWall,  // samples when their time has come, from the first that is asked for: another thread's clock, as of a real
          // device
  kTick   // a sample a read(): lockstep, the same bits every time
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
  SimulatedDevice() = default;                         // open(id) says what it is
  explicit SimulatedDevice(SimulatedOptions options);  // open() begins it, whatever the id
  SimulatedDevice(const SimulatedDevice&) = delete;
  SimulatedDevice& operator=(const SimulatedDevice&) = delete;
  Status open(const std::string& id) override;
  void use_clock(DeviceClock clock) { options_.clock = clock; }  // before its first sample
  DeviceCapabilities capabilities() const override { return capabilities_of(options_.profile); }
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  void close() override { open_ = false; }

  // What no encoder says, for tests and plots.
  dvec3 true_position() const;
  dvec3 true_velocity() const;
  dvec3 motor_force() const;
  dvec3 true_turn() const;  // [rad] beside where the hand wants it
  dvec3 motor_torque() const;
  double time() const { return time_; }  // [s] of its own clock
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
  std::vector<Axis> axes_, turns_;  // turns_: none, or three
  std::vector<Command> line_;       // a ring: transport
  std::size_t first_ = 0, waiting_ = 0;
  std::optional<PathCursor> cursor_;
  dvec3 start_{0}, wanted_{0};
  dquat rotation_{1, 0, 0, 0};
  double time_ = 0.0, began_ = 0.0;  // [s] of its clock; of the wall
  std::uint64_t index_ = 0;          // samples so far
};

// `simulated` into the registry (pliant/driver.h), with its profiles listed. Once, however often it is called.
void register_simulated();

}  // namespace pliant
