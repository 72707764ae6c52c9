// What stands between a program and a hand: the state of a device, why it changed, and how its servo runs.
//
//   disconnected -> idle -> armed -> active -> tripped
//
// Force leaves in `active` alone. Whatever is not understood takes it away at once; what repeats or lasts, or is
// dangerous at once, trips the device, and only a person arms it again (Session::arm).
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "pliant/driver.h"

namespace pliant {

enum class DeviceState : std::uint8_t {
  kDisconnected,  // no sample comes
  kIdle,          // samples come; it is not armed
  kArmed,         // it waits until the wanted force is small, or for the dead-man button
  kActive,        // force leaves
  kTripped        // latched: no force until it is armed again
};

enum class DeviceCause : std::uint8_t {
  kNone,
  kConnected,        // samples come
  kArmedByItself,    // fresh samples and a fresh model (Arming::kAutomatic)
  kArmedByHand,      // Session::arm
  kDisarmed,         // Session::disarm
  kSmallForce,       // the gate opened on a small wanted force
  kDeadManHeld,      // the gate opened on the dead-man button
  kDeadManReleased,  // it was let go
  kLetGo,            // the session paused, stopped, or lost what moves the effector
  kNoSample,         // none for 10 ms
  kLost,             // none for 100 ms
  kNotReady,         // the device says that its state is not known
  kNotANumber,       // a pose is none
  kOutside,          // a pose far outside its workspace: a wrong unit
  kJumped,           // a pose no hand could reach in that time
  kFrozen,           // the very same pose for half a second, under force
  kTimeBack,         // a sample is older than the one before, or from the future
  kTooFast,          // faster than its largest velocity
  kRunaway,          // it gathers speed against the force
  kGaveEnergy,       // the hand got more than it gave, in spite of damping
  kBadForce,         // the wanted force is no number
  kModelStale,       // no force model for 10 ms
  kModelLost,        // none for 100 ms
  kClockGap,         // the servo was not run for 10 ms: the process was paused, or starved
  kSuspended,        // the machine slept
  kUnsteady,         // five losses in one second
  kBatteryLow,
  kEmergencyStop,
  kDriverFailed,  // its driver threw
  kClosed
};

struct DeviceTransition {
  DeviceState from = DeviceState::kDisconnected, to = DeviceState::kDisconnected;
  DeviceCause cause = DeviceCause::kNone;
  double time = 0.0;   // [s] of the servo's clock
  double force = 0.0;  // [N] that was written last
};

const char* name_of(DeviceState state);
// "no sample for 100 ms; check cable and power, then arm it again".
std::string describe(DeviceCause cause);
// "active -> tripped at 12.345 s from 1.20 N: no sample for 100 ms; check cable and power, then arm it again".
std::string describe(const DeviceTransition& transition);

// Who arms a device.
enum class Arming : std::uint8_t {
  kAutomatic,  // it arms itself once samples and models are fresh; never after a trip
  kByHand      // Session::arm alone
};

// How a device is guarded. Whatever is said here, the device's own limits hold.
struct GuardParameters {
  Arming arming = Arming::kAutomatic;
  std::uint32_t dead_man = 0;  // buttons: force only while one of them is down; 0: none is needed
  double max_force = 0.0;      // [N] 0: the device's
  double max_torque = 0.0;     // [N m] the same
  double max_velocity = 0.0;   // [m/s] the same; 2 where neither says one
  double slew = 2000.0;        // [N/s] of force that comes in; what is let go falls at once
  double ramp = 0.2;           // [s] in which force comes in, once the gate is open
};

// How a device's servo runs, since its start.
struct ServoFigures {
  std::uint64_t periods = 0;                          // run
  std::uint64_t missed = 0;                           // deadlines: a period that could not begin in time
  std::uint64_t samples = 0, without_sample = 0;      // periods with a new sample, and without one
  std::uint64_t models = 0;                           // taken from the touch tick
  double rate = 0.0;                                  // [Hz] of the last tenth of a second
  double period_p50 = 0.0, period_p99 = 0.0;          // [us] between two beginnings
  double period_max = 0.0;                            // [us]
  double jitter = 0.0;                                // [us] |period - wanted|, 99 of 100 stay below it
  double round_trip_p50 = 0.0, round_trip_max = 0.0;  // [us] from a write to the sample that answers it, if told
  double oldest_model = 0.0;                          // [us] that a force was made from
  std::uint64_t late_models = 0;                      // periods whose model was older than two ticks of 1 ms
  double read_p50 = 0.0, read_max = 0.0;              // [us] from sensing to reading, if the driver tells when
  bool has_priority = false;                          // SCHED_FIFO was granted
};

// What came from a device and was not used, by why; and its samples that say that its state is not known.
struct DroppedFrames {
  std::uint64_t too_short = 0;  // cut on the way
  std::uint64_t unknown = 0;    // no frame of this protocol, or of no kind or length that it has
  std::uint64_t version = 0;    // of another version
  std::uint64_t checksum = 0;   // its check sum is wrong
  std::uint64_t number = 0;     // holds a number that is none, or that cannot be
  std::uint64_t rotation = 0;   // holds a rotation that is not of unit length
  std::uint64_t key = 0;        // not of this key, or without one (docs/devices/protocols.md)
  std::uint64_t foreign = 0;    // from another address or session
  std::uint64_t late = 0;       // doubled, overtaken, replayed, or with a time that runs backwards
  std::uint64_t lost = 0;       // gaps in the count of frames
  std::uint64_t not_ready = 0;  // samples, of all drivers

  std::uint64_t damaged() const { return too_short + unknown + version + checksum + number + rotation; }
  std::uint64_t dropped() const { return damaged() + key + foreign + late; }
};
// "12 of another version, 3 with a wrong check sum"; "" where all were used. `not_ready` is not among them.
std::string describe(const DroppedFrames& frames);
// For people who make the device: what each kind that happened comes from. One sentence, or none.
std::string cure_for(const DroppedFrames& frames);

// A driver that counts what it does not use derives from this, too.
class CountsDropped {
 public:
  virtual ~CountsDropped() = default;
  // On the thread that reads.
  virtual DroppedFrames dropped() const = 0;
};

// All that a person wants to know about a device. Of a driver without a rate, which has no servo: state, cause, sample,
// forces and how often it is read; its force comes back through the gate of the touch tick.
struct DeviceReport {
  static constexpr std::size_t kKept = 32;
  DeviceState state = DeviceState::kDisconnected;
  DeviceCause cause = DeviceCause::kNone;  // of the last transition
  double force = 0.0;                      // [N] as written last
  double heat = 0.0;                       // [1] 1: its force is lowered to what it bears for ever
  DeviceSample sample;                     // the newest, as the device says it
  double sample_age = -1.0;                // [s] since it came; below 0: there was none
  DeviceWrench wanted, sent;               // by the newest model where the device is; as written last
  double max_force = 0.0;         // [N] that may leave now: the least of device, level, parameters and heat; 0:
                                  // nobody says one
  std::uint64_t transitions = 0;  // since the start; the last kKept of them are in `kept`
  std::array<DeviceTransition, kKept> kept{};
  ServoFigures figures;
  DroppedFrames dropped;

  // i of the newest min(transitions, kKept), oldest first.
  DeviceTransition transition(std::uint64_t i) const {
    return kept[(transitions > kKept ? transitions + i : i) % kKept];
  }
};

}  // namespace pliant
