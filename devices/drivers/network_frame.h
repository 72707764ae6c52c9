// The frames of the network device, a protocol of our own over UDP: docs/devices/protocols.md has every byte. A codec
// of pure functions; nothing here allocates.
//
// Numbers are little-endian, reals IEEE single precision, matrices by columns. Positions in metres, forces in newtons,
// axes are the world's: right-handed, Y up. Quaternions are w x y z, device frame to world.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "devices/drivers/network_key.h"
#include "pliant/device_state.h"
#include "pliant/driver.h"

namespace pliant {

enum class FrameKind : std::uint8_t {
  kAsk = 1,      // engine: who are you? Changes nothing
  kOpen,         // engine: from now on listen to this session
  kDescription,  // device: its answer to both
  kState,        // device: what it senses
  kForce,        // engine: what to render
  kClose,        // engine: zero, and listen to anyone again
  kBusy          // device: another engine has it, and which
};

// Why a datagram is no frame.
enum class FrameFault : std::uint8_t {
  kNone,
  kTruncated,
  kForeign,  // not of this protocol
  kVersion,
  kKind,
  kLength,
  kCheck,
  kKey,  // of another key, without one, or with one where there is none
  kValue,
  kRotation
};
void count_fault(DroppedFrames& dropped, FrameFault fault);

struct DescriptionFrame {
  DeviceCapabilities can;
  std::array<char, 32> name{};  // UTF-8, filled with zeros; its last byte is zero
};

struct StateFrame {
  DeviceSample sample;      // its time is the header's
  dvec3 velocity{0};        // [m/s]
  dvec3 spin{0};            // [rad/s]
  bool stopped = false;     // someone pressed the device's emergency stop
  bool hot = false;         // its motors are too warm to go on
  bool low = false;         // its battery is nearly empty
  std::uint32_t heard = 0;  // sequence of the newest force frame it has accepted
};

struct ForceFrame {
  DeviceWrench wrench;  // now; all there is where has_model is false
  bool has_model = false;
  DeviceModel model;        // its time is not sent: it is as old as the frame; nor are its limits: `radius` keeps them
  double radius = 0.0;      // [m] within which the model holds; farther away, its value at this distance
  std::uint32_t heard = 0;  // sequence of the newest state frame that the engine has accepted
};

struct BusyFrame {
  std::array<char, 64> by{};  // the engine that has it, "192.168.1.7:40123"; as the name of a description
};

struct NetworkFrame {
  FrameKind kind = FrameKind::kAsk;
  std::uint32_t session = 0;   // the sender's, by chance; another one after each of its starts
  std::uint32_t peer = 0;      // the session that it is meant for; 0 in kAsk and kOpen
  std::uint32_t sequence = 0;  // one more with each frame of a session
  std::uint64_t time_us = 0;   // [us] of the sender's monotonic clock
  DescriptionFrame description;
  StateFrame state;
  ForceFrame force;
  BusyFrame busy;
};

inline constexpr std::uint32_t kFrameMagic = 0x544E4C50;             // "PLNT"
inline constexpr std::uint8_t kFrameVersion = 1, kKeyedVersion = 2;  // with a tag of the key behind it
inline constexpr std::size_t kFrameHeader = 32;
inline constexpr std::size_t kMaxFrame = 344 + FrameKey::kTag;
inline constexpr double kFrameSilence = 0.020;  // [s] without a frame: zero force, on either side
inline constexpr double kFrameAnswer = 0.040;   // [s] without an answer to a frame that was sent: the same

using FrameBytes = std::array<std::uint8_t, kMaxFrame>;

// Bytes of a frame of this kind, without a tag; 0 of an unknown one.
std::size_t frame_length(FrameKind kind);
std::size_t write_frame(const NetworkFrame& frame, FrameBytes& into, const FrameKey* key = nullptr);
// `frame` is written whole, or not at all. Every number in it is finite and every quaternion unit. With a key, only
// frames of that key are any; without one, only frames without.
FrameFault parse_frame(std::span<const std::uint8_t> bytes, NetworkFrame& frame, const FrameKey* key = nullptr);

// True: `sequence` comes after `before`, also where the count has begun again.
inline bool comes_after(std::uint32_t sequence, std::uint32_t before) {
  return static_cast<std::int32_t>(sequence - before) > 0;
}

// When the newest frames left: a line that only delays is found by what its peer says it has heard.
class SentTimes {
 public:
  // Numbers the frame and remembers `now`.
  std::uint32_t next(double now) {
    at_[++sent_ % at_.size()] = now;
    return sent_;
  }
  // [s] since `sequence` left; endless of one that is too old or was never sent.
  double age(std::uint32_t sequence, double now) const {
    return sent_ - sequence < at_.size() ? now - at_[sequence % at_.size()] : std::numeric_limits<double>::infinity();
  }
  // [s] since the first frame after `heard` left; 0: there is none.
  double unanswered(std::uint32_t heard, double now) const { return heard == sent_ ? 0.0 : age(heard + 1, now); }

 private:
  std::uint32_t sent_ = 0;
  std::array<double, 1024> at_{};  // [s] by sequence
};

// What became of the frames that came. Only accepted ones have any effect.
struct FrameCounts : DroppedFrames {
  std::uint64_t accepted = 0;
};

// By chance, from the kernel; never 0.
std::uint32_t random_session();

}  // namespace pliant
