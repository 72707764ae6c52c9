// PNG by libpng. Sixteen bits are cut to eight, palettes and grey are expanded, gamma is left as it is
// (glTF 2.0, 3.8.1).
#include <png.h>

#include <algorithm>
#include <vector>

#include "content/files/image_codec.h"

namespace pliant {
namespace {

// State of libpng's functions. Its errors jump over frames of C, so that no object here may have a destructor between.
struct PngFile {
  std::span<const std::uint8_t> rest;
  char error[120] = {};
};

void png_failed(png_structp png, png_const_charp message) {
  auto& file = *static_cast<PngFile*>(png_get_error_ptr(png));
  std::copy_n(message, std::min(std::char_traits<char>::length(message), sizeof file.error - 1), file.error);
  png_longjmp(png, 1);
}

void png_read_bytes(png_structp png, png_bytep out, std::size_t count) {
  auto& rest = static_cast<PngFile*>(png_get_io_ptr(png))->rest;
  if (count > rest.size()) png_error(png, "it is cut off");
  std::copy_n(rest.begin(), count, out);
  rest = rest.subspan(count);
}

void png_as_rgba(png_structp png, png_infop info) {
  png_set_expand(png);
  png_set_strip_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
}

// Reads the header, and the pixels where `rows` are given.
bool png_read(PngFile& file, ImageSize& size, png_bytepp rows) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &file, png_failed, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &file, png_read_bytes);
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff);  // the caller limits it, with a sentence
  png_read_info(png, info);
  size = {png_get_image_width(png, info), png_get_image_height(png, info)};
  if (rows) {
    png_as_rgba(png, info);
    if (png_get_rowbytes(png, info) != std::size_t{4} * size.width) png_error(png, "its channels are unknown");
    png_read_image(png, rows);
    png_read_end(png, nullptr);
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

bool png_size(std::span<const std::uint8_t> bytes, ImageSize& size, std::string& error) {
  PngFile file{bytes};
  const bool ok = png_read(file, size, nullptr);
  error = file.error;
  return ok;
}

bool png_pixels(std::span<const std::uint8_t> bytes, std::uint8_t* rgba, std::string& error) {
  ImageSize size;
  if (!png_size(bytes, size, error)) return false;
  std::vector<png_bytep> rows(size.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = rgba + y * 4 * size.width;
  PngFile file{bytes};
  const bool ok = png_read(file, size, rows.data());
  error = file.error;
  return ok;
}

}  // namespace

const ImageCodec kPngCodec{png_size, png_pixels};

}  // namespace pliant
