// Recordings: whole ticks of sound poses, or an error of one sentence.
#include "engine/run/recording.h"

#include <cstddef>
#include <cstdint>
#include <string>

#include "runtime/assert.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The hash is checked last, so that the earlier checks are exercised.
  const auto recording = pliant::parse_recording("recording", std::string(reinterpret_cast<const char*>(data), size));
  if (!recording) {
    ASSERT(!recording.error().message().empty());
    return 0;
  }
  ASSERT(recording->poses.size() == recording->ticks.size() * recording->header.probes.size());
  return 0;
}
