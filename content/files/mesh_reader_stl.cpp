// STL: 80 bytes, a count and 50 bytes per triangle; or text, facet by facet.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "content/files/mesh_reader.h"
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

// Gives every place and normal one number.
class StlBuilder {
 public:
  explicit StlBuilder(MeshContent& out) : out_(out) {}
  void add(const vec3& normal, const vec3 (&corners)[3], FaceList& to) {
    for (const vec3& corner : corners)
      to.corners.push_back({number_of(corner, places_, out_.position), -1,
                            static_cast<std::int32_t>(number_of(normal, normals_, out_.normal))});
    to.sizes.push_back(3);
  }

 private:
  using Known = std::map<std::array<float, 3>, std::uint32_t>;
  // A place that is not a number has no order: it is looked for by none.
  static std::uint32_t number_of(const vec3& value, Known& known, std::vector<vec3>& all) {
    const bool finite = std::isfinite(value.x + value.y + value.z);
    const auto next = static_cast<std::uint32_t>(all.size());
    if (finite) {
      const auto [place, is_new] = known.try_emplace({value.x + 0.0f, value.y + 0.0f, value.z + 0.0f}, next);
      if (!is_new) return place->second;
    }
    all.push_back(value);
    return next;
  }
  MeshContent& out_;
  Known places_, normals_;
};

Error facet_not_finite(std::uint64_t facet) {
  return {"", fmt::format("has facet {} at no finite place", facet), "repair the mesh"};
}

Status read_binary(const Bytes& bytes, MeshContent& out) {
  if (bytes.size() < kHead) return Error{"", "ends within its header", "the file is cut off"};
  std::uint32_t count = 0;
  std::memcpy(&count, &bytes[80], 4);
  const std::uint64_t size = kHead + kTriangle * std::uint64_t{count};
  // A few extra bytes are padding; extra whole triangles mean that the count or the data is wrong.
  if (bytes.size() < size || bytes.size() >= size + kTriangle)
    return Error{"", fmt::format("says {} triangles but has {}", count, (bytes.size() - kHead) / kTriangle),
                 "the file is cut off or damaged"};
  out.root = "<STL_BINARY>";
  FaceList& faces = out.objects.emplace_back().lists.emplace_back();
  StlBuilder builder(out);
  for (std::uint32_t t = 0; t < count; ++t) {
    float v[12];
    std::memcpy(v, &bytes[kHead + kTriangle * t], sizeof v);
    for (int i = 3; i < 12; ++i)
      if (!std::isfinite(v[i])) return facet_not_finite(t);
    builder.add({v[0], v[1], v[2]}, {{v[3], v[4], v[5]}, {v[6], v[7], v[8]}, {v[9], v[10], v[11]}}, faces);
  }
  return Done{};
}

Status read_text(const Bytes& bytes, MeshContent& out) {
  TetText text(bytes, "");
  std::string_view word, line;
  std::uint64_t facet = 0;
  const auto broken = [&facet](const char* what) {
    return Error{"", fmt::format("{} in facet {}", what, facet), "the file is cut off or damaged"};
  };
  const auto expect = [&](const char* wanted) { return text.word(word) && word == wanted; };
  const auto numbers = [&](vec3& to) {
    double x = 0.0, y = 0.0, z = 0.0;
    const bool there = text.number(x) && text.number(y) && text.number(z);
    to = vec3(dvec3(x, y, z));
    return there;
  };
  StlBuilder builder(out);
  out.root = "";
  bool open = false;  // between solid and endsolid
  while (text.word(word)) {
    if (word == "solid" && !open) {
      open = true;
      text.line(line);
      TetText names({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, "");
      names.word(word);
      if (line.empty()) out.root = "<STL_ASCII>";
      out.objects.push_back({line.empty() ? std::string() : std::string(word), {FaceList{}}});
    } else if (word == "endsolid" && open) {
      open = false;
      text.line(line);
    } else if (word == "facet" && open) {
      if (!expect("normal")) return broken("lacks a normal");
      vec3 normal(0), corners[3];
      for (int i = 0; i < 3; ++i) {
        double value = NAN;  // normals that are not numbers are recomputed
        if (!text.word(word)) return broken("lacks a normal");
        to_number(word, value);
        normal[i] = static_cast<float>(value);
      }
      if (!expect("outer") || !expect("loop")) return broken("lacks `outer loop`");
      for (vec3& corner : corners)
        if (!expect("vertex") || !numbers(corner)) return broken("lacks three vertices of three numbers");
      if (!expect("endloop") || !expect("endfacet")) return broken("has another number of vertices than three");
      for (const vec3& corner : corners)
        if (!std::isfinite(corner.x + corner.y + corner.z)) return facet_not_finite(facet);
      builder.add(normal, corners, out.objects.back().lists.front());
      ++facet;
    } else {
      return broken("has an unknown word");
    }
  }
  if (open) return Error{"", fmt::format("ends without `endsolid` after {} facets", facet), "the file is cut off"};
  return Done{};
}

}  // namespace

Result<MeshContent> read_stl(const Bytes& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHead) std::memcpy(&count, &bytes[80], 4);
  const bool exact = bytes.size() == kHead + kTriangle * std::uint64_t{count};
  MeshContent out;
  const Status read = !exact && is_text(bytes) ? read_text(bytes, out) : read_binary(bytes, out);
  if (!read) return read.error();
  out.materials.emplace_back().name = "DefaultMaterial";
  out.materials.back().base_color = vec4(1);
  out.textures.emplace_back();
  return out;
}

}  // namespace pliant
