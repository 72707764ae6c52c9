#include "content/files/image.h"

#include <fmt/format.h>
#include <stb_image_write.h>

#include <algorithm>

#include "content/files/image_codec.h"

namespace pliant {

namespace {

// The most pixels per byte of a file. Deflate expands up to 1030 times and a pixel has at least one bit; a JPEG block
// of 64 samples takes a few bits. A file that claims more is damaged and is rejected before allocation.
constexpr std::uint64_t kPixelsPerByte = 8300;

const ImageCodec& codec(ImageFormat format) {
  return format == ImageFormat::kPng ? kPngCodec : kJpegCodec;
}

}  // namespace

ImageFormat image_format(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kPng[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr std::uint8_t kJpeg[] = {0xff, 0xd8, 0xff};
  if (bytes.size() >= 8 && std::equal(std::begin(kPng), std::end(kPng), bytes.begin())) return ImageFormat::kPng;
  if (bytes.size() >= 3 && std::equal(std::begin(kJpeg), std::end(kJpeg), bytes.begin())) return ImageFormat::kJpeg;
  return ImageFormat::kUnknown;
}

std::uint64_t decoded_size(std::span<const std::uint8_t> bytes) {
  const ImageFormat format = image_format(bytes);
  ImageSize size;
  std::string error;
  if (format == ImageFormat::kUnknown || !codec(format).read_size(bytes, size, error)) return 0;
  return std::uint64_t{4} * size.width * size.height;
}

Result<Image> decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
  const ImageFormat format = image_format(bytes);
  if (format == ImageFormat::kUnknown)
    return Error{name, "is neither PNG nor JPEG", "convert the picture to one of them"};
  const auto damaged = [&](const std::string& error) {
    return Error{name, fmt::format("is a damaged {} ({})", format == ImageFormat::kPng ? "PNG" : "JPEG", error),
                 "save it again"};
  };
  ImageSize size;
  std::string error;
  if (!codec(format).read_size(bytes, size, error)) return damaged(error);
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  if (size.width > 16384 || size.height > 16384 || pixels > most(limits::kPicturePixels))
    return Error{name, fmt::format("has {} x {} pixels, more than are read", size.width, size.height),
                 "use at most 8192 x 8192"};
  if (pixels > bytes.size() * kPixelsPerByte)
    return Error{name, fmt::format("claims {} x {} pixels in {} bytes", size.width, size.height, bytes.size()),
                 "the picture is damaged"};
  Image image;
  image.name = name;
  image.width = size.width;
  image.height = size.height;
  image.rgba.resize(std::size_t{4} * size.width * size.height);
  if (!codec(format).read_pixels(bytes, image.rgba.data(), error)) return damaged(error);
  return image;
}

Result<Image> load_image(const std::filesystem::path& path) {
  Result<Bytes> bytes = read_file(path, limits::kPictureFile);
  if (!bytes) return bytes.error();
  return decode_image(*bytes, path.string());
}

Bytes encode_png(std::uint32_t width, std::uint32_t height, const std::uint8_t* rgba) {
  Bytes png;
  const auto append = [](void* out, void* data, int size) {
    const auto* begin = static_cast<const std::uint8_t*>(data);
    static_cast<Bytes*>(out)->insert(static_cast<Bytes*>(out)->end(), begin, begin + size);
  };
  stbi_write_png_to_func(append, &png, static_cast<int>(width), static_cast<int>(height), 4, rgba,
                         static_cast<int>(width * 4));
  return png;
}

}  // namespace pliant
