#include "content/files/image.h"

#include <fmt/format.h>
#include <stb_image_write.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace {

// stb_image inflates a PNG's data regardless of the header's size: 2 MB can become 2 GB. The size of its memory blocks
// is limited during decoding. The limit is thread-local because stb's allocation functions have no user argument.
thread_local std::size_t t_largest_block = SIZE_MAX;  // [byte]
thread_local bool t_block_refused = false;

void* bounded_realloc(void* block, std::size_t size) {
  if (size <= t_largest_block) return std::realloc(block, size);
  t_block_refused = true;
  return nullptr;
}

}  // namespace

// Compiled in, not linked from Debian's library, to set these allocation functions.
#define STBI_MALLOC(size) bounded_realloc(nullptr, size)
#define STBI_REALLOC(block, size) bounded_realloc(block, size)
#define STBI_FREE(block) std::free(block)
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb_image.h>

namespace pliant {

namespace {

// The most pixels per byte of a file. Deflate expands up to 1030 times and a pixel has at least one bit; a JPEG block
// of 64 samples takes a few bits. A file that claims more is damaged and is rejected before allocation.
constexpr std::uint64_t kPixelsPerByte = 8300;

// Checks that every PNG chunk lies within the file: the decoder allocates the sizes that chunks claim.
bool png_chunks_fit(std::span<const std::uint8_t> bytes) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::uint64_t length = std::uint64_t{bytes[at]} << 24 | std::uint64_t{bytes[at + 1]} << 16 |
                                 std::uint64_t{bytes[at + 2]} << 8 | bytes[at + 3];
    if (length > bytes.size() - at - 12) return false;
    if (std::equal(bytes.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                   bytes.begin() + static_cast<std::ptrdiff_t>(at) + 8, "IEND"))
      return true;
    at += length + 12;
  }
  return false;
}

// Checks that every Huffman table of a JPEG has at most 256 codes; otherwise stb_image writes out of bounds. Segments
// are traversed as stb_image does. Between segments is scan data, where 0xff is a literal only if 0 follows.
bool jpeg_tables_fit(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kTables = 0xc4;
  const auto byte = [&](std::size_t at) { return at < bytes.size() ? std::size_t{bytes[at]} : 0; };
  for (std::size_t at = 2; at < bytes.size();) {
    while (at < bytes.size() && bytes[at] != 0xff) ++at;
    while (at < bytes.size() && bytes[at] == 0xff) ++at;
    const std::size_t marker = byte(at++);
    if (marker == 0 || (marker >= 0xd0 && marker <= 0xd9)) continue;  // scan data, or a marker without a payload
    const std::size_t end = at + std::max<std::size_t>(2, byte(at) << 8 | byte(at + 1));
    if (marker == kTables)
      for (std::size_t table = at + 2; table < end;) {
        std::size_t codes = 0;
        for (std::size_t length = 1; length <= 16; ++length) codes += byte(table + length);
        if (codes > 256) return false;
        table += 17 + codes;
      }
    at = end;
  }
  return true;
}

// Whether the file is safe to decode.
bool is_sound(std::span<const std::uint8_t> bytes) {
  switch (image_format(bytes)) {
    case ImageFormat::kPng:
      return png_chunks_fit(bytes);
    case ImageFormat::kJpeg:
      return jpeg_tables_fit(bytes);
    case ImageFormat::kUnknown:
      return false;
  }
  return false;
}

struct FreePixels {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

class BoundedBlocks {
 public:
  explicit BoundedBlocks(std::uint64_t largest) {
    t_largest_block = largest;
    t_block_refused = false;
  }
  ~BoundedBlocks() { t_largest_block = SIZE_MAX; }
  BoundedBlocks(const BoundedBlocks&) = delete;
  BoundedBlocks& operator=(const BoundedBlocks&) = delete;
  static bool refused() { return t_block_refused; }
};

// The largest block that decoding needs. Blocks grow by doubling up to the file's content or four channels of two
// bytes. A JPEG's planes are padded to blocks of 64 samples.
std::uint64_t largest_block(std::uint64_t file, std::uint64_t width, std::uint64_t height, bool two_bytes) {
  return 2 * file + (two_bytes ? 16 : 8) * (width + 64) * (height + 64);
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
  int width = 0, height = 0, channels = 0;
  if (bytes.size() > 0x7fffffff || !is_sound(bytes) ||
      !stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels))
    return 0;
  return std::uint64_t{4} * static_cast<std::uint64_t>(std::max(width, 0)) *
         static_cast<std::uint64_t>(std::max(height, 0));
}

Result<Image> decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (image_format(bytes) == ImageFormat::kUnknown)
    return Error{name, "is neither PNG nor JPEG", "convert the picture to one of them"};
  if (bytes.size() > 0x7fffffff) return Error{name, "is too large a picture", "use one below 2 GB"};
  if (!is_sound(bytes))
    return Error{
        name,
        fmt::format("is a {} that is cut off or damaged", image_format(bytes) == ImageFormat::kPng ? "PNG" : "JPEG"),
        "save it again"};
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) || width <= 0 || height <= 0)
    return Error{name, fmt::format("is a damaged picture ({})", stbi_failure_reason()), "save it again"};
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  const bool two_bytes = stbi_is_16_bit_from_memory(bytes.data(), size) != 0;
  const std::uint64_t allowed = most(limits::kPicturePixels) / (two_bytes ? 2 : 1);
  if (width > 16384 || height > 16384 || pixels > allowed)
    return Error{name, fmt::format("has {} x {} pixels, more than are read", width, height), "use at most 8192 x 8192"};
  if (pixels > bytes.size() * kPixelsPerByte)
    return Error{name, fmt::format("claims {} x {} pixels in {} bytes", width, height, size), "the picture is damaged"};
  const BoundedBlocks bounded(
      largest_block(bytes.size(), static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), two_bytes));
  const std::unique_ptr<stbi_uc, FreePixels> decoded(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4));
  if (!decoded && BoundedBlocks::refused())
    return Error{name, fmt::format("unpacks to far more than its {} x {} pixels", width, height), "save it again"};
  if (!decoded) return Error{name, fmt::format("is a damaged picture ({})", stbi_failure_reason()), "save it again"};
  Image image;
  image.name = name;
  image.width = static_cast<std::uint32_t>(width);
  image.height = static_cast<std::uint32_t>(height);
  image.rgba.assign(decoded.get(), decoded.get() + std::size_t{4} * image.width * image.height);
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
