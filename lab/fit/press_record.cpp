#include "lab/fit/press_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "content/files/file_io.h"
#include "content/files/limits.h"
#include "lab/files/csv.h"
#include "lab/plot/force_series.h"
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
  const std::size_t begin = s.find_first_not_of(" \t\r");
  return begin == std::string_view::npos ? std::string_view{}
                                         : s.substr(begin, s.find_last_not_of(" \t\r") - begin + 1);
}

std::string lower(std::string_view word) {
  std::string out(word);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return out;
}

// Splits a line and trims the cells.
void read_cells(std::string_view line, char mark, std::vector<std::string>& cells) {
  csv_cells(line, mark, cells);
  for (std::string& cell : cells) cell = std::string(trim(cell));
}

// "depth_mm", "depth [mm]", "Depth (mm)" -> the name in lower case and the unit as written.
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
  std::size_t at[kQuantities] = {};  // column number from 1; 0: absent
  double factor[kQuantities] = {1, 1, 1};
  std::optional<std::size_t> probe, contact;
  std::size_t axis[3] = {}, torque[3] = {};  // columns of a run's force and torque, from 1
  std::size_t count = 0;                     // number of columns, without empty ones at the end
  char mark = ',';
  std::vector<std::string> notes;
};

std::string unit_fault(const QuantityWords& words, const std::string& head, const std::string& unit) {
  std::string all;
  for (const Unit& each : words.units) all += (all.empty() ? "" : ", ") + std::string(each.word);
  return unit.empty()
             ? fmt::format("column '{}' does not say its unit; write {}, or another of {}", printable(head),
                           words.example, all)
             : fmt::format("column '{}' has the unit '{}'; must be one of {}", printable(head), printable(unit), all);
}

// Finds the column of one quantity. A column with its name but another unit may be a different quantity (f_Hz,
// load_cell); it is ignored if another column matches or if the quantity is optional.
Status find_column(const std::vector<std::string>& heads, std::size_t q, const std::string& where, Columns& out) {
  const QuantityWords& words = quantity_words(q);
  std::vector<std::pair<std::size_t, std::string>> other;  // column, unit
  for (std::size_t i = 0; i < heads.size(); ++i) {
    auto [name, unit] = name_and_unit(heads[i]);
    if (!is_name(q, name)) {
      if (!is_name(q, lower(heads[i]))) continue;
      unit.clear();
    }
    const auto known =
        std::find_if(words.units.begin(), words.units.end(), [&word = unit](const Unit& u) { return u.word == word; });
    if (known == words.units.end()) {
      other.emplace_back(i, unit);
      continue;
    }
    if (out.at[q]) return Error{where, fmt::format("has two columns of {}", words.what), "leave one"};
    out.at[q] = i + 1;
    out.factor[q] = known->factor;
  }
  for (const auto& [i, unit] : other) {
    const bool abbreviated = lower(heads[i].substr(0, 1)) == name_and_unit(heads[i]).first;
    if (!out.at[q] && !(q == kTime && abbreviated && !unit.empty()))
      return Error{where, unit_fault(words, heads[i], unit)};
    out.notes.push_back(fmt::format(
        "{}: column '{}' is not read: {}", where, printable(heads[i]),
        unit.empty() ? "it does not say its unit" : fmt::format("'{}' is no unit of {}", printable(unit), words.what)));
  }
  return Done{};
}

// Reads the header with this separator.
Result<Columns> read_head(std::string_view line, char mark, const std::string& where) {
  Columns out;
  out.mark = mark;
  std::vector<std::string> heads;
  read_cells(line, mark, heads);
  while (heads.size() > 1 && heads.back().empty()) heads.pop_back();
  out.count = heads.size();
  const auto number = [&](std::string_view name) -> std::size_t {
    const auto found = std::find(heads.begin(), heads.end(), name);
    return found == heads.end() ? 0 : static_cast<std::size_t>(found - heads.begin()) + 1;
  };
  const bool run = number("probe") > 0;  // a run's forces.csv
  if (run) {
    out.probe = number("probe") - 1;
    if (const std::size_t contact = number("in_contact")) out.contact = contact - 1;
    for (std::size_t a = 0; a < 3; ++a) {
      out.axis[a] = number(std::string_view("fxfyfz").substr(2 * a, 2));
      out.torque[a] = number(std::string_view("txtytz").substr(2 * a, 2));
    }
    out.at[kForce] = number("fn");
  }
  for (std::size_t q = 0; q < kQuantities; ++q)
    if (!(run && q == kForce))
      if (const Status found = find_column(heads, q, where, out); !found) return found.error();
  for (const std::size_t q : {kDepth, kForce})
    if (!out.at[q])
      return Error{where, fmt::format("has no column of {}", quantity_words(q).what),
                   fmt::format("name one {}, with its unit", quantity_words(q).example)};
  return out;
}

// Tries all separators and takes the one that gives columns; names may contain the others.
Result<Columns> read_head(std::string_view line, const std::string& where) {
  std::optional<Error> wrong;
  std::size_t most = 0;
  for (const char mark : {',', ';', '\t'}) {
    Result<Columns> columns = read_head(line, mark, where);
    if (columns) return columns;
    const auto marks = static_cast<std::size_t>(std::count(line.begin(), line.end(), mark));
    if (wrong && marks <= most) continue;
    wrong = columns.error();
    most = marks;
  }
  return *wrong;
}

bool read_number(std::string_view cell, double& value) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  const std::from_chars_result read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return read.ec == std::errc{} && read.ptr == cell.data() + cell.size();
}

// If commas do not separate cells, they may be decimal commas.
bool read_number(std::string cell, char mark, double& value) {
  if (mark != ',' && cell.find('.') == std::string::npos)
    if (const std::size_t comma = cell.find(','); comma != std::string::npos) cell[comma] = '.';
  return read_number(std::string_view(cell), value) && std::isfinite(value);
}

