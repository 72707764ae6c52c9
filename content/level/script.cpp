#include "content/level/script.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "content/files/file_io.h"
#include "content/level/level_budget.h"

namespace pliant {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of UTF-8, as written by spreadsheet programs
constexpr std::string_view kPositions = "time_s,x,y,z", kPoses = "time_s,x,y,z,qw,qx,qy,qz";
constexpr std::string_view kGrip = ",grip";  // a last column

std::string_view trim(std::string_view s) {
  const std::size_t begin = s.find_first_not_of(" \t\r");
  return begin == std::string_view::npos ? std::string_view{}
                                         : s.substr(begin, s.find_last_not_of(" \t\r") - begin + 1);
}

// Removes the next line from `text` and returns it.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return trim(line);
}

// Removes blanks from a header: "time_s, x" becomes "time_s,x".
std::string without_blanks(std::string_view line) {
  std::string names(line);
  std::erase_if(names, [](char c) { return c == ' ' || c == '\t'; });
  return names;
}

// Parses exactly `count` finite numbers separated by commas.
bool parse_row(std::string_view line, double* values, int count) {
  for (int i = 0; i < count; ++i) {
    const std::size_t comma = line.find(',');
    if ((comma == std::string_view::npos) != (i == count - 1)) return false;
    const std::string_view cell = trim(line.substr(0, comma));
    const std::from_chars_result read = std::from_chars(cell.data(), cell.data() + cell.size(), values[i]);
    if (read.ec != std::errc{} || read.ptr != cell.data() + cell.size() || !std::isfinite(values[i])) return false;
    if (comma != std::string_view::npos) line.remove_prefix(comma + 1);
  }
  return true;
}

}  // namespace

Result<Path> parse_script(std::string_view text, const std::string& where) {
  Path path;
  int columns = 0;  // without the grip
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = take_line(text);
    const auto error = [&](const std::string& what, const std::string& cure) {
      return Error{where + ":" + std::to_string(number), what, cure, "script.row"};
    };
    if (line.empty() || line.front() == '#') continue;
    if (columns == 0) {
      std::string names = without_blanks(line);
      if ((path.grips = names.ends_with(kGrip))) names.resize(names.size() - kGrip.size());
      columns = names == kPositions ? 4 : names == kPoses ? 8 : 0;
      if (columns == 0)
        return error("the header is not `time_s,x,y,z` or `time_s,x,y,z,qw,qx,qy,qz`, with or without a last `grip`",
                     "begin the script with one");
      continue;
    }
    constexpr const char* kCounts[] = {"four", "five", "eight", "nine"};
    double v[9] = {0, 0, 0, 0, 1, 0, 0, 0, 0};
    double cells[9];
    if (!parse_row(line, cells, columns + path.grips))
      return error(
          fmt::format("this row is not {} finite numbers between commas", kCounts[columns / 8 * 2 + path.grips]),
          fmt::format("write {}{}", columns == 4 ? kPositions : kPoses, path.grips ? kGrip : ""));
    std::copy_n(cells, columns, v);
    if (path.grips) v[8] = cells[columns];
    if (!(v[8] >= 0.0 && v[8] <= 1.0)) return error("the grip is not between 0 and 1", "0 is open, 1 is closed");
    if (!path.rows.empty() && !(v[0] > path.rows.back().time))
      return error("time does not grow from the row before", "sort the rows and remove doubles");
    const dquat rotation(v[4], v[5], v[6], v[7]);
    const double norm = std::hypot(std::hypot(v[4], v[5]), std::hypot(v[6], v[7]));
    if (!(norm > 1e-6) || !std::isfinite(norm))
      return error("the quaternion has no length", "write 1,0,0,0 for no rotation");
    if (path.rows.size() >= most(limits::kScriptRows)) {
      const double rows = static_cast<double>(path.rows.size() + 1);
      return error_at(where, beyond("has", limits::kScriptRows, rows, "split the script or sample it more coarsely"));
    }
    path.rows.push_back({v[0], {v[1], v[2], v[3]}, rotation * (1.0 / norm), v[8]});
  }
  path.turns = columns == 8;
  if (path.rows.empty())
    return Error{where, "holds no rows", "write a header `time_s,x,y,z` and at least one row below it"};
  return path;
}

Result<Path> load_script(const std::filesystem::path& path) {
  const Result<Bytes> bytes = read_file(path, limits::kScriptFile);
  if (!bytes) return bytes.error();
  return parse_script({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, path.string());
}

Result<const Path*> ScriptLibrary::read(const std::filesystem::path& file, bool copied) {
  auto known = scripts_.find(file);
  const bool is_new = known == scripts_.end();
  if (is_new) known = scripts_.emplace(file, load_script(file)).first;
  const Result<Path>& script = known->second;
  if (!script) return script.error();
  if (is_new) rows_ += static_cast<double>(script->rows.size());
  if (copied) rows_ += static_cast<double>(script->rows.size());
  if (const auto over = LevelBudget::ask(limits::kScriptRows, rows_, "sample the scripts more coarsely"))
    return error_at(file.string(), *over);
  return &*script;
}

}  // namespace pliant
