#include "lab/sweep/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <set>

#include "lab/files/csv.h"
#include "lab/sweep/sweep_notes.h"

namespace pliant {
namespace {

void add_names(const PlanJson& object, std::vector<std::string>& names, std::set<std::string>& known) {
  for (const auto& [name, value] : object.items())
    if (known.insert(name).second) names.push_back(name);
}

std::string notes_text(const PlanJson& line) {
  std::string text;
  for (const Note& note : notes_of(line)) text += (text.empty() ? "" : " | ") + note.message();
  return text;
}

std::string csv(const SweepTable& table, const char* part, const std::vector<std::string>& names, bool with_status) {
  std::string text = "id";
  for (const SweepAxis& axis : table.axes) text += "," + csv_text(axis.name);
  if (with_status) text += ",status";
  for (const std::string& name : names) text += "," + csv_text(name);
  text += with_status ? ",notes\n" : "\n";
  for (const SweepRow& row : table.rows) {
    if (row.line.is_null()) continue;
    text += row.id;
    for (const PlanJson& value : row.values) text += "," + csv_text(text_of(value));
    if (with_status) text += "," + row.line["status"].get<std::string>();
    for (const std::string& name : names) {
      text += ",";
      if (row.line.contains(part) && row.line[part].contains(name)) text += csv_text(text_of(row.line[part][name]));
    }
    if (with_status) text += "," + csv_text(notes_text(row.line));
    text += "\n";
  }
  return text;
}

PlanJson axes_of(const SweepRow& row, const SweepTable& table) {
  PlanJson json = PlanJson::object();
  for (std::size_t i = 0; i < table.axes.size(); ++i) json[table.axes[i].name] = row.values[i];
  return json;
}

// Smallest, mean and largest of each figure that is a number.
PlanJson summary(const SweepTable& table) {
  PlanJson json = PlanJson::object();
  for (const std::string& name : table.figures) {
    double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0.0;
    std::size_t count = 0;
    for (const SweepRow& row : table.rows) {
      if (!row.done() || !row.line["figures"].contains(name) || !row.line["figures"][name].is_number()) continue;
      const double value = row.line["figures"][name].get<double>();
      least = std::min(least, value);
      most = std::max(most, value);
      sum += value;
      ++count;
    }
    if (count > 0) json[name] = {{"min", least}, {"mean", sum / static_cast<double>(count)}, {"max", most}};
  }
  return json;
}

}  // namespace

Result<SweepTable> read_table(const std::vector<std::filesystem::path>& folders) {
  SweepTable table;
  Lines lines;
  for (const std::filesystem::path& folder : folders) {
    auto sweep = read_sweep(folder);
    if (!sweep) return sweep.error();
    if (table.sweep.is_null())
      table.sweep = std::move(sweep).value();
    else if (table.sweep != *sweep)
      return Error{folder.string(), "is of another plan, level or version than " + folders.front().string(),
                   "merge those of one plan"};
    if (Status read = read_lines(folder, lines); !read) return read.error();
  }
  for (const PlanJson& axis : table.sweep["axes"]) {
    table.axes.push_back({axis["name"].get<std::string>(), "", axis["sampled"].get<bool>(), {}});
    if (axis.contains("values") && axis["values"].is_array())
      for (const PlanJson& value : axis["values"]) table.axes.back().values.push_back(value);
  }
  std::set<std::string> figures, timings, ids;
  for (const PlanJson& run : table.sweep["runs"]) {
    SweepRow& row = table.rows.emplace_back();
    row.id = run["id"].get<std::string>();
    for (const PlanJson& value : run["values"]) row.values.push_back(value);
    ids.insert(row.id);
    const auto line = lines.runs.find(row.id);
    if (line == lines.runs.end()) continue;
    row.line = line->second;
    if (row.done()) add_names(row.line["figures"], table.figures, figures);
    add_names(row.line["timing"], table.timings, timings);
  }
  table.sweep.erase("runs");
  table.torn = lines.torn;
  for (const auto& [id, line] : lines.runs) table.foreign += ids.count(id) == 0;
  for (const std::string& id : lines.disagree)
    if (ids.count(id)) table.disagree.push_back(id);
  return table;
}

std::string results_csv(const SweepTable& table) {
  return csv(table, "figures", table.figures, true);
}

std::string timings_csv(const SweepTable& table) {
  return csv(table, "timing", table.timings, false);
}

std::size_t untouched(const SweepTable& table) {
  constexpr std::string_view kContact = ".contact_ticks";
  return static_cast<std::size_t>(std::count_if(table.rows.begin(), table.rows.end(), [&](const SweepRow& row) {
    if (!row.done() || !row.line.contains("figures")) return false;
    bool any = false, touched = false;
    for (const auto& [name, value] : row.line["figures"].items()) {
      if (!name.ends_with(kContact)) continue;
      any = true;
      touched = touched || value != 0;
    }
    return any && !touched;
  }));
}

std::string merge_report(const SweepTable& table, const SweepNotes& notes) {
  PlanJson json;
  for (const char* key : {"pliant", "level", "level_hash"}) json[key] = table.sweep[key];
  json["axes"] = PlanJson::array();
  for (const SweepAxis& axis : table.axes) json["axes"].push_back({{"name", axis.name}, {"sampled", axis.sampled}});
  PlanJson failures = PlanJson::array(), missing = PlanJson::array();
  std::size_t done = 0, timed_out = 0;
  for (const SweepRow& row : table.rows) {
    if (row.done()) {
      ++done;
    } else if (row.line.is_null()) {
      missing.push_back({{"id", row.id}, {"axes", axes_of(row, table)}});
    } else {
      timed_out += row.line["status"] == "timed out";
      failures.push_back({{"id", row.id},
                          {"axes", axes_of(row, table)},
                          {"status", row.line["status"]},
                          {"exit", row.line.contains("exit") ? row.line["exit"] : PlanJson()},
                          {"error", row.line["error"]}});
    }
  }
  json["runs"] = table.rows.size();
  json["done"] = done;
  json["failed"] = failures.size() - timed_out;
  json["timed_out"] = timed_out;
  json["missing"] = missing.size();
  add_notes(notes, table, json);
  json["figures"] = summary(table);
  json["failures"] = std::move(failures);
  json["missing_runs"] = std::move(missing);
  json["disagree"] = table.disagree;
  json["timings"] = "timings.csv is measured by the clock: it is another at every run, and no figure here is of it";
  return json.dump(2, ' ', true, PlanJson::error_handler_t::replace) + "\n";
}

}  // namespace pliant
