// TetGen's pair of files ("TetGen's file formats", wias-berlin.de/software/tetgen): counted rows of words; '#' begins a
// comment. Numbers begin at 0 or 1, as the first node's does.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "content/files/limits.h"
#include "content/tets/tet_clean.h"
#include "content/tets/tet_text.h"

namespace pliant {
namespace {

constexpr std::int64_t kMostColumns = 1000;  // of attributes in a row

// The counts in the header, all on the first line that is not empty; missing ones are 0.
template <std::size_t N>
bool read_head(TetText& text, std::array<std::int64_t, N>& head) {
  std::string_view line;
  do {
    if (!text.line(line)) return false;
    line = line.substr(0, line.find('#'));
  } while (line.find_first_not_of(" \t\r") == std::string_view::npos);
  head.fill(0);
  TetText words({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, "");
  std::string_view word;
  for (std::int64_t& value : head) {
    if (!words.word(word)) break;
    if (!to_integer(word, value) || value < 0) return false;
  }
  return true;
}

bool skip_words(TetText& text, std::int64_t count) {
  std::string_view word;
  for (std::int64_t i = 0; i < count; ++i)
    if (!text.word(word, true)) return false;
  return true;
}

}  // namespace

Result<TetFile> parse_tetgen(std::span<const std::uint8_t> node, std::span<const std::uint8_t> ele,
                             const std::string& name) {
  RawTets raw;
  TetText nodes(node, name + ".node");
  std::array<std::int64_t, 4> head;  // points, dimension, attributes, markers
  if (!read_head(nodes, head) || head[1] != 3 || head[2] > kMostColumns || head[3] > 1)
    return nodes.fault("does not begin with `points 3 attributes markers`", "save it with TetGen again");
  if (static_cast<std::uint64_t>(head[0]) > std::min<std::uint64_t>(nodes.left() / 2, most(limits::kTetFileNodes)))
    return nodes.fault(
        fmt::format("claims {} nodes, more than the file can hold or than {}", head[0], most(limits::kTetFileNodes)));
  std::int64_t first = 0;
  for (std::int64_t i = 0; i < head[0]; ++i) {
    std::int64_t number = 0;
    dvec3 p;
    if (!nodes.integer(number, true) || !nodes.number(p.x, true) || !nodes.number(p.y, true) ||
        !nodes.number(p.z, true) || !skip_words(nodes, head[2] + head[3]))
      return nodes.fault(fmt::format("node {} of {} is not a number and three finite coordinates", i + 1, head[0]),
                         "save it again");
    if (i == 0) first = number;
    if (first < 0 || first > 1 || number != first + i)
      return nodes.fault(fmt::format("numbers node {} where {} follows", number, first + i),
                         "number nodes from 0 or 1");
    raw.nodes.push_back(p);
  }

  TetText tets(ele, name + ".ele");
  std::array<std::int64_t, 3> cells;  // tetrahedra, nodes of each, attributes
  if (!read_head(tets, cells) || (cells[1] != 4 && cells[1] != 10) || cells[2] > kMostColumns)
    return tets.fault("does not begin with `tetrahedra 4 attributes` (or 10)", "save it with TetGen again");
  if (static_cast<std::uint64_t>(cells[0]) > tets.left() / 2)
    return tets.fault(fmt::format("claims {} tetrahedra, more than the file can hold", cells[0]));
  if (cells[1] == 10) raw.second_order = static_cast<std::size_t>(cells[0]);
  for (std::int64_t i = 0; i < cells[0]; ++i) {
    std::int64_t number = 0;
    Tet tet;
    bool good = tets.integer(number, true);
    for (std::size_t c = 0; c < 4 && good; ++c) {
      good = tets.integer(number, true);
      if (good && (number < first || number - first >= head[0]))
        return tets.fault(fmt::format("a tetrahedron names node {}, which does not exist", number),
                          "save both files again");
      tet[c] = static_cast<std::uint32_t>(number - first);
    }
    if (!good || !skip_words(tets, cells[1] - 4 + cells[2]))
      return tets.fault(fmt::format("tetrahedron {} of {} is not a row of node numbers", i + 1, cells[0]),
                        "save it again");
    raw.tets.push_back(tet);
  }
  return clean(std::move(raw), name);
}

namespace {

std::string tetgen_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace

// The file with the same name and the other ending, in the same letter case.
std::filesystem::path tetgen_partner(const std::filesystem::path& path) {
  const std::string ending = tetgen_ending(path);
  if (ending != ".node" && ending != ".ele") return {};
  const bool upper = std::isupper(static_cast<unsigned char>(path.extension().string()[1]));
  const char* const other = ending == ".node" ? (upper ? ".ELE" : ".ele") : (upper ? ".NODE" : ".node");
  return std::filesystem::path(path).replace_extension(other);
}

// TetGen writes two files; either may be given.
Result<TetFile> read_tetgen(const std::filesystem::path& path, const std::filesystem::path& within) {
  namespace fs = std::filesystem;
  Result<Bytes> bytes = read_file(path, limits::kTetFile);
  if (!bytes) return bytes.error();
  const fs::path beside = tetgen_partner(path);
  if (!within.empty()) {
    std::error_code error;
    const fs::path name = fs::relative(beside.parent_path(), within, error) / beside.filename();
    if (const Result<fs::path> confined = confined_file(within, name); !confined) return confined.error();
  }
  Result<Bytes> other = read_file(beside, limits::kTetFile);
  if (!other) return other.error();
  const std::string stem = fs::path(path).replace_extension().string();
  return tetgen_ending(path) == ".node" ? parse_tetgen(*bytes, *other, stem) : parse_tetgen(*other, *bytes, stem);
}

}  // namespace pliant
