// The frames of the network device, our protocol over UDP (docs/devices/protocols.md documents every byte). A codec of
// pure functions without allocation.
//
// Numbers are little-endian, reals IEEE single precision, matrices column-major. Positions in metres, forces in
// newtons, axes are the world's: right-handed, Y up. Quaternions are w x y z, device frame to world.
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
  kAsk = 1,      // engine: requests the description, without any effect
  kOpen,         // engine: opens this session
  kDescription,  // device: the answer to both
  kState,        // device: its state
  kForce,        // engine: the force to render
  kClose,        // engine: zero force; the device accepts any engine again
  kBusy          // device: in use by another engine, and by which
};

// Why a datagram is rejected.
enum class FrameFault : std::uint8_t {
  kNone,
  kTruncated,
  kForeign,  // not of this protocol
  kVersion,
  kKind,
  kLength,
  kCheck,
  kKey,  // authenticated with another key, without one, or with one that we lack
  kValue,
  kRotation
};
void count_fault(DroppedFrames& dropped, FrameFault fault);

struct DescriptionFrame {
  DeviceCapabilities can;
  std::array<char, 32> name{};  // UTF-8, zero-padded; the last byte is zero
};

struct StateFrame {
  DeviceSample sample;      // its time is the header's
  dvec3 velocity{0};        // [m/s]
  dvec3 spin{0};            // [rad/s]
  bool stopped = false;     // the device's emergency stop was pressed
  bool hot = false;         // its motors are too hot to continue
  bool low = false;         // its battery is nearly empty
  std::uint32_t heard = 0;  // sequence number of the newest accepted force frame
};

struct ForceFrame {
  DeviceWrench wrench;  // current wrench; the only content if has_model is false
  bool has_model = false;
  DeviceModel model;        // its time is not sent: it is that of the frame; nor are its limits: `radius` bounds it
  double radius = 0.0;      // [m] range of the model; beyond it, its value at this distance
  std::uint32_t heard = 0;  // sequence number of the newest state frame that the engine has accepted
};

struct BusyFrame {
  std::array<char, 64> by{};  // the engine that uses it, "192.168.1.7:40123"; encoded like a description's name
};

struct NetworkFrame {
  FrameKind kind = FrameKind::kAsk;
  std::uint32_t session = 0;   // the sender's, random; new after each start
  std::uint32_t peer = 0;      // the addressed session; 0 in kAsk and kOpen
  std::uint32_t sequence = 0;  // incremented with each frame of a session
  std::uint64_t time_us = 0;   // [us] of the sender's monotonic clock
  DescriptionFrame description;
  StateFrame state;
  ForceFrame force;
  BusyFrame busy;
};

inline constexpr std::uint32_t kFrameMagic = 0x544E4C50;             // "PLNT"
inline constexpr std::uint8_t kFrameVersion = 1, kKeyedVersion = 2;  // with an authentication tag appended
inline constexpr std::size_t kFrameHeader = 32;
inline constexpr std::size_t kMaxFrame = 344 + FrameKey::kTag;
inline constexpr double kFrameSilence = 0.020;  // [s] watchdog on both sides: zero force after this time without a
                                                // frame
inline constexpr double kFrameAnswer = 0.040;   // [s] the same without an acknowledgement of a sent frame

using FrameBytes = std::array<std::uint8_t, kMaxFrame>;

// Bytes of a frame of this kind, without a tag; 0 for an unknown kind.
std::size_t frame_length(FrameKind kind);
std::size_t write_frame(const NetworkFrame& frame, FrameBytes& into, const FrameKey* key = nullptr);
// Writes all of `frame`, or nothing. All its numbers are finite and quaternions unit. With a key, only frames of that
// key are accepted; without one, only frames without.
FrameFault parse_frame(std::span<const std::uint8_t> bytes, NetworkFrame& frame, const FrameKey* key = nullptr);

// True: `sequence` comes after `before`, also across the overflow of the counter.
inline bool comes_after(std::uint32_t sequence, std::uint32_t before) {
  return static_cast<std::int32_t>(sequence - before) > 0;
}

// Send times of the newest frames. With the peer's acknowledgements they detect a connection that only delays frames.
class SentTimes {
 public:
  // Assigns the next sequence number and stores `now`.
  std::uint32_t next(double now) {
    at_[++sent_ % at_.size()] = now;
    return sent_;
  }
  // [s] since `sequence` was sent; infinite if it is too old or was never sent.
  double age(std::uint32_t sequence, double now) const {
    return sent_ - sequence < at_.size() ? now - at_[sequence % at_.size()] : std::numeric_limits<double>::infinity();
  }
  // [s] since the first frame after `heard` was sent; 0: none.
  double unanswered(std::uint32_t heard, double now) const { return heard == sent_ ? 0.0 : age(heard + 1, now); }

 private:
  std::uint32_t sent_ = 0;
  std::array<double, 1024> at_{};  // [s] by sequence
};

// Statistics of received frames. Only accepted ones have any effect.
struct FrameCounts : DroppedFrames {
  std::uint64_t accepted = 0;
};

// Random, from the kernel; never 0.
std::uint32_t random_session();

}  // namespace pliant
