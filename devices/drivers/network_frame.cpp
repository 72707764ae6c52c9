#include "devices/drivers/network_frame.h"

#include <sys/random.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "devices/ports/bytes.h"
#include "devices/ports/crc32.h"

namespace pliant {
namespace {

constexpr double kMostMetres = 100.0;                                  // [m] beyond it, the unit must be wrong
constexpr double kMostNumber = 1e9;                                    // limit of all other numbers
constexpr std::size_t kCheckAt = 8;                                    // position of the checksum
constexpr std::uint32_t kReady = 1, kStopped = 2, kHot = 4, kLow = 8;  // StateFrame
constexpr std::uint32_t kHasModel = 1;                                 // ForceFrame

// DeviceCapabilities, one bit per capability.
constexpr bool DeviceCapabilities::*kAbilities[] = {
    &DeviceCapabilities::senses_position, &DeviceCapabilities::senses_rotation,  &DeviceCapabilities::senses_grip,
    &DeviceCapabilities::renders_force,   &DeviceCapabilities::renders_torque,   &DeviceCapabilities::renders_grip,
    &DeviceCapabilities::resists_only,    &DeviceCapabilities::renders_vibration};
constexpr double DeviceCapabilities::*kFigures[] = {
    &DeviceCapabilities::max_force,        &DeviceCapabilities::max_torque,   &DeviceCapabilities::max_stiffness,
    &DeviceCapabilities::continuous_force, &DeviceCapabilities::max_velocity, &DeviceCapabilities::rate};

void put(ByteWriter& out, const dvec3& v) {
  for (int i = 0; i < 3; ++i) out.put_real(v[i]);
}
void put(ByteWriter& out, const dquat& q) {
  for (const double part : {q.w, q.x, q.y, q.z}) out.put_real(part);
}
void put(ByteWriter& out, const dmat3& m) {
  for (int column = 0; column < 3; ++column) put(out, m[column]);
}
void put(ByteWriter& out, const DeviceWrench& wrench) {
  put(out, wrench.force);
  put(out, wrench.torque);
  out.put_real(wrench.grip);
}

// Reads numbers and checks that all are valid.
struct Numbers {
  ByteReader& in;
  bool good = true, turned = true;
  double real(double most = kMostNumber) {
    const double value = in.get_real();
    good = good && std::isfinite(value) && std::abs(value) <= most;
    return value;
  }
  double positive() {
    const double value = real();
    good = good && value >= 0.0;
    return value;
  }
  dvec3 vector(double most = kMostNumber) {
    dvec3 v;
    for (int i = 0; i < 3; ++i) v[i] = real(most);
    return v;
  }
  dmat3 matrix() {
    dmat3 m;
    for (int column = 0; column < 3; ++column) m[column] = vector();
    return m;
  }
  dquat rotation() {
    dquat q;
    q.w = real(2.0);
    q.x = real(2.0);
    q.y = real(2.0);
    q.z = real(2.0);
    const double norm = glm::length(q);
    turned = turned && std::abs(norm - 1.0) < 1e-3;  // sent as unit quaternion in single precision
    return good && turned ? q / norm : dquat(1, 0, 0, 0);
  }
  DeviceWrench wrench() {
    DeviceWrench w;
    w.force = vector();
    w.torque = vector();
    w.grip = real();
    return w;
  }
};

template <std::size_t N>
void put_text(ByteWriter& out, const std::array<char, N>& text) {
  for (std::size_t i = 0; i < N; ++i) out.put(static_cast<std::uint8_t>(i + 1 < N ? text[i] : 0));
}

// Printed to terminals: control characters are removed.
template <std::size_t N>
void get_text(ByteReader& in, std::array<char, N>& text) {
  for (char& letter : text) letter = static_cast<char>(in.get<std::uint8_t>());
  text.back() = 0;
  for (char& letter : text)
    if (letter != 0 && (static_cast<unsigned char>(letter) < 32 || letter == 127)) letter = '?';
}

void put_description(ByteWriter& out, const DescriptionFrame& frame) {
  std::uint32_t bits = 0, bit = 1;
  for (const auto ability : kAbilities) {
    if (frame.can.*ability) bits |= bit;
    bit <<= 1;
  }
  out.put(bits);
  for (const auto figure : kFigures) out.put_real(frame.can.*figure);
  put(out, frame.can.workspace);
  put_text(out, frame.name);
}

bool get_description(ByteReader& in, DescriptionFrame& frame) {
  Numbers numbers{in};
  const auto bits = in.get<std::uint32_t>();
  for (std::size_t i = 0; i < std::size(kAbilities); ++i) frame.can.*kAbilities[i] = (bits >> i & 1u) != 0;
  for (const auto figure : kFigures) frame.can.*figure = numbers.positive();
  frame.can.workspace = numbers.vector(kMostMetres);
  get_text(in, frame.name);
  return numbers.good && std::min({frame.can.workspace.x, frame.can.workspace.y, frame.can.workspace.z}) >= 0.0;
}

void put_state(ByteWriter& out, const StateFrame& frame) {
  out.put(frame.heard);
  out.put((frame.sample.ready ? kReady : 0) | (frame.stopped ? kStopped : 0) | (frame.hot ? kHot : 0) |
          (frame.low ? kLow : 0));
  out.put(frame.sample.buttons);
  put(out, frame.sample.position);
  put(out, frame.sample.rotation);
  put(out, frame.velocity);
  put(out, frame.spin);
  out.put_real(frame.sample.grip);
}

// A rotation that is not of unit length has its own fault, because it is a common error in new devices.
FrameFault fault_of(const Numbers& numbers, bool good = true) {
  if (!numbers.good || !good) return FrameFault::kValue;
  return numbers.turned ? FrameFault::kNone : FrameFault::kRotation;
}

FrameFault get_state(ByteReader& in, StateFrame& frame) {
  Numbers numbers{in};
  frame.heard = in.get<std::uint32_t>();
  const auto bits = in.get<std::uint32_t>();
  frame.sample.ready = (bits & kReady) != 0;
  frame.stopped = (bits & kStopped) != 0;
  frame.hot = (bits & kHot) != 0;
  frame.low = (bits & kLow) != 0;
  frame.sample.buttons = in.get<std::uint32_t>();
  frame.sample.position = numbers.vector(kMostMetres);
  frame.sample.rotation = numbers.rotation();
  frame.velocity = numbers.vector();
  frame.spin = numbers.vector();
  frame.sample.grip = numbers.real(1.0);
  return fault_of(numbers, frame.sample.grip >= 0.0);
}

constexpr dmat3 DeviceModel::*kMatrices[] = {&DeviceModel::force_by_position,  &DeviceModel::force_by_turn,
                                             &DeviceModel::torque_by_position, &DeviceModel::torque_by_turn,
                                             &DeviceModel::force_by_velocity,  &DeviceModel::torque_by_spin};

void put_force(ByteWriter& out, const ForceFrame& frame) {
  out.put(frame.heard);
  out.put(frame.has_model ? kHasModel : 0u);
  put(out, frame.wrench);
  out.put_real(frame.radius);
  put(out, frame.model.position);
  put(out, frame.model.rotation);
  put(out, frame.model.wrench);
  for (const auto matrix : kMatrices) put(out, frame.model.*matrix);
}

FrameFault get_force(ByteReader& in, ForceFrame& frame) {
  Numbers numbers{in};
  frame.heard = in.get<std::uint32_t>();
  frame.has_model = (in.get<std::uint32_t>() & kHasModel) != 0;
  frame.wrench = numbers.wrench();
  frame.radius = numbers.positive();
  frame.model.position = numbers.vector(kMostMetres);
  frame.model.rotation = numbers.rotation();
  frame.model.wrench = numbers.wrench();
  for (const auto matrix : kMatrices) frame.model.*matrix = numbers.matrix();
  return fault_of(numbers);
}

// Over all bytes, with the checksum itself as zeros.
std::uint32_t check_of(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 4> kZeros{};
  std::uint32_t sum = crc32(bytes.first(kCheckAt));
  sum = crc32(kZeros, sum);
  return crc32(bytes.subspan(kCheckAt + 4), sum);
}

}  // namespace

std::size_t frame_length(FrameKind kind) {
  switch (kind) {
    case FrameKind::kAsk:
    case FrameKind::kOpen:
    case FrameKind::kClose:
      return kFrameHeader;
    case FrameKind::kDescription:
      return kFrameHeader + 4 + 6 * 4 + 3 * 4 + 32;
    case FrameKind::kState:
      return kFrameHeader + 3 * 4 + (3 + 4 + 3 + 3 + 1) * 4;
    case FrameKind::kForce:
      return kFrameHeader + 2 * 4 + (7 + 1 + 3 + 4 + 7 + 6 * 9) * 4;
    case FrameKind::kBusy:
      return kFrameHeader + std::tuple_size_v<decltype(BusyFrame::by)>;
  }
  return 0;
}

std::size_t write_frame(const NetworkFrame& frame, FrameBytes& into, const FrameKey* key) {
  const std::size_t bare = frame_length(frame.kind), length = bare + (key ? FrameKey::kTag : 0);
  ByteWriter out{std::span(into).first(bare)};
  out.put(kFrameMagic);
  out.put(key ? kKeyedVersion : kFrameVersion);
  out.put(static_cast<std::uint8_t>(frame.kind));
  out.put(static_cast<std::uint16_t>(length));
  out.put(std::uint32_t{0});
  out.put(frame.session);
  out.put(frame.peer);
  out.put(frame.sequence);
  out.put(frame.time_us);
  if (frame.kind == FrameKind::kDescription) put_description(out, frame.description);
  if (frame.kind == FrameKind::kState) put_state(out, frame.state);
  if (frame.kind == FrameKind::kForce) put_force(out, frame.force);
  if (frame.kind == FrameKind::kBusy) put_text(out, frame.busy.by);
  ByteWriter check{std::span(into).subspan(kCheckAt, 4)};
  check.put(check_of(std::span(into).first(bare)));
  if (key)
    key->tag(std::span<const std::uint8_t>(into).first(bare),
             std::span<std::uint8_t, FrameKey::kTag>(into.data() + bare, FrameKey::kTag));
  return length;
}

FrameFault parse_frame(std::span<const std::uint8_t> bytes, NetworkFrame& frame, const FrameKey* key) {
  if (bytes.size() < kFrameHeader) return FrameFault::kTruncated;
  ByteReader in(bytes);
  if (in.get<std::uint32_t>() != kFrameMagic) return FrameFault::kForeign;
  const auto version = in.get<std::uint8_t>();
  if (version != kFrameVersion && version != kKeyedVersion) return FrameFault::kVersion;
  const bool keyed = version == kKeyedVersion;
  NetworkFrame read;
  read.kind = static_cast<FrameKind>(in.get<std::uint8_t>());
  const std::size_t bare = frame_length(read.kind), length = bare + (keyed ? FrameKey::kTag : 0);
  if (bare == 0) return FrameFault::kKind;
  if (in.get<std::uint16_t>() != length || bytes.size() > length) return FrameFault::kLength;
  if (bytes.size() < length) return FrameFault::kTruncated;
  if (in.get<std::uint32_t>() != check_of(bytes.first(bare))) return FrameFault::kCheck;
  if (keyed != (key != nullptr)) return FrameFault::kKey;
  if (key &&
      !key->fits(bytes.first(bare), std::span<const std::uint8_t, FrameKey::kTag>(bytes.data() + bare, FrameKey::kTag)))
    return FrameFault::kKey;
  read.session = in.get<std::uint32_t>();
  read.peer = in.get<std::uint32_t>();
  read.sequence = in.get<std::uint32_t>();
  read.time_us = in.get<std::uint64_t>();
  FrameFault fault = FrameFault::kNone;
  if (read.kind == FrameKind::kDescription && !get_description(in, read.description)) fault = FrameFault::kValue;
  if (read.kind == FrameKind::kState) fault = get_state(in, read.state);
  if (read.kind == FrameKind::kForce) fault = get_force(in, read.force);
  if (read.kind == FrameKind::kBusy) get_text(in, read.busy.by);
  if (fault != FrameFault::kNone) return fault;
  if (!in.ok()) return FrameFault::kTruncated;
  frame = read;
  return FrameFault::kNone;
}

void count_fault(DroppedFrames& dropped, FrameFault fault) {
  switch (fault) {
    case FrameFault::kNone:
      return;
    case FrameFault::kTruncated:
      ++dropped.too_short;
      return;
    case FrameFault::kForeign:
    case FrameFault::kKind:
    case FrameFault::kLength:
      ++dropped.unknown;
      return;
    case FrameFault::kVersion:
      ++dropped.version;
      return;
    case FrameFault::kCheck:
      ++dropped.checksum;
      return;
    case FrameFault::kKey:
      ++dropped.key;
      return;
    case FrameFault::kValue:
      ++dropped.number;
      return;
    case FrameFault::kRotation:
      ++dropped.rotation;
      return;
  }
}

std::uint32_t random_session() {
  std::uint32_t session = 0;
  while (session == 0)
    if (::getrandom(&session, sizeof session, 0) != sizeof session) session = 0;
  return session;
}

}  // namespace pliant
