#include "player/fit/press_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "content/files/file_io.h"
#include "content/files/limits.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

constexpr std::size_t kLeastRows = 8;

enum Quantity : std::size_t { kTime, kDepth, kForce, kQuantities };
struct Unit {
  const char* word;
  double factor;
};
struct QuantityWords {
  const char* what;
  std::vector<const char*> names;
  std::vector<Unit> units;
  const char* example;
};
const QuantityWords& quantity_words(std::size_t quantity) {
  static const QuantityWords words[kQuantities] = {
      {"time", {"time", "t"}, {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"min", 60.0}, {"h", 3600.0}}, "time_s"},
      {"depth",
       {"depth", "indentation", "displacement", "d"},
       {{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"\xC2\xB5m", 1e-6}, {"nm", 1e-9}},
       "depth_mm"},
      {"force",
       {"force", "load", "f"},
       {{"N", 1.0}, {"mN", 1e-3}, {"uN", 1e-6}, {"\xC2\xB5N", 1e-6}, {"nN", 1e-9}, {"kN", 1e3}},
       "force_N"}};
  return words[quantity];
}

std::string_view trim(std::string_view s) {
  const std::size_t begin = s.find_first_not_of(" \t\r\"");
  return begin == std::string_view::npos ? std::string_view{}
                                         : s.substr(begin, s.find_last_not_of(" \t\r\"") - begin + 1);
}

std::string lower(std::string_view word) {
  std::string out(word);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return out;
}

// Between marks; a cell in quotes may hold marks.
std::vector<std::string_view> cells_of(std::string_view line, char mark) {
  std::vector<std::string_view> out;
  for (;;) {
    const std::size_t begin = line.find_first_not_of(' ');
    const bool quoted = begin != std::string_view::npos && line[begin] == '"';
    const std::size_t close = quoted ? line.find('"', begin + 1) : 0;
    const std::size_t end = line.find(mark, quoted && close != std::string_view::npos ? close : 0);
    out.push_back(trim(line.substr(0, end)));
    if (end == std::string_view::npos) return out;
    line.remove_prefix(end + 1);
  }
}

// "depth_mm", "depth [mm]", "Depth (mm)" -> the name in small letters, and the unit as it stands.
std::pair<std::string, std::string> name_and_unit(std::string_view head) {
  const std::size_t open = head.find_first_of("[(");
  if (open != std::string_view::npos) {
    const std::size_t end = head.find_first_of("])", open);
    return {lower(trim(head.substr(0, open))), std::string(trim(head.substr(open + 1, end - open - 1)))};
  }
  const std::size_t line = head.rfind('_');
  if (line == std::string_view::npos) return {lower(head), {}};
  return {lower(head.substr(0, line)), std::string(head.substr(line + 1))};
}

bool is_name(std::size_t quantity, const std::string& name) {
  const QuantityWords& words = quantity_words(quantity);
  return std::any_of(words.names.begin(), words.names.end(), [&](const char* each) { return name == each; });
}

struct Columns {
  std::size_t at[kQuantities] = {};  // 1 and on; 0: not there
  double factor[kQuantities] = {1, 1, 1};
  std::optional<std::size_t> probe;
  std::size_t axis[3] = {};  // of a run's force, 1 and on
  std::size_t count = 0;
  char mark = ',';
};

Result<Columns> read_head(std::string_view line, const std::string& where) {
  Columns out;
  if (line.find(',') == std::string_view::npos)
    out.mark = line.find(';') != std::string_view::npos ? ';' : line.find('\t') != std::string_view::npos ? '\t' : ',';
  const std::vector<std::string_view> heads = cells_of(line, out.mark);
  out.count = heads.size();
  bool run = std::find(heads.begin(), heads.end(), "probe") != heads.end();  // a run's forces.csv
  for (std::size_t i = 0; i < heads.size(); ++i) {
    if (heads[i] == "probe") out.probe = i;
    for (std::size_t a = 0; a < 3; ++a)
      if (run && heads[i] == std::string_view("fxfyfz").substr(2 * a, 2)) out.axis[a] = i + 1;
    if (run && heads[i] == "fn") {
      out.at[kForce] = i + 1;
      continue;
    }
    const auto [name, unit] = name_and_unit(heads[i]);
    for (std::size_t q = 0; q < kQuantities; ++q) {
      const QuantityWords& words = quantity_words(q);
      if (!is_name(q, name) && !is_name(q, lower(heads[i]))) continue;
      if (run && q == kForce) continue;
      if (out.at[q]) return Error{where, fmt::format("has two columns of {}; leave one", words.what)};
      std::string all;
      for (const Unit& each : words.units) {
        if (unit == each.word) {
          out.at[q] = i + 1;
          out.factor[q] = each.factor;
        }
        all += (all.empty() ? "" : ", ") + std::string(each.word);
      }
      if (out.at[q]) continue;
      return Error{where, unit.empty() || !is_name(q, name)
                              ? fmt::format("column '{}' does not say its unit; write {}, or another of {}",
                                            printable(heads[i]), words.example, all)
                              : fmt::format("column '{}' has the unit '{}'; must be one of {}", printable(heads[i]),
                                            printable(unit), all)};
    }
  }
  for (const std::size_t q : {kDepth, kForce})
    if (!out.at[q])
      return Error{where, fmt::format("has no column of {}; name one {}, with its unit", quantity_words(q).what,
                                      quantity_words(q).example)};
  return out;
}

