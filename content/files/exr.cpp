#include "content/files/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfRgbaFile.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <exception>
#include <mutex>

#include "content/files/exr_header.h"
#include "content/files/file_io.h"

namespace pliant {

namespace {

// OpenEXR compresses a flat colour less than this. A file that claims more pixels is damaged.
constexpr std::int64_t kExrPixelsPerByte = 256, kFreePixels = 1 << 16;
// The library keeps up to 256 rows of all channels in memory at once.
constexpr std::int64_t kMaxRowBlock = std::int64_t{256} << 20;  // [byte]

class MemoryStream final : public Imf::IStream {
 public:
  MemoryStream(std::span<const std::uint8_t> bytes, const std::string& name)
      : Imf::IStream(name.c_str()), bytes_(bytes) {}
  bool read(char out[], int count) override {
    if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.size() - at_)
      throw std::runtime_error("unexpected end of file");
    std::memcpy(out, bytes_.data() + at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("unexpected end of file");
    at_ = static_cast<std::size_t>(position);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

Status check_header(const ExrHeader& header, std::size_t size, const std::string& name) {
  if (header.deep) return Error{name, "holds deep samples instead of a flat picture", "flatten it"};
  if (header.width > kMaxPanoramaWidth || header.height > kMaxPanoramaHeight ||
      static_cast<std::uint64_t>(header.width * header.height) > most(limits::kPanoramaPixels))
    return Error{
        name, fmt::format("has {} x {} pixels", header.width, header.height),
        fmt::format("use at most {} x {}", kMaxPanoramaWidth, most(limits::kPanoramaPixels) / kMaxPanoramaWidth)};
  if (header.width * header.height > kFreePixels + kExrPixelsPerByte * static_cast<std::int64_t>(size))
    return Error{name, fmt::format("claims {} x {} pixels in {} bytes", header.width, header.height, size),
                 "the file is damaged"};
  std::int64_t pixel = 0;
  for (const auto& [channel, bytes] : header.channels) pixel += bytes;
  if (pixel * header.width * 256 > kMaxRowBlock) return Error{name, "has too many channels", "keep R, G and B"};
  return Done{};
}

// Luminance and subsampled chroma: the library's filter reconstructs the colour.
void read_chroma(Imf::IStream& stream, const ExrHeader& header, Panorama& out) {
  Imf::RgbaInputFile file(stream, 0);
  const Imath::Box2i window = file.dataWindow();
  std::vector<Imf::Rgba> pixels(static_cast<std::size_t>(header.width * header.height));
  Imf::Rgba* origin = pixels.data() - window.min.x - static_cast<std::ptrdiff_t>(window.min.y) * header.width;
  file.setFrameBuffer(origin, 1, static_cast<std::size_t>(header.width));
  file.readPixels(window.min.y, window.max.y);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    out.rgb[3 * i] = pixels[i].r;
    out.rgb[3 * i + 1] = pixels[i].g;
    out.rgb[3 * i + 2] = pixels[i].b;
  }
}

// Reads channels by name as floats; missing channels are 0.
void read_channels(Imf::IStream& stream, const ExrHeader& header, bool luminance, Panorama& out) {
  Imf::InputFile file(stream, 0);
  const Imath::Box2i window = file.header().dataWindow();
  const std::size_t x_step = 3 * sizeof(float), y_step = x_step * static_cast<std::size_t>(header.width);
  char* origin = reinterpret_cast<char*>(out.rgb.data()) - static_cast<std::ptrdiff_t>(x_step) * window.min.x -
                 static_cast<std::ptrdiff_t>(y_step) * window.min.y;
  Imf::FrameBuffer frame;
  if (luminance)
    frame.insert("Y", Imf::Slice(Imf::FLOAT, origin, x_step, y_step));
  else
    for (int c = 0; c < 3; ++c)
      frame.insert(
          std::string(1, "RGB"[c]),
          Imf::Slice(Imf::FLOAT, origin + c * static_cast<std::ptrdiff_t>(sizeof(float)), x_step, y_step, 1, 1, 0.0));
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  if (luminance)
    for (std::size_t i = 0; i < out.rgb.size(); i += 3) out.rgb[i + 1] = out.rgb[i + 2] = out.rgb[i];
}

}  // namespace

Result<Panorama> decode_panorama(std::span<const std::uint8_t> bytes, const std::string& name,
                                 std::vector<std::string>* notes) {
  const Result<ExrHeader> header = read_exr_header(bytes, name);
  if (!header) return header.error();
  if (const Status status = check_header(*header, bytes.size(), name); !status) return status.error();
  const auto has = [&](const char* channel) { return header->channels.count(channel) != 0; };
  const bool color = has("R") || has("G") || has("B"), luminance = !color && has("Y");
  if (!color && !luminance) return Error{name, "has neither R, G, B nor luminance (Y)", "save it as an RGB picture"};

  static std::once_flag limited;
  std::call_once(limited, [] {
    Imf::Header::setMaxImageSize(static_cast<int>(kMaxPanoramaWidth), static_cast<int>(kMaxPanoramaHeight));
    Imf::Header::setMaxTileSize(2048, 2048);
  });
  Panorama out;
  try {
    out.name = name;
    out.width = static_cast<std::uint32_t>(header->width);
    out.height = static_cast<std::uint32_t>(header->height);
    out.rgb.assign(std::size_t{3} * out.width * out.height, 0.0f);
    MemoryStream stream(bytes, name);
    if (luminance && has("RY") && has("BY"))
      read_chroma(stream, *header, out);
    else
      read_channels(stream, *header, luminance, out);
  } catch (const std::exception& e) {
    std::string what = e.what();
    for (char& c : what)
      if (c == '\n') c = ' ';
    return Error{name, "is a damaged OpenEXR file (" + what.substr(0, 200) + ")", "save it again"};
  }
  std::size_t mended = 0;
  for (float& value : out.rgb)
    if (!(std::isfinite(value) && value >= 0.0f)) {
      value = 0.0f;
      ++mended;
    }
  if (mended > 0 && notes)
    notes->push_back(fmt::format("{}: {} values that were infinite, negative or no number are 0", name, mended));
  return out;
}

Result<Panorama> load_named_panorama(const std::filesystem::path& folder, const std::string& name,
                                     std::vector<std::string>* notes) {
  constexpr std::string_view kShared = "../environments/";
  const bool shared = name.starts_with(kShared);
  const Result<std::filesystem::path> path =
      shared ? confined_path(folder / kShared, name.substr(kShared.size())) : confined_path(folder, name);
  if (!path) return path.error();
  return load_panorama(*path, notes);
}

Result<Panorama> load_panorama(const std::filesystem::path& path, std::vector<std::string>* notes) {
  const Result<Bytes> bytes = read_file(path, limits::kPictureFile);
  if (!bytes) return bytes.error();
  return decode_panorama(*bytes, path.string(), notes);
}

}  // namespace pliant
