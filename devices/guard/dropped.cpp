// Counts of dropped frames as text.
#include <fmt/format.h>

#include "pliant/device_state.h"

namespace pliant {
namespace {

struct DroppedKind {
  std::uint64_t DroppedFrames::*count;
  const char *what, *cure;
};
constexpr DroppedKind kDroppedKinds[] = {
    {&DroppedFrames::too_short, "cut short", "send each frame whole, in one datagram or line"},
    {&DroppedFrames::unknown, "that are none of this protocol", "check who sends there, and the kind and length"},
    {&DroppedFrames::version, "of another version", "bring device and engine to the same version"},
    {&DroppedFrames::checksum, "with a wrong check sum", "compute the sum over the whole frame, and check the line"},
    {&DroppedFrames::number, "with a number that cannot be", "send finite numbers, in metres"},
    {&DroppedFrames::rotation, "with a rotation that is not of unit length", "normalise the quaternion, w first"},
    {&DroppedFrames::key, "without the right key", "give both sides the same key"},
    {&DroppedFrames::foreign, "from another address or session", "answer with the session that opened the device"},
    {&DroppedFrames::late, "doubled, overtaken or replayed", "count each frame up by one, with the time it was sensed"},
};

}  // namespace

std::string describe(const DroppedFrames& frames) {
  std::string text;
  for (const DroppedKind& kind : kDroppedKinds)
    if (const std::uint64_t count = frames.*kind.count; count > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, kind.what);
  return text;
}

std::string cure_for(const DroppedFrames& frames) {
  std::string text;
  for (const DroppedKind& kind : kDroppedKinds)
    if (frames.*kind.count > 0) text += std::string(text.empty() ? "" : "; ") + kind.cure;
  return text;
}

}  // namespace pliant
