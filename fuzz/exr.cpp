// OpenEXR panoramas: finite light for every pixel, or an error of one sentence.
#include "content/files/exr.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "runtime/assert.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto panorama = pliant::decode_panorama({data, size}, "panorama");
  if (!panorama) {
    ASSERT(!panorama.error().message().empty());
    return 0;
  }
  ASSERT(panorama->rgb.size() == std::size_t{3} * panorama->width * panorama->height);
  for (const float value : panorama->rgb) ASSERT(std::isfinite(value) && value >= 0.0f);
  return 0;
}
