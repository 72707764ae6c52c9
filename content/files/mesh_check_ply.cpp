// PLY: a header of elements and their properties, then the elements, one per line or in binary.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "content/files/mesh_check.h"
#include "content/tets/tet_text.h"

namespace pliant {
namespace {

enum class Kind { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct Property {
  std::string name;
  Kind kind = Kind::kFloat, count_kind = Kind::kUint8;
  bool list = false;
  bool axis = false;      // x, y or z
  bool vertices = false;  // the list holds vertex indices
};
struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};
struct PlyHeader {
  std::vector<Element> elements;
  std::int64_t vertices = 0;
};

bool kind_of(std::string_view word, Kind& kind) {
  constexpr std::pair<const char*, Kind> kWords[] = {
      {"char", Kind::kInt8},      {"int8", Kind::kInt8},     {"uchar", Kind::kUint8},   {"uint8", Kind::kUint8},
      {"short", Kind::kInt16},    {"int16", Kind::kInt16},   {"ushort", Kind::kUint16}, {"uint16", Kind::kUint16},
      {"int", Kind::kInt32},      {"int32", Kind::kInt32},   {"uint", Kind::kUint32},   {"uint32", Kind::kUint32},
      {"float", Kind::kFloat},    {"float32", Kind::kFloat}, {"double", Kind::kDouble}, {"float64", Kind::kDouble},
      {"double64", Kind::kDouble}};
  for (const auto& [name, value] : kWords)
    if (word == name) return kind = value, true;
  return false;
}

std::uint64_t size_of(Kind kind) {
  constexpr std::uint64_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(kind)];
}

Error damaged(const std::string& what) {
  return {"", what, "the file is cut off or damaged"};
}

// Reads the header, and the encoding of the body: text or binary, and its byte order.
Result<PlyHeader> read_ply_header(TetText& text) {
  PlyHeader header;
  std::string_view line;
  const std::uint64_t bytes = text.left();
  bool has_format = false;
  if (!text.line(line) || line != "ply") return Error{"", "does not begin with `ply`", "check the format"};
  while (text.line(line)) {
    TetText words({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, "");
    std::string_view key, word;
    if (!words.word(key) || key == "comment" || key == "obj_info") continue;
    if (key == "end_header") {
      if (!has_format) return Error{"", "says no format in its header", "export it again"};
      return header;
    }
    if (!words.word(word)) return damaged("has an incomplete line in its header");
    if (key == "format") {
      has_format = true;
      if (word != "ascii" && word != "binary_little_endian" && word != "binary_big_endian")
        return Error{"", fmt::format("has the unknown format '{}'", word.substr(0, 40)), "export it again"};
      text.set_binary(word != "ascii", word == "binary_big_endian");
    } else if (key == "element") {
      Element element{std::string(word), 0, {}};
      if (!words.integer(element.count) || element.count < 0)
        return damaged("has an element without a number in its header");
      if (static_cast<std::uint64_t>(element.count) > bytes)
        return Error{"", fmt::format("claims {} elements in {} bytes", element.count, bytes), "the file is damaged"};
      if (element.name == "vertex") header.vertices = element.count;
      header.elements.push_back(std::move(element));
    } else if (key == "property" && !header.elements.empty()) {
      Property property;
      property.list = word == "list";
      bool known = property.list ? words.word(word) && kind_of(word, property.count_kind) && words.word(word) &&
                                       kind_of(word, property.kind)
                                 : kind_of(word, property.kind);
      known = known && words.word(word);
      if (!known) return Error{"", "has a property of an unknown type in its header", "export it again"};
      property.name = word;
      property.axis = !property.list && (word == "x" || word == "y" || word == "z");
      property.vertices = property.list && (word == "vertex_index" || word == "vertex_indices");
      header.elements.back().properties.push_back(std::move(property));
    }
  }
  return damaged("ends within its header");
}

// Reads values of one element, from its line or from the binary body.
class PlyRow {
 public:
  PlyRow(TetText& text, std::string_view line) : binary_(text.binary()), body_(text), line_(as_bytes(line), "") {}
  // False: no more values. In text, a word that is not a finite number becomes NaN.
  bool value(Kind kind, double& out) {
    if (binary_) return raw(kind, out);
    std::string_view word;
    if (!line_.word(word)) return false;
    if (!to_number(word, out)) out = NAN;
    return true;
  }

 private:
  static std::span<const std::uint8_t> as_bytes(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
  }
  template <class T>
  bool raw_as(double& out) {
    T value;
    if (!body_.raw(value)) return false;
    out = static_cast<double>(value);
    return true;
  }
  bool raw(Kind kind, double& out) {
    switch (kind) {
      case Kind::kInt8:
        return raw_as<std::int8_t>(out);
      case Kind::kUint8:
        return raw_as<std::uint8_t>(out);
      case Kind::kInt16:
        return raw_as<std::int16_t>(out);
      case Kind::kUint16:
        return raw_as<std::uint16_t>(out);
      case Kind::kInt32:
        return raw_as<std::int32_t>(out);
      case Kind::kUint32:
        return raw_as<std::uint32_t>(out);
      case Kind::kFloat:
        return raw_as<float>(out);
      case Kind::kDouble:
        return raw_as<double>(out);
    }
    return false;
  }
  bool binary_;
  TetText& body_;
  TetText line_;
};

Status check_row(PlyRow& row, const Element& element, std::int64_t number, const PlyHeader& header) {
  const auto cut = [&] { return damaged(fmt::format("has too few numbers for {} {}", element.name, number)); };
  const bool strip = element.name == "tristrips";  // in a strip, -1 begins another one
  for (const Property& property : element.properties) {
    double count = 1.0, value = 0.0;
    if (property.list && !row.value(property.count_kind, count)) return cut();
    if (!(count >= 0.0) || count != static_cast<double>(static_cast<std::int64_t>(std::min(count, 1e15))))
      return damaged(fmt::format("has a list of {} numbers in {} {}", count, element.name, number));
    if (property.vertices && count == 0.0)
      return Error{"", fmt::format("has {} {} without a corner", element.name, number), "export it again"};
    for (double i = 0.0; i < count; ++i) {
      if (!row.value(property.kind, value)) return cut();
      if (property.axis && !std::isfinite(value))
        return Error{"", fmt::format("has {} {} at no finite place", element.name, number), "repair the mesh"};
      if (!property.vertices || (strip && value == -1.0)) continue;
      if (!(value >= 0.0 && value < static_cast<double>(header.vertices)))
        return Error{"",
                     fmt::format("has {} {} that names vertex {} of {}", element.name, number, value, header.vertices),
                     "export it again"};
    }
  }
  return Done{};
}

Status check_element(TetText& text, const Element& element, const PlyHeader& header) {
  std::uint64_t size = 0;  // [byte] of one element, if no property is a list
  bool lists = false;
  for (const Property& property : element.properties) {
    size += size_of(property.kind);
    lists |= property.list;
  }
  if (text.binary() && !lists) {
    if (text.skip(size * static_cast<std::uint64_t>(element.count))) return Done{};
    return damaged(fmt::format("ends before the last of {} {}", element.count, element.name));
  }
  std::string_view line;
  for (std::int64_t n = 0; n < element.count; ++n) {
    if (!text.binary()) {
      do {
        if (!text.line(line)) return damaged(fmt::format("ends before {} {} of {}", element.name, n, element.count));
      } while (line.empty());
    }
    PlyRow row(text, line);
    if (const Status status = check_row(row, element, n, header); !status) return status;
  }
  return Done{};
}

}  // namespace

Status check_ply(const Bytes& bytes) {
  TetText text(bytes, "");
  const Result<PlyHeader> header = read_ply_header(text);
  if (!header) return header.error();
  for (const Element& element : header->elements) {
    if (element.name != "vertex") continue;
    int axes = 0;
    for (const Property& p : element.properties) axes += p.axis;
    if (axes != 3) return Error{"", "has vertices without x, y and z", "export it again"};
  }
  for (const Element& element : header->elements)
    if (const Status status = check_element(text, element, *header); !status) return status;
  return Done{};
}

}  // namespace pliant
