// JPEG by libjpeg-turbo: baseline and progressive, grey, colour and CMYK as Adobe writes it (inverted).
// clang-format off
#include <cstdio>  // jpeglib.h needs it
#include <jpeglib.h>
#include <jerror.h>
// clang-format on

#include <algorithm>
#include <csetjmp>
#include <vector>

#include "content/files/image_codec.h"

namespace pliant {
namespace {

// A progressive file of a few kilobytes can have thousands of scans over all of its pixels.
constexpr int kMostScans = 100;

// libjpeg's errors jump over frames of C, so that no object here may have a destructor between.
struct JpegFile {
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf back;
  char error[JMSG_LENGTH_MAX] = {};
};

[[noreturn]] void jpeg_failed(j_common_ptr info) {
  auto& file = *static_cast<JpegFile*>(info->client_data);
  info->err->format_message(info, file.error);
  std::longjmp(file.back, 1);
}

// Warnings that mean lost pixels are errors; the others are harmless.
void jpeg_warned(j_common_ptr info, int level) {
  constexpr int kLost[] = {JWRN_HIT_MARKER, JWRN_HUFF_BAD_CODE, JWRN_JPEG_EOF, JWRN_MUST_RESYNC,
                           JWRN_BOGUS_PROGRESSION};
  if (level < 0 && std::find(std::begin(kLost), std::end(kLost), info->err->msg_code) != std::end(kLost))
    jpeg_failed(info);
}

void jpeg_progressed(j_common_ptr info) {
  auto& file = *static_cast<JpegFile*>(info->client_data);
  if (file.info.input_scan_number <= kMostScans) return;
  std::snprintf(file.error, sizeof file.error, "more than %d scans", kMostScans);
  std::longjmp(file.back, 1);
}

void jpeg_rows(JpegFile& file, std::uint8_t* rgba, std::uint8_t* cmyk_row) {
  jpeg_decompress_struct& info = file.info;
  const bool cmyk = info.num_components == 4;
  info.out_color_space = cmyk ? JCS_CMYK : JCS_EXT_RGBA;
  jpeg_start_decompress(&info);
  while (info.output_scanline < info.output_height) {
    std::uint8_t* row = rgba + std::size_t{4} * info.output_width * info.output_scanline;
    JSAMPROW into = cmyk ? cmyk_row : row;
    jpeg_read_scanlines(&info, &into, 1);
    for (std::size_t i = 0; cmyk && i < std::size_t{4} * info.output_width; i += 4) {
      for (std::size_t c = 0; c < 3; ++c) row[i + c] = static_cast<std::uint8_t>(into[i + c] * into[i + 3] / 255);
      row[i + 3] = 0xff;
    }
  }
  jpeg_finish_decompress(&info);
}

// Reads the header, and the pixels where `rgba` is given. `cmyk_row`: 4 bytes per pixel of a row.
bool jpeg_read(JpegFile& file, std::span<const std::uint8_t> bytes, ImageSize& size, std::uint8_t* rgba,
               std::uint8_t* cmyk_row) {
  jpeg_decompress_struct& info = file.info;
  info.err = jpeg_std_error(&file.errors);
  info.client_data = &file;
  file.errors.error_exit = jpeg_failed;
  file.errors.emit_message = jpeg_warned;
  file.progress.progress_monitor = jpeg_progressed;
  if (setjmp(file.back)) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_create_decompress(&info);
  info.progress = &file.progress;
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  jpeg_read_header(&info, TRUE);
  size = {info.image_width, info.image_height};
  if (rgba) jpeg_rows(file, rgba, cmyk_row);
  jpeg_destroy_decompress(&info);
  return true;
}

bool jpeg_size(std::span<const std::uint8_t> bytes, ImageSize& size, std::string& error) {
  JpegFile file;
  const bool ok = jpeg_read(file, bytes, size, nullptr, nullptr);
  error = file.error;
  return ok;
}

bool jpeg_pixels(std::span<const std::uint8_t> bytes, std::uint8_t* rgba, std::string& error) {
  ImageSize size;
  if (!jpeg_size(bytes, size, error)) return false;
  std::vector<std::uint8_t> cmyk_row(std::size_t{4} * size.width);
  JpegFile file;
  const bool ok = jpeg_read(file, bytes, size, rgba, cmyk_row.data());
  error = file.error;
  return ok;
}

}  // namespace

const ImageCodec kJpegCodec{jpeg_size, jpeg_pixels};

}  // namespace pliant