Error of_tool(const std::string& where, const std::string& probe) {
  return {
      where,
      fmt::format("`{}` is a tool, or a capsule or fork, since it has a torque: what stands as its depth is no press "
                  "of a surface at one place",
                  printable(probe)),
      "take the rows of a sphere or a point, or measured presses"};
}

// Rejects a record that no law can be fitted to.
Status check(const PressRecord& record, const std::string& where) {
  if (record.size() < kLeastRows)
    return Error{where, fmt::format("has {} rows", record.size()), fmt::format("a fit takes at least {}", kLeastRows)};
  const auto [least, most] = std::minmax_element(record.depth.begin(), record.depth.end());
  if (!(*most > 0))
    return Error{where, "has no depth above 0", "depth is positive where the indenter presses in: turn its sign"};
  if (!(*most > *least)) return Error{where, "has the same depth in every row", "a fit takes several"};
  double sum = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) sum += record.force[i] * std::max(record.depth[i], 0.0);
  if (!(sum > 0))
    return Error{where, "has a force that falls as the depth grows",
                 "force is positive against the indenter: turn its sign"};
  return Done{};
}

// Appends one row.
Status read_row(const Columns& columns, const std::vector<std::string>& cells, const std::string& where,
                const std::string& here, bool with_friction, PressRecord& record) {
  double value[kQuantities] = {};
  for (std::size_t q = 0; q < kQuantities; ++q) {
    if (!columns.at[q]) continue;
    const std::string& cell = cells[columns.at[q] - 1];
    if (!read_number(cell, columns.mark, value[q]))
      return Error{
          here,
          fmt::format(
              "its {} is '{}', which is no finite number{}", quantity_words(q).what, printable(cell.substr(0, 40)),
              cell.find(',') == std::string::npos ? "" : " (a decimal comma is read, marks between thousands are not)"),
          "correct the row or leave it out"};
    value[q] *= columns.factor[q];
  }
  double component = 0.0;
  for (const std::size_t axis : columns.torque)
    if (axis && read_number(cells[axis - 1], columns.mark, component) && component != 0.0)
      return of_tool(where, record.probe);
  if (with_friction && columns.axis[0] && columns.axis[1] && columns.axis[2]) {
    double square = 0.0;
    for (const std::size_t axis : columns.axis) {
      if (!read_number(cells[axis - 1], columns.mark, component))
        return Error{here, "its force is no finite number", "correct the row or leave it out"};
      square += component * component;
    }
    value[kForce] = std::sqrt(square);
  }
  if (columns.at[kTime]) {
    if (!record.time.empty() && !(value[kTime] > record.time.back()))
      return Error{here, "its time does not grow from the row before", "sort the rows and remove doubles"};
    record.time.push_back(value[kTime]);
  }
  record.depth.push_back(value[kDepth]);
  record.force.push_back(value[kForce]);
  record.contact.push_back(columns.contact ? cells[*columns.contact] == "1" : value[kDepth] > 0);
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
  std::vector<std::string> cells;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view whole = text.substr(0, end), line = trim(whole);
    const std::string here = where + ":" + std::to_string(number);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    if (!columns) {
      Result<Columns> head = read_head(whole, here);
      if (!head) return head.error();
      columns = *head;
      record.notes = columns->notes;
      if (!probe.empty() && !columns->probe) return Error{where, "has no column `probe`", "leave --probe out"};
      continue;
    }
    read_cells(whole, columns->mark, cells);
    while (cells.size() > columns->count && cells.back().empty()) cells.pop_back();
    if (cells.size() != columns->count)
      return Error{
          here, fmt::format("has {} cells where the header has {}", cells.size(), columns->count),
          fmt::format("correct the line{}", columns->mark == ',' && cells.size() > columns->count
                                                ? ", or, where its commas are decimal, put semicolons between cells"
                                                : "")};
    if (columns->probe) {
      const std::string& its = cells[*columns->probe];
      probes.insert(its);
      if (probe.empty() && probes.size() > 1)
        return Error{where,
                     fmt::format("has several probes, {} and {} among them", printable(*probes.begin()),
                                 printable(*probes.rbegin())),
                     "choose one with --probe NAME"};
      if (!probe.empty() && its != probe) continue;
      record.probe = its;
    }
    if (const Status read = read_row(*columns, cells, where, here, with_friction, record); !read) return read.error();
  }
  if (!columns) return Error{where, "is empty", "a header such as time_s,depth_mm,force_N comes first, then rows"};
  if (!probe.empty() && !probes.contains(probe))
    return Error{where, fmt::format("has no probe '{}'", printable(probe)),
                 fmt::format("it has {}", probes.empty() ? "none" : printable(*probes.begin()))};
  if (const Status status = check(record, where); !status) return status.error();
  const double deepest = *std::max_element(record.depth.begin(), record.depth.end());
  if (deepest > 0.2 || deepest < 1e-6)
    record.notes.push_back(
        fmt::format("{}: the deepest press is {:.3g} m; is the unit of depth right?", where, deepest));
  return record;
}

Result<PressRecord> read_press(const std::filesystem::path& file, const std::string& probe, bool with_friction) {
  const Result<Bytes> bytes = read_file(file, limits::kScriptFile);
  if (!bytes) return bytes.error();
  Result<PressRecord> record =
      parse_press({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file.string(), probe, with_friction);
  if (record && !record->probe.empty())
    if (const auto tools = tools_of(file.parent_path() / "report.json"); tools.contains(record->probe))
      if (tools.at(record->probe)) return of_tool(file.string(), record->probe);
  return record;
}

}  // namespace pliant
