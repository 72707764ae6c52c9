// PNG and JPEG pictures, 8 bits a channel, to and from memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "components/appearance.h"
#include "content/files/file_io.h"
#include "runtime/result.h"

namespace pliant {

enum class ImageFormat { kUnknown, kPng, kJpeg };
ImageFormat image_format(std::span<const std::uint8_t> bytes);  // by signature
// [byte] That the picture takes when it is decoded, by its header; 0: no picture, which decode_image will say.
std::uint64_t decoded_size(std::span<const std::uint8_t> bytes);

// At most limits::kPicturePixels, at most 16384 on a side; sizes are checked against the header before anything is
// allocated.
Result<Image> decode_image(std::span<const std::uint8_t> bytes, const std::string& name);
Result<Image> load_image(const std::filesystem::path& path);

// Lossless. `rgba` is width*height*4 bytes, rows top to bottom.
Bytes encode_png(std::uint32_t width, std::uint32_t height, const std::uint8_t* rgba);

}  // namespace pliant
