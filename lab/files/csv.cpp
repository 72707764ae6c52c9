#include "lab/files/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "runtime/printable.h"

namespace pliant {
namespace {

bool is_plain_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

// True if a spreadsheet would evaluate the cell; leading apostrophes and blanks are ignored.
bool is_formula(std::string_view cell) {
  cell.remove_prefix(std::min(cell.find_first_not_of('\''), cell.size()));
  cell.remove_prefix(std::min(cell.find_first_not_of(' '), cell.size()));
  for (const std::string_view first : {"=", "+", "-", "@", "\uFF1D", "\uFF0B", "\uFF0D", "\uFF20"})
    if (cell.starts_with(first)) return !is_plain_number(cell);
  return false;
}

// Calls change(part, text) for each part between semicolons and joins the results.
template <class Change>
std::string each_part(std::string_view cell, const Change& change) {
  std::string text;
  for (;;) {
    const std::size_t end = std::min(cell.find(';'), cell.size());
    change(cell.substr(0, end), text);
    if (end == cell.size()) return text;
    text += ';';
    cell.remove_prefix(end + 1);
  }
}

std::string guarded(std::string_view cell) {
  return each_part(cell, [](std::string_view part, std::string& text) {
    if (is_formula(part)) text += '\'';
    text += part;
  });
}

std::string unguarded(std::string_view cell) {
  return each_part(cell, [](std::string_view part, std::string& text) {
    text += part.substr(part.starts_with('\'') && is_formula(part) ? 1 : 0);
  });
}

}  // namespace

std::string csv_text(const std::string& name) {
  const std::string shown = guarded(printable(name));
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
    if (cell.find('\'') != std::string::npos) cell = unguarded(cell);
    at = end;
    if (at == line.size()) break;
  }
  cells.resize(count);
}

std::size_t csv_column(const std::vector<std::string>& header, std::string_view name) {
  const auto found = std::find(header.begin(), header.end(), name);
  return found == header.end() ? kNoColumn : static_cast<std::size_t>(found - header.begin());
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
