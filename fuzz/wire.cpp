// Everything that a device may send over a network, a service or a cable. The first byte selects the parser. Output
// must be finite and in range, or absent.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "devices/drivers/falcon.h"
#include "devices/drivers/falcon_delta.h"
#include "devices/drivers/haply.h"
#include "devices/drivers/network_frame.h"
#include "devices/drivers/serial_line.h"
#include "devices/ports/bytes.h"
#include "devices/ports/crc32.h"
#include "devices/ports/udp_port.h"
#include "runtime/assert.h"

namespace {

using namespace pliant;

void check(const DeviceSample& sample) {
  for (int i = 0; i < 3; ++i) ASSERT(std::abs(sample.position[i]) <= 100.0);
  ASSERT(std::abs(glm::length(sample.rotation) - 1.0) < 1e-9);
  ASSERT(sample.grip >= 0.0 && sample.grip <= 1.0);
}

void frame(std::span<const std::uint8_t> bytes, bool mend) {
  FrameBytes copy{};
  if (mend && bytes.size() <= copy.size() && bytes.size() >= kFrameHeader) {  // otherwise checksums would never match
    std::copy(bytes.begin(), bytes.end(), copy.begin());
    for (std::size_t i = 8; i < 12; ++i) copy[i] = 0;
    ByteWriter sum{std::span(copy).subspan(8, 4)};
    sum.put(crc32(std::span(copy).first(bytes.size())));
    bytes = std::span(copy).first(bytes.size());
  }
  NetworkFrame read;
  if (parse_frame(bytes, read) != FrameFault::kNone) return;
  check(read.state.sample);
  ASSERT(read.description.name.back() == 0);
  for (int i = 0; i < 3; ++i) ASSERT(std::isfinite(read.force.wrench.force[i]));
  FrameBytes again;
  NetworkFrame twice;
  const std::size_t length = write_frame(read, again);
  ASSERT(length == bytes.size() && parse_frame(std::span(again).first(length), twice) == FrameFault::kNone);
}

void falcon(std::span<const std::uint8_t> bytes) {
  const auto report = parse_falcon(bytes);
  if (!report) return;
  const dvec3 angle(falcon_angle(report->count[0]), falcon_angle(report->count[1]), falcon_angle(report->count[2]));
  dvec3 position(0, 0, 0.125);
  if (!falcon_position(angle, position)) return;
  for (int i = 0; i < 3; ++i) ASSERT(std::abs(position[i]) < 0.5);
  for (const int motor : falcon_motors(position, {100, -50, 25})) ASSERT(std::abs(motor) <= 4095);
}

void serial(std::string_view text) {
  SerialLines lines;
  for (std::size_t at = 0; at < text.size(); at += 100) {
    lines.add(text.substr(at, 100));
    for (std::string_view line; lines.next(line);) {
      if (const auto pose = parse_serial_pose(line)) check(pose->sample);
      if (const auto who = parse_serial_identity(line)) ASSERT(who->axes >= 0 && who->axes <= 3);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span bytes(data + 1, size - 1);
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 6) {
    case 0:
      frame(bytes, false);
      break;
    case 1:
      frame(bytes, true);
      break;
    case 2:
      if (const auto state = parse_haply(text, "")) {
        check(state->sample);
      } else {
        ASSERT(!state.error().message().empty());
      }
      break;
    case 3:
      falcon(bytes);
      break;
    case 4:
      serial(text);
      break;
    default:
      if (const auto address = parse_udp_address(std::string(text))) ASSERT(!address->host.empty());
  }
  return 0;
}