bool read_number(std::string_view cell, double& value) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  const std::from_chars_result read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return read.ec == std::errc{} && read.ptr == cell.data() + cell.size();
}

// What no fit could use.
Status check(const PressRecord& record, const std::string& where) {
  if (record.size() < kLeastRows)
    return Error{where, fmt::format("has {} rows; a fit takes at least {}", record.size(), kLeastRows)};
  const auto [least, most] = std::minmax_element(record.depth.begin(), record.depth.end());
  if (!(*most > 0))
    return Error{where, "has no depth above 0; depth is positive where the indenter presses in: turn its sign"};
  if (!(*most > *least)) return Error{where, "has the same depth in every row; a fit takes several"};
  double sum = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) sum += record.force[i] * std::max(record.depth[i], 0.0);
  if (!(sum > 0))
    return Error{where,
                 "has a force that falls as the depth grows; force is positive against the indenter: turn its sign"};
  return Done{};
}

}  // namespace

Result<PressRecord> parse_press(std::string_view text, const std::string& where, const std::string& probe,
                                bool with_friction) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  PressRecord record;
  record.name = where;
  std::optional<Columns> columns;
  std::set<std::string> probes;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trim(text.substr(0, end));
    const std::string here = where + ":" + std::to_string(number);
    const std::string_view whole = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    if (!columns) {
      Result<Columns> head = read_head(whole, here);
      if (!head) return head.error();
      columns = *head;
      if (!probe.empty() && !columns->probe) return Error{where, "has no column `probe`; leave --probe out"};
      continue;
    }
    const std::vector<std::string_view> cells = cells_of(whole, columns->mark);
    if (cells.size() != columns->count)
      return Error{here,
                   fmt::format("has {} cells where the header has {}; correct the line", cells.size(), columns->count)};
    if (columns->probe) {
      const std::string its(cells[*columns->probe]);
      probes.insert(its);
      if (probe.empty() && probes.size() > 1)
        return Error{where, fmt::format("has several probes, {} and {} among them; choose one with --probe NAME",
                                        printable(*probes.begin()), printable(*probes.rbegin()))};
      if (!probe.empty() && its != probe) continue;
    }
    double value[kQuantities] = {};
    for (std::size_t q = 0; q < kQuantities; ++q) {
      if (!columns->at[q]) continue;
      const std::string_view cell = cells[columns->at[q] - 1];
      if (!read_number(cell, value[q]) || !std::isfinite(value[q]))
        return Error{here, fmt::format("its {} is '{}', which is no finite number; correct the row or leave it out",
                                       quantity_words(q).what, printable(cell.substr(0, 40)))};
      value[q] *= columns->factor[q];
    }
    if (with_friction && columns->axis[0] && columns->axis[1] && columns->axis[2]) {
      double square = 0.0, along = 0.0;
      for (const std::size_t axis : columns->axis) {
        if (!read_number(cells[axis - 1], along) || !std::isfinite(along))
          return Error{here, "its force is no finite number; correct the row or leave it out"};
        square += along * along;
      }
      value[kForce] = std::sqrt(square);
    }
    if (columns->at[kTime]) {
      if (!record.time.empty() && !(value[kTime] > record.time.back()))
        return Error{here, "its time does not grow from the row before; sort the rows and remove doubles"};
      record.time.push_back(value[kTime]);
    }
    record.depth.push_back(value[kDepth]);
    record.force.push_back(value[kForce]);
  }
  if (!columns) return Error{where, "is empty; a header such as time_s,depth_mm,force_N comes first, then rows"};
  if (!probe.empty() && !probes.contains(probe))
    return Error{where, fmt::format("has no probe '{}'; it has {}", printable(probe),
                                    probes.empty() ? "none" : printable(*probes.begin()))};
  if (const Status status = check(record, where); !status) return status.error();
  const double deepest = *std::max_element(record.depth.begin(), record.depth.end());
  if (deepest > 0.2)
    record.notes.push_back(
        fmt::format("{}: the deepest press is {:.3g} m; is the unit of depth right?", where, deepest));
  if (deepest < 1e-6)
    record.notes.push_back(
        fmt::format("{}: the deepest press is {:.3g} m; is the unit of depth right?", where, deepest));
  return record;
}

Result<PressRecord> read_press(const std::filesystem::path& file, const std::string& probe, bool with_friction) {
  const Result<Bytes> bytes = read_file(file, limits::kScriptFile);
  if (!bytes) return bytes.error();
  return parse_press({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file.string(), probe,
                     with_friction);
}

}  // namespace pliant
