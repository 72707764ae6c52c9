#include "content/files/exr_header.h"

#include <fmt/format.h>

#include <cstring>
#include <map>
#include <optional>

namespace pliant {

namespace {

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool fits(std::size_t count) const { return count <= bytes_.size() - at_; }
  bool at_end() const { return at_ == bytes_.size(); }
  std::optional<std::int32_t> integer() {
    if (!fits(4)) return std::nullopt;
    std::int32_t value;
    std::memcpy(&value, bytes_.data() + at_, 4);
    at_ += 4;
    return value;
  }
  // Null-terminated; at most 255 characters.
  std::optional<std::string> text() {
    std::string out;
    while (fits(1) && out.size() < 256) {
      const char c = static_cast<char>(bytes_[at_++]);
      if (c == 0) return out;
      out += c;
    }
    return std::nullopt;
  }
  std::span<const std::uint8_t> take(std::size_t count) {
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

// chlist: name, type (0 uint, 1 half, 2 float), linear flag and padding, x and y sampling; ended by an empty name.
bool read_channels(std::span<const std::uint8_t> value, ExrHeader& header) {
  ByteReader in(value);
  while (true) {
    const std::optional<std::string> name = in.text();
    if (!name) return false;
    if (name->empty()) return in.at_end();
    const std::optional<std::int32_t> type = in.integer();
    const std::optional<std::int32_t> flags = in.integer(), x = in.integer(), y = in.integer();
    if (!type || !flags || !x || !y || *type < 0 || *type > 2 || *x < 1 || *y < 1) return false;
    header.channels[*name] = *type == 1 ? 2 : 4;
  }
}

// Size of a value of this type, where the type fixes it. The library reads this many bytes whatever size the attribute
// claims. It would then parse the remaining bytes as attributes of any size.
std::optional<std::size_t> size_of(const std::string& type) {
  static const std::map<std::string, std::size_t> sizes = {{"box2f", 16},
                                                           {"box2i", 16},
                                                           {"chromaticities", 32},
                                                           {"compression", 1},
                                                           {"deepImageState", 1},
                                                           {"double", 8},
                                                           {"envmap", 1},
                                                           {"float", 4},
                                                           {"int", 4},
                                                           {"keycode", 28},
                                                           {"lineOrder", 1},
                                                           {"m33d", 72},
                                                           {"m33f", 36},
                                                           {"m44d", 128},
                                                           {"m44f", 64},
                                                           {"rational", 8},
                                                           {"tiledesc", 9},
                                                           {"timecode", 8},
                                                           {"v2d", 16},
                                                           {"v2f", 8},
                                                           {"v2i", 8},
                                                           {"v3d", 24},
                                                           {"v3f", 12},
                                                           {"v3i", 12}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? std::nullopt : std::optional(found->second);
}

// stringvector: length and characters, repeated.
bool read_strings(std::span<const std::uint8_t> value) {
  ByteReader in(value);
  while (!in.at_end()) {
    const std::optional<std::int32_t> length = in.integer();
    if (!length || *length < 0 || !in.fits(static_cast<std::size_t>(*length))) return false;
    in.take(static_cast<std::size_t>(*length));
  }
  return true;
}

}  // namespace

Result<ExrHeader> read_exr_header(std::span<const std::uint8_t> bytes, const std::string& name) {
  const auto damaged = [&](const std::string& what) { return Error{name, what, "the file is damaged, save it again"}; };
  ByteReader in(bytes);
  const std::optional<std::int32_t> magic = in.integer(), version = in.integer();
  if (!magic || !version || *magic != 20000630)
    return Error{name, "is no OpenEXR file", "convert the panorama to .exr"};
  ExrHeader header;
  header.deep = (*version & 0x800) != 0;
  const bool multi_part = (*version & 0x1000) != 0;
  bool has_window = false, has_channels = false;
  // Part headers, each terminated by an empty name; another empty name follows the last.
  for (int part = 0; part < 64; ++part) {
    std::optional<std::string> attribute = in.text();
    if (!attribute) return damaged("ends within its header");
    if (attribute->empty() && part > 0) break;
    for (; attribute && !attribute->empty(); attribute = in.text()) {
      const std::optional<std::string> type = in.text();
      const std::optional<std::int32_t> size = in.integer();
      if (!type || !size || *size < 0 || !in.fits(static_cast<std::size_t>(*size)))
        return damaged("has an attribute that runs past its end");
      const std::span<const std::uint8_t> value = in.take(static_cast<std::size_t>(*size));
      if (const std::optional<std::size_t> right = size_of(*type); right && *right != value.size())
        return damaged("has an attribute `" + *attribute + "` of another size than its type " + *type);
      if (*type == "stringvector" && !read_strings(value)) return damaged("has a list of texts that runs past its end");
      if (*type == "chlist" || *attribute == "channels") {
        ExrHeader elsewhere;
        const bool ours = part == 0 && *attribute == "channels";
        if (*type != "chlist" || !read_channels(value, ours ? header : elsewhere))
          return damaged("has a channel list that cannot be read");
        has_channels |= ours;
      }
      ByteReader fields(value);
      if (*type == "preview") {
        const std::optional<std::int32_t> width = fields.integer(), height = fields.integer();
        if (!width || !height || *width < 0 || *height < 0 ||
            static_cast<std::uint64_t>(*width) * static_cast<std::uint64_t>(*height) * 4 + 8 != value.size())
          return damaged("has a preview of another size than it says");
      }
      if (part > 0) continue;
      if (*attribute == "dataWindow") {
        const std::optional<std::int32_t> x0 = fields.integer(), y0 = fields.integer(), x1 = fields.integer(),
                                          y1 = fields.integer();
        if (!y1) return damaged("has a data window that cannot be read");
        header.width = std::int64_t{*x1} - *x0 + 1;
        header.height = std::int64_t{*y1} - *y0 + 1;
        has_window = true;
      }
      if (*attribute == "type") header.deep |= std::string(value.begin(), value.end()).rfind("deep", 0) == 0;
    }
    if (!attribute) return damaged("ends within its header");
    if (!multi_part) break;
  }
  if (!has_window || !has_channels || header.width < 1 || header.height < 1)
    return damaged("has no data window or no channels");
  return header;
}

}  // namespace pliant
