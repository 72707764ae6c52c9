#include "player/record/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "runtime/printable.h"

namespace pliant {

std::string csv_text(const std::string& name) {
  const std::string shown = printable(name);
  if (shown.find_first_of(",\"") == std::string::npos) return shown;
  std::string text = "\"";
  for (const char c : shown) {
    if (c == '"') text += '"';
    text += c;
  }
  return text + '"';
}

void csv_cells(std::string_view line, char mark, std::vector<std::string>& cells) {
  std::size_t count = 0, at = 0;
  for (;; ++at) {
    if (count == cells.size()) cells.emplace_back();
    std::string& cell = cells[count++];
    cell.clear();
    const std::size_t begin = line.find_first_not_of(' ', at);
    if (begin != std::string_view::npos && line[begin] == '"') {
      for (at = begin + 1; at < line.size(); ++at) {
        if (line[at] == '"' && (at + 1 == line.size() || line[at + 1] != '"')) break;
        if (line[at] == '"') ++at;
        cell += line[at];
      }
      at = std::min(at + 1, line.size());
    }
    const std::size_t end = std::min(line.find(mark, at), line.size());
    cell += line.substr(at, end - at);
    at = end;
    if (at == line.size()) break;
  }
  cells.resize(count);
}

void put(std::string& line, double value) {
  fmt::format_to(std::back_inserter(line), ",{:.9g}", (std::abs(value) < 1e-100 ? 0.0 : value) + 0.0);
}

void put(std::string& line, const dvec3& v) {
  for (int axis = 0; axis < 3; ++axis) put(line, v[axis]);
}

void put(std::string& line, const dquat& q) {
  for (const double value : {q.w, q.x, q.y, q.z}) put(line, value);
}

}  // namespace pliant
