// OFF: [ST][C][N][4][n]OFF, counts, then one vertex or face per line; '#' begins a comment.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "content/files/mesh_reader.h"
#include "content/tets/tet_text.h"

namespace pliant {
namespace {

using Words = std::vector<std::string_view>;

struct OffHeader {
  bool texture = false, normal = false, homogeneous = false;
  std::int64_t vertices = 0, faces = 0;
};

// Reads the words of the next non-empty line; false at the end of the file.
bool row(TetText& text, Words& words) {
  words.clear();
  std::string_view line;
  while (words.empty()) {
    if (!text.line(line)) return false;
    line = line.substr(0, line.find('#'));
    TetText rest({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, "");
    for (std::string_view word; rest.word(word);) words.push_back(word);
  }
  return true;
}

Result<OffHeader> read_off_header(TetText& text) {
  OffHeader header;
  Words words;
  if (!row(text, words)) return Error{"", "is empty", "export it again"};
  std::string_view key = words[0];
  if (key.size() >= 3 && key.substr(key.size() - 3) == "OFF") {
    const auto take = [&key](std::string_view letters) {
      if (key.substr(0, letters.size()) != letters) return false;
      key.remove_prefix(letters.size());
      return true;
    };
    header.texture = take("ST");
    take("C");
    header.normal = take("N");
    header.homogeneous = take("4");
    const bool dimension = take("n");
    if (key != "OFF") return Error{"", "begins with an unknown kind of OFF", "export it again"};
    words.erase(words.begin());
    if (!words.empty() && words[0] == "BINARY") return Error{"", "is a binary OFF", "export it as text"};
    if (words.empty() && !row(text, words)) return Error{"", "ends within its header", "the file is cut off"};
    if (dimension) {
      if (words[0] != "3") return Error{"", "has vertices of another dimension than 3", "export it again"};
      words.erase(words.begin());
      if (words.empty() && !row(text, words)) return Error{"", "ends within its header", "the file is cut off"};
    }
  }
  if (words.size() < 2 || !to_integer(words[0], header.vertices) || !to_integer(words[1], header.faces))
    return Error{"", "has no numbers of vertices and faces at its head", "export it again"};
  if (words.size() > 3)
    return Error{"", "has more on the line of its counts than three numbers", "write each vertex on a line of its own"};
  const std::int64_t most = static_cast<std::int64_t>(text.left());
  if (header.vertices < 1 || header.faces < 1 || header.vertices > most || header.faces > most)
    return Error{"", fmt::format("claims {} vertices and {} faces in {} bytes", header.vertices, header.faces, most),
                 "the file is damaged"};
  return header;
}

Status read_vertex(const OffHeader& header, const Words& words, std::int64_t v, MeshContent& out) {
  const std::size_t normals = header.homogeneous ? 4 : 3, needed = normals + (header.normal ? 3 : 0);
  if (words.size() < needed + (header.texture ? 2 : 0))
    return Error{"", fmt::format("has too few numbers for vertex {}", v), "the file is cut off or damaged"};
  Words kept(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(needed));
  if (header.texture) kept.insert(kept.end(), words.end() - 2, words.end());  // texture coordinates follow the colours
  std::array<double, 9> value{};
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (!to_number(kept[i], value[i]) || !std::isfinite(static_cast<float>(value[i])))
      return Error{"", fmt::format("has something else than a finite number at vertex {}", v), "repair the mesh"};
  if (header.homogeneous && value[3] == 0.0)
    return Error{"", fmt::format("has vertex {} at infinity", v), "repair the mesh"};
  const vec3 place(dvec3(value[0], value[1], value[2]) / (header.homogeneous ? value[3] : 1.0));
  if (!std::isfinite(place.x + place.y + place.z))
    return Error{"", fmt::format("has vertex {} at infinity", v), "repair the mesh"};
  out.position.push_back(place);
  if (header.normal) out.normal.emplace_back(dvec3(value[normals], value[normals + 1], value[normals + 2]));
  if (header.texture) out.uv.emplace_back(glm::dvec2(value[needed], value[needed + 1]));
  return Done{};
}

Status read_face(const OffHeader& header, const Words& words, std::int64_t f, FaceList& out) {
  std::int64_t corners = 0;
  if (!to_integer(words[0], corners) || corners < 1 || corners >= static_cast<std::int64_t>(words.size()))
    return Error{"", fmt::format("has too few numbers for face {}", f), "the file is cut off or damaged"};
  const std::size_t begin = out.corners.size();
  for (std::int64_t c = 1; c <= corners; ++c) {
    const std::string_view word = words[static_cast<std::size_t>(c)];
    std::int64_t vertex = -1;
    if (!to_integer(word, vertex) || vertex < 0 || vertex >= header.vertices)
      return Error{"", fmt::format("has a face {} that names vertex {} of {}", f, word.substr(0, 20), header.vertices),
                   "export it again"};
    const auto same = static_cast<std::int32_t>(vertex);
    out.corners.push_back({static_cast<std::uint32_t>(vertex), header.texture ? same : -1, header.normal ? same : -1});
  }
  if (corners < 3)
    out.corners.resize(begin);  // skips points and lines
  else
    out.sizes.push_back(static_cast<std::uint32_t>(corners));
  return Done{};
}

}  // namespace

Result<MeshContent> read_off(const Bytes& bytes) {
  TetText text(bytes, "");
  const Result<OffHeader> header = read_off_header(text);
  if (!header) return header.error();
  MeshContent out;
  Words words;
  for (std::int64_t v = 0; v < header->vertices; ++v) {
    if (!row(text, words))
      return Error{"", fmt::format("ends before vertex {} of {}", v, header->vertices), "the file is cut off"};
    if (const Status status = read_vertex(*header, words, v, out); !status) return status.error();
  }
  FaceList& faces = out.objects.emplace_back().lists.emplace_back();
  for (std::int64_t f = 0; f < header->faces; ++f) {
    if (!row(text, words))
      return Error{"", fmt::format("ends before face {} of {}", f, header->faces), "the file is cut off"};
    if (const Status status = read_face(*header, words, f, faces); !status) return status.error();
  }
  if (faces.sizes.empty()) return Error{"", "has no triangles", "points and lines cannot be touched"};
  out.materials.emplace_back().base_color = vec4(1);
  out.textures.emplace_back();
  return out;
}

}  // namespace pliant
