#include "devices/drivers/network_frame.h"

#include <algorithm>
#include <cmath>

#include "devices/ports/bytes.h"
#include "devices/ports/crc32.h"

namespace pliant {
namespace {

constexpr double kMostMetres = 100.0;                                  // [m] farther away is a fault of units
constexpr double kMostNumber = 1e9;                                    // of everything else
constexpr std::size_t kCheckAt = 8;                                    // where the check sum stands
constexpr std::uint32_t kReady = 1, kStopped = 2, kHot = 4, kLow = 8;  // StateFrame
constexpr std::uint32_t kHasModel = 1;                                 // ForceFrame

// DeviceCapabilities, one bit each.
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

// Reads numbers and remembers whether all of them could be.
struct Numbers {
  ByteReader& in;
  bool good = true;
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
    good = good && std::abs(norm - 1.0) < 1e-3;  // written as unit, in single precision
    return good ? q / norm : dquat(1, 0, 0, 0);
  }
  DeviceWrench wrench() {
    DeviceWrench w;
    w.force = vector();
    w.torque = vector();
    w.grip = real();
    return w;
  }
};

void put_description(ByteWriter& out, const DescriptionFrame& frame) {
  std::uint32_t bits = 0, bit = 1;
  for (const auto ability : kAbilities) {
    if (frame.can.*ability) bits |= bit;
    bit <<= 1;
  }
  out.put(bits);
  for (const auto figure : kFigures) out.put_real(frame.can.*figure);
  put(out, frame.can.workspace);
  for (std::size_t i = 0; i < frame.name.size(); ++i)
    out.put(static_cast<std::uint8_t>(i + 1 < frame.name.size() ? frame.name[i] : 0));
}

bool get_description(ByteReader& in, DescriptionFrame& frame) {
  Numbers numbers{in};
  const auto bits = in.get<std::uint32_t>();
  for (std::size_t i = 0; i < std::size(kAbilities); ++i) frame.can.*kAbilities[i] = (bits >> i & 1u) != 0;
  for (const auto figure : kFigures) frame.can.*figure = numbers.positive();
  frame.can.workspace = numbers.vector(kMostMetres);
  for (char& letter : frame.name) letter = static_cast<char>(in.get<std::uint8_t>());
  frame.name.back() = 0;
  // Printed to terminals: nothing that steers them.
  for (char& letter : frame.name)
    if (letter != 0 && (static_cast<unsigned char>(letter) < 32 || letter == 127)) letter = '?';
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

bool get_state(ByteReader& in, StateFrame& frame) {
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
  return numbers.good && frame.sample.grip >= 0.0;
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

bool get_force(ByteReader& in, ForceFrame& frame) {
  Numbers numbers{in};
  frame.heard = in.get<std::uint32_t>();
  frame.has_model = (in.get<std::uint32_t>() & kHasModel) != 0;
  frame.wrench = numbers.wrench();
  frame.radius = numbers.positive();
  frame.model.position = numbers.vector(kMostMetres);
  frame.model.rotation = numbers.rotation();
  frame.model.wrench = numbers.wrench();
  for (const auto matrix : kMatrices) frame.model.*matrix = numbers.matrix();
  return numbers.good;
}

// Of all bytes, with the check sum itself as zeros.
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
  }
  return 0;
}

std::size_t write_frame(const NetworkFrame& frame, FrameBytes& into) {
  const std::size_t length = frame_length(frame.kind);
  ByteWriter out{std::span(into).first(length)};
  out.put(kFrameMagic);
  out.put(kFrameVersion);
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
  ByteWriter check{std::span(into).subspan(kCheckAt, 4)};
  check.put(check_of(std::span(into).first(length)));
  return length;
}

FrameFault parse_frame(std::span<const std::uint8_t> bytes, NetworkFrame& frame) {
  if (bytes.size() < kFrameHeader) return FrameFault::kTruncated;
  ByteReader in(bytes);
  if (in.get<std::uint32_t>() != kFrameMagic) return FrameFault::kForeign;
  if (in.get<std::uint8_t>() != kFrameVersion) return FrameFault::kVersion;
  NetworkFrame read;
  read.kind = static_cast<FrameKind>(in.get<std::uint8_t>());
  const std::size_t length = frame_length(read.kind);
  if (length == 0) return FrameFault::kKind;
  if (in.get<std::uint16_t>() != length || bytes.size() > length) return FrameFault::kLength;
  if (bytes.size() < length) return FrameFault::kTruncated;
  if (in.get<std::uint32_t>() != check_of(bytes)) return FrameFault::kCheck;
  read.session = in.get<std::uint32_t>();
  read.peer = in.get<std::uint32_t>();
  read.sequence = in.get<std::uint32_t>();
  read.time_us = in.get<std::uint64_t>();
  bool good = true;
  if (read.kind == FrameKind::kDescription) good = get_description(in, read.description);
  if (read.kind == FrameKind::kState) good = get_state(in, read.state);
  if (read.kind == FrameKind::kForce) good = get_force(in, read.force);
  if (!good || !in.ok()) return FrameFault::kValue;
  frame = read;
  return FrameFault::kNone;
}

}  // namespace pliant
