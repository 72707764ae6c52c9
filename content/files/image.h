// Decodes and encodes PNG and JPEG pictures, 8 bits per channel, in memory.
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
// [byte] Size of the decoded picture, from its header. 0: not a picture; decode_image reports it.
std::uint64_t decoded_size(std::span<const std::uint8_t> bytes);

// At most limits::kPicturePixels, at most 16384 per side. Sizes are checked against the header before allocation.
Result<Image> decode_image(std::span<const std::uint8_t> bytes, const std::string& name);
Result<Image> load_image(const std::filesystem::path& path);

// Lossless. `rgba` is width*height*4 bytes, rows top to bottom.
Bytes encode_png(std::uint32_t width, std::uint32_t height, const std::uint8_t* rgba);

}  // namespace pliant
