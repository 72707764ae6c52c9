#include "runtime/printable.h"

#include <cstdint>
#include <cstdio>

namespace pliant {
namespace {

// The code point at the beginning of `text` and its length in bytes; 0 bytes: not valid UTF-8 (RFC 3629).
struct Decoded {
  std::uint32_t point = 0;
  std::size_t bytes = 0;
};
Decoded decode(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t bytes = first >= 0xf8 ? 0 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 0;
  if (bytes == 0 || text.size() < bytes) return {};
  std::uint32_t point = first & (0x7fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0u) != 0x80u) return {};
    point = point << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // below it: an overlong form
  const bool surrogate = point >= 0xd800 && point <= 0xdfff;
  return point < kLeast[bytes] || point > 0x10ffff || surrogate ? Decoded{} : Decoded{point, bytes};
}

// Unicode 15: C1 controls, Bidi_Control, line and paragraph separators.
bool acts(std::uint32_t point) {
  return (point >= 0x80 && point <= 0x9f) || point == 0x61c || point == 0x200e || point == 0x200f ||
         (point >= 0x2028 && point <= 0x202e) || (point >= 0x2066 && point <= 0x2069);
}

void escape(std::string& out, const char* format, std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, format, static_cast<unsigned>(value));
  out += text;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Decoded c = decode(text);
    if (c.bytes == 0)
      escape(out, "\\x%02x", static_cast<unsigned char>(text[0]));
    else if (c.point == '\n')
      out += "\\n";
    else if (c.point == '\r')
      out += "\\r";
    else if (c.point == '\t')
      out += "\\t";
    else if (c.point < 0x20 || c.point == 0x7f)
      escape(out, "\\x%02x", c.point);
    else if (acts(c.point))
      escape(out, "\\u%04x", c.point);
    else
      out += text.substr(0, c.bytes);
    text.remove_prefix(c.bytes == 0 ? 1 : c.bytes);
  }
  return out;
}

}  // namespace pliant
