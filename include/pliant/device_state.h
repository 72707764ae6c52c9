// The safety state machine of a device, the causes of its transitions, and the timing of its servo.
//
//   disconnected -> idle -> armed -> active -> tripped
//
// The device renders force only in `active`. Any fault removes the force at once. A repeated, lasting or dangerous
// fault trips the device; then only the user can arm it again (Session::arm).
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "pliant/driver.h"

namespace pliant {

enum class DeviceState : std::uint8_t {
  kDisconnected,  // no samples arrive
  kIdle,          // samples arrive; not armed
  kArmed,         // waits for a small wanted force, or for the dead-man button
  kActive,        // renders force
  kTripped        // latched: no force until armed again
};

enum class DeviceCause : std::uint8_t {
  kNone,
  kConnected,        // samples arrive
  kArmedByItself,    // fresh samples and a fresh model (Arming::kAutomatic)
  kArmedByHand,      // Session::arm
  kDisarmed,         // Session::disarm
  kSmallForce,       // the gate opened at a small wanted force
  kDeadManHeld,      // the gate opened on the dead-man button
  kDeadManReleased,  // it was released
  kLetGo,            // the session paused, stopped, or the effector lost its source
  kNoSample,         // none for 10 ms
  kLost,             // none for 100 ms
  kNotReady,         // the device reports an unknown state
  kNotANumber,       // a pose has NaN or infinite values
  kOutside,          // a pose far outside its workspace: a wrong unit
  kJumped,           // a pose that cannot be reached in that time
  kFrozen,           // an identical pose for half a second, under force
  kTimeBack,         // a sample older than the previous one, or in the future
  kTooFast,          // faster than the maximum velocity
  kRunaway,          // it accelerates against the force
  kGaveEnergy,       // passivity violation: net energy was delivered despite damping
  kBadForce,         // the wanted force is NaN or infinite
  kModelStale,       // no force model for 10 ms
  kModelLost,        // none for 100 ms
  kClockGap,         // the servo did not run for 10 ms: the process was paused or starved
  kSuspended,        // the machine slept
  kUnsteady,         // five losses in one second
  kBatteryLow,
  kEmergencyStop,
  kDriverFailed,  // its driver threw an exception
  kClosed
};

struct DeviceTransition {
  DeviceState from = DeviceState::kDisconnected, to = DeviceState::kDisconnected;
  DeviceCause cause = DeviceCause::kNone;
  double time = 0.0;   // [s] of the servo's clock
  double force = 0.0;  // [N] written last
};

const char* name_of(DeviceState state);
// "no sample for 100 ms; check cable and power, then arm it again".
std::string describe(DeviceCause cause);
// "active -> tripped at 12.345 s from 1.20 N: no sample for 100 ms; check cable and power, then arm it again".
std::string describe(const DeviceTransition& transition);

// How a device becomes armed.
enum class Arming : std::uint8_t {
  kAutomatic,  // automatically once samples and models are fresh; never after a trip
  kByHand      // only by Session::arm
};

// Safety parameters of a device. The device's own limits apply in addition.
struct GuardParameters {
  Arming arming = Arming::kAutomatic;
  std::uint32_t dead_man = 0;  // bit mask: force only while one of these buttons is pressed; 0: none needed
  double max_force = 0.0;      // [N] 0: the device's
  double max_torque = 0.0;     // [N m] the same
  double max_velocity = 0.0;   // [m/s] the same; 2 if neither specifies one
  double slew = 2000.0;        // [N/s] limit for rising force; falling force is not limited
  double ramp = 0.2;           // [s] fade-in of the force after the gate opens
};

// Statistics of a device's servo since its start.
struct ServoFigures {
  std::uint64_t periods = 0;                          // run
  std::uint64_t missed = 0;                           // deadlines: a period that started late
  std::uint64_t samples = 0, without_sample = 0;      // periods with a new sample, and without one
  std::uint64_t models = 0;                           // received from the touch tick
  double rate = 0.0;                                  // [Hz] over the last 0.1 s
  double period_p50 = 0.0, period_p99 = 0.0;          // [us] between two period starts
  double period_max = 0.0;                            // [us]
  double jitter = 0.0;                                // [us] 99th percentile of |period - nominal|
  double round_trip_p50 = 0.0, round_trip_max = 0.0;  // [us] from a write to the sample that acknowledges it, if
                                                      // reported
  double oldest_model = 0.0;                          // [us] largest age of a force model in use
  std::uint64_t late_models = 0;                      // periods whose model was older than two ticks of 1 ms
  double read_p50 = 0.0, read_max = 0.0;              // [us] from sensing to reading, if the driver reports the time
  bool has_priority = false;                          // SCHED_FIFO was granted
};

// Counts of dropped frames by cause, and of samples marked as not ready.
struct DroppedFrames {
  std::uint64_t too_short = 0;  // truncated
  std::uint64_t unknown = 0;    // not a frame of this protocol, or of unknown kind or length
  std::uint64_t version = 0;    // of another version
  std::uint64_t checksum = 0;   // wrong checksum
  std::uint64_t number = 0;     // contains a number that is not finite or out of range
  std::uint64_t rotation = 0;   // contains a rotation that is not of unit length
  std::uint64_t key = 0;        // authenticated with another key, or not at all (docs/devices/protocols.md)
  std::uint64_t foreign = 0;    // from another address or session
  std::uint64_t late = 0;       // duplicated, reordered, replayed, or with a decreasing time
  std::uint64_t lost = 0;       // gaps in the count of frames
  std::uint64_t not_ready = 0;  // samples, of any driver

  std::uint64_t damaged() const { return too_short + unknown + version + checksum + number + rotation; }
  std::uint64_t dropped() const { return damaged() + key + foreign + late; }
};
// "12 of another version, 3 with a wrong check sum"; "" if none were dropped. `not_ready` is not included.
std::string describe(const DroppedFrames& frames);
// For developers of devices: the cause of each kind that occurred. One sentence, or "".
std::string cure_for(const DroppedFrames& frames);

// Base of drivers that count dropped frames.
class CountsDropped {
 public:
  virtual ~CountsDropped() = default;
  // Called on the thread that reads.
  virtual DroppedFrames dropped() const = 0;
};

// Full status of a device. A driver without a rate has no servo: state, cause, sample, forces and read rate are then of
// the touch tick, and its force returns through the touch tick's gate.
struct DeviceReport {
  static constexpr std::size_t kKept = 32;
  DeviceState state = DeviceState::kDisconnected;
  DeviceCause cause = DeviceCause::kNone;  // of the last transition
  double force = 0.0;                      // [N] written last
  double heat = 0.0;                       // [1] thermal load; 1: its force is lowered to its continuous limit
  DeviceSample sample;                     // the newest, as reported by the device
  double sample_age = -1.0;                // [s] since it arrived; below 0: none yet
  DeviceWrench wanted, sent;               // from the newest model at the device's pose; as written last
  double max_force = 0.0;         // [N] current limit: the least of device, level, parameters and thermal limit; 0:
                                  // none specified
  std::uint64_t transitions = 0;  // since the start; the last kKept of them are in `kept`
  std::array<DeviceTransition, kKept> kept{};
  ServoFigures figures;
  DroppedFrames dropped;

  // Transition i of the newest min(transitions, kKept), oldest first.
  DeviceTransition transition(std::uint64_t i) const {
    return kept[(transitions > kKept ? transitions + i : i) % kKept];
  }
};

}  // namespace pliant
