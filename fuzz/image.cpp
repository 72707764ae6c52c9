// PNG and JPEG pictures: four bytes for every pixel, or an error of one sentence.
#include "content/files/image.h"

#include <cstddef>
#include <cstdint>

#include "runtime/assert.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto image = pliant::decode_image({data, size}, "picture");
  if (image)
    ASSERT(image->rgba.size() == std::size_t{4} * image->width * image->height);
  else
    ASSERT(!image.error().message().empty());
  return 0;
}
