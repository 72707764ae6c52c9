// PNG and JPEG of libpng and libjpeg-turbo, 8 bits per channel, RGBA. A codec of another format is one more file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace pliant {

struct ImageSize {
  std::uint32_t width = 0, height = 0;
};

// Reads one picture from memory. Of a damaged file, functions return false and set `error`, without a full stop.
struct ImageCodec {
  // The size that the header claims.
  bool (*read_size)(std::span<const std::uint8_t> bytes, ImageSize& size, std::string& error);
  // `rgba`: 4 * width * height bytes of the size that the header claims, rows top to bottom.
  bool (*read_pixels)(std::span<const std::uint8_t> bytes, std::uint8_t* rgba, std::string& error);
};

extern const ImageCodec kPngCodec;
extern const ImageCodec kJpegCodec;

}  // namespace pliant
