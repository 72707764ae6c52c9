// States and causes of a device as text.
#include <fmt/format.h>

#include "pliant/device_state.h"

namespace pliant {
namespace {

const char* sentence(DeviceCause cause) {
  switch (cause) {
    case DeviceCause::kNone:
      return "";
    case DeviceCause::kConnected:
      return "samples come";
    case DeviceCause::kArmedByItself:
      return "it armed itself, as its samples and the force model are fresh";
    case DeviceCause::kArmedByHand:
      return "it was armed by hand";
    case DeviceCause::kDisarmed:
      return "it was disarmed";
    case DeviceCause::kSmallForce:
      return "the wanted force is small";
    case DeviceCause::kDeadManHeld:
      return "the dead-man button is held";
    case DeviceCause::kDeadManReleased:
      return "the dead-man button was let go";
    case DeviceCause::kLetGo:
      return "the session paused, stopped or lost the effector's pose; it comes back through the gate";
    case DeviceCause::kNoSample:
      return "no sample for 10 ms; it comes back through the gate";
    case DeviceCause::kLost:
      return "no sample for 100 ms; check cable and power, then arm it again";
    case DeviceCause::kNotReady:
      return "the device says that its state is not known; check cable, power and calibration";
    case DeviceCause::kNotANumber:
      return "its pose is no number or its rotation not of unit length; restart the device";
    case DeviceCause::kOutside:
      return "its pose is far outside its workspace; check its unit (metres) and calibration, then arm it again";
    case DeviceCause::kJumped:
      return "its pose jumped farther than a hand can; check its sensors";
    case DeviceCause::kFrozen:
      return "its pose did not change by one count for half a second under force; hold it, or restart the device";
    case DeviceCause::kTimeBack:
      return "its samples' time went back or lies ahead; check the driver's clock";
    case DeviceCause::kTooFast:
      return "it was faster than its largest velocity; hold it firmly, then arm it again";
    case DeviceCause::kRunaway:
      return "it gathered speed against the force; check the sign of its axes and motors, then arm it again";
    case DeviceCause::kGaveEnergy:
      return "the hand got more energy than it gave; report it with the level, then arm it again";
    case DeviceCause::kBadForce:
      return "the wanted force is no number; report it with the level";
    case DeviceCause::kModelStale:
      return "no force model for 10 ms; the touch clock is late";
    case DeviceCause::kModelLost:
      return "no force model for 100 ms; the touch clock has stopped or is starved: end other programs, then arm it "
             "again";
    case DeviceCause::kClockGap:
      return "its servo did not run in time: the process was paused or starved; arm it again";
    case DeviceCause::kSuspended:
      return "the machine slept; arm it again";
    case DeviceCause::kUnsteady:
      return "it was lost five times in a second; check cable and load, then arm it again";
    case DeviceCause::kBatteryLow:
      return "its battery is low; charge it, then arm it again";
    case DeviceCause::kEmergencyStop:
      return "the emergency stop was pressed; arm it again once it is safe";
    case DeviceCause::kDriverFailed:
      return "its driver failed; check cable and permissions, then connect it again";
    case DeviceCause::kClosed:
      return "it was closed";
  }
  return "";
}

}  // namespace

const char* name_of(DeviceState state) {
  switch (state) {
    case DeviceState::kDisconnected:
      return "disconnected";
    case DeviceState::kIdle:
      return "idle";
    case DeviceState::kArmed:
      return "armed";
    case DeviceState::kActive:
      return "active";
    case DeviceState::kTripped:
      return "tripped";
  }
  return "";
}

std::string describe(DeviceCause cause) {
  return sentence(cause);
}

std::string describe(const DeviceTransition& t) {
  return fmt::format("{} -> {} at {:.3f} s from {:.2f} N: {}", name_of(t.from), name_of(t.to), t.time, t.force,
                     sentence(t.cause));
}

}  // namespace pliant
