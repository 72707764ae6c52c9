// PLY: a header of elements and their properties, then the elements, one per line or in binary.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "content/files/mesh_reader.h"
#include "content/tets/tet_text.h"

namespace pliant {
namespace {

enum class Kind { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

// Kinds of a vertex property.
enum class Use { kNothing, kX, kY, kZ, kNormalX, kNormalY, kNormalZ, kU, kV };
constexpr std::size_t kUses = 9;

struct Property {
  std::string name;
  Kind kind = Kind::kFloat, count_kind = Kind::kUint8;
  bool list = false;
  bool vertices = false;  // the list holds vertex indices
  Use use = Use::kNothing;
  bool axis() const { return use == Use::kX || use == Use::kY || use == Use::kZ; }
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

Use use_of(std::string_view word) {
  constexpr std::pair<const char*, Use> kWords[] = {
      {"x", Use::kX},        {"y", Use::kY}, {"z", Use::kZ},  {"nx", Use::kNormalX}, {"ny", Use::kNormalY},
      {"nz", Use::kNormalZ}, {"u", Use::kU}, {"s", Use::kU},  {"tx", Use::kU},       {"texture_u", Use::kU},
      {"v", Use::kV},        {"t", Use::kV}, {"ty", Use::kV}, {"texture_v", Use::kV}};
  for (const auto& [name, use] : kWords)
    if (word == name) return use;
  return Use::kNothing;
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
      if (!property.list) property.use = use_of(word);
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

struct PlyBody {
  MeshContent content;
  FaceList faces;
  bool has_normals = false, has_uv = false;
};

// A strip's triangles, every second one turned; -1 begins another strip.
void add_strip(const std::vector<double>& strip, const auto& add) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] < 0.0) begin = i + 1;
    if (strip[i] < 0.0 || i < begin + 2) continue;
    const bool odd = (i - begin) % 2 != 0;
    add({strip[i - 2], strip[odd ? i : i - 1], strip[odd ? i - 1 : i]});
  }
}

// Reads one element: a vertex, a face, a strip; of others only checks that it is whole.
Status read_row(PlyRow& row, const Element& element, std::int64_t number, const PlyHeader& header, PlyBody& out) {
  const auto cut = [&] { return damaged(fmt::format("has too few numbers for {} {}", element.name, number)); };
  const bool strip = element.name == "tristrips", vertex = element.name == "vertex";
  double values[kUses] = {};
  std::vector<double> corners;
  for (const Property& property : element.properties) {
    double count = 1.0, value = 0.0;
    if (property.list && !row.value(property.count_kind, count)) return cut();
    if (!(count >= 0.0) || count != static_cast<double>(static_cast<std::int64_t>(std::min(count, 1e15))))
      return damaged(fmt::format("has a list of {} numbers in {} {}", count, element.name, number));
    if (property.vertices && count == 0.0)
      return Error{"", fmt::format("has {} {} without a corner", element.name, number), "export it again"};
    for (double i = 0.0; i < count; ++i) {
      if (!row.value(property.kind, value)) return cut();
      if (property.axis() && !std::isfinite(static_cast<float>(value)))
        return Error{"", fmt::format("has {} {} at no finite place", element.name, number), "repair the mesh"};
      values[static_cast<std::size_t>(property.use)] = value;
      if (!property.vertices) continue;
      corners.push_back(value);
      if (strip && value == -1.0) continue;
      if (!(value >= 0.0 && value < static_cast<double>(header.vertices)))
        return Error{"",
                     fmt::format("has {} {} that names vertex {} of {}", element.name, number, value, header.vertices),
                     "export it again"};
    }
  }
  const auto at = [&](Use use) { return values[static_cast<std::size_t>(use)]; };
  if (vertex) {
    out.content.position.emplace_back(dvec3(at(Use::kX), at(Use::kY), at(Use::kZ)));
    if (out.has_normals)
      out.content.normal.emplace_back(dvec3(at(Use::kNormalX), at(Use::kNormalY), at(Use::kNormalZ)));
    if (out.has_uv) out.content.uv.emplace_back(glm::dvec2(at(Use::kU), at(Use::kV)));
  }
  const auto add = [&](const std::vector<double>& face) {
    if (face.size() < 3) return;  // skips points and lines
    for (const double corner : face) {
      const auto same = static_cast<std::int32_t>(corner);
      out.faces.corners.push_back(
          {static_cast<std::uint32_t>(same), out.has_uv ? same : -1, out.has_normals ? same : -1});
    }
    out.faces.sizes.push_back(static_cast<std::uint32_t>(face.size()));
  };
  if (strip)
    add_strip(corners, add);
  else if (element.name == "face")
    add(corners);
  return Done{};
}

Status read_ply_element(TetText& text, const Element& element, const PlyHeader& header, PlyBody& out) {
  std::string_view line;
  for (std::int64_t n = 0; n < element.count; ++n) {
    if (!text.binary()) {
      do {
        if (!text.line(line)) return damaged(fmt::format("ends before {} {} of {}", element.name, n, element.count));
      } while (line.empty());
    } else if (text.left() == 0 && !element.properties.empty()) {
      return damaged(fmt::format("ends before {} {} of {}", element.name, n, element.count));
    }
    PlyRow row(text, line);
    if (const Status status = read_row(row, element, n, header, out); !status) return status;
  }
  return Done{};
}

}  // namespace

Result<MeshContent> read_ply(const Bytes& bytes) {
  TetText text(bytes, "");
  const Result<PlyHeader> header = read_ply_header(text);
  if (!header) return header.error();
  PlyBody out;
  for (const Element& element : header->elements) {
    if (element.name != "vertex") continue;
    int axes = 0, uv = 0;
    for (const Property& p : element.properties) {
      axes += p.axis();
      uv += p.use == Use::kU || p.use == Use::kV;
      out.has_normals |= p.use == Use::kNormalX || p.use == Use::kNormalY || p.use == Use::kNormalZ;
    }
    out.has_uv = uv > 0;
    if (axes != 3) return Error{"", "has vertices without x, y and z", "export it again"};
  }
  for (const Element& element : header->elements)
    if (const Status status = read_ply_element(text, element, *header, out); !status) return status.error();
  if (out.content.position.size() != static_cast<std::size_t>(header->vertices))
    return Error{"", "has vertices in two places", "export it again"};
  out.content.objects.emplace_back().lists.push_back(std::move(out.faces));
  out.content.materials.emplace_back().base_color = vec4(1);
  out.content.textures.emplace_back();
  return std::move(out.content);
}

}  // namespace pliant
