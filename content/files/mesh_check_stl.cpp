// STL: 80 bytes, a count and 50 bytes per triangle; or text, facet by facet.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "content/files/mesh_check.h"
#include "content/tets/tet_text.h"

namespace pliant {
namespace {

constexpr std::size_t kHead = 84, kTriangle = 50;  // [byte]

// A binary file may also begin with `solid`, but soon has bytes that are not text.
bool is_text(const Bytes& bytes) {
  const auto begin = std::find_if_not(bytes.begin(), bytes.end(), [](std::uint8_t c) { return std::isspace(c); });
  if (bytes.end() - begin < 5 || std::memcmp(&*begin, "solid", 5) != 0) return false;
  return std::find(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size(), 512)),
                   0) == bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size(), 512));
}

Status check_binary(Bytes& bytes) {
  if (bytes.size() < kHead) return Error{"", "ends within its header", "the file is cut off"};
  std::uint32_t count = 0;
  std::memcpy(&count, &bytes[80], 4);
  const std::uint64_t size = kHead + kTriangle * std::uint64_t{count};
  // A few extra bytes are padding; extra whole triangles mean that the count or the data is wrong.
  if (bytes.size() < size || bytes.size() >= size + kTriangle)
    return Error{"", fmt::format("says {} triangles but has {}", count, (bytes.size() - kHead) / kTriangle),
                 "the file is cut off or damaged"};
  bytes.resize(size);
  return Done{};
}

Status check_text(const Bytes& bytes) {
  TetText text(bytes, "");
  std::string_view word, line;
  std::uint64_t facet = 0;
  const auto broken = [&facet](const char* what) {
    return Error{"", fmt::format("{} in facet {}", what, facet), "the file is cut off or damaged"};
  };
  const auto expect = [&](const char* wanted) { return text.word(word) && word == wanted; };
  const auto numbers = [&] {
    double value = 0.0;
    return text.number(value) && text.number(value) && text.number(value);
  };
  bool open = false;  // between solid and endsolid
  while (text.word(word)) {
    if (word == "solid" && !open) {
      open = true;
      text.line(line);  // the name
    } else if (word == "endsolid" && open) {
      open = false;
      text.line(line);
    } else if (word == "facet" && open) {
      // Normals that are not numbers are recomputed.
      if (!expect("normal") || !text.word(word) || !text.word(word) || !text.word(word))
        return broken("lacks a normal");
      if (!expect("outer") || !expect("loop")) return broken("lacks `outer loop`");
      for (int corner = 0; corner < 3; ++corner)
        if (!expect("vertex") || !numbers()) return broken("lacks three vertices of three numbers");
      if (!expect("endloop") || !expect("endfacet")) return broken("has another number of vertices than three");
      ++facet;
    } else {
      return broken("has an unknown word");
    }
  }
  if (open) return Error{"", fmt::format("ends without `endsolid` after {} facets", facet), "the file is cut off"};
  return Done{};
}

}  // namespace

Status check_stl(Bytes& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHead) std::memcpy(&count, &bytes[80], 4);
  const bool exact = bytes.size() == kHead + kTriangle * std::uint64_t{count};
  return !exact && is_text(bytes) ? check_text(bytes) : check_binary(bytes);
}

}  // namespace pliant
