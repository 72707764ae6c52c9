// Cost against error: the table of a study, its files and its plot.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

#include "lab/files/output_folder.h"

namespace pliant {

// A value of a further column. A number that is not finite was not measured, or failed: an empty cell in the CSV, null
// in the JSON.
using StudyValue = std::variant<std::string, double, std::int64_t, bool>;

// One method of a study. An error that is not finite means failure: the row is on no front and is drawn on the plot's
// upper edge.
struct ParetoRow {
  std::string label;             // short label of the point on the plot
  double cost = 0.0;             // > 0; a timing varies between runs
  double error = 0.0;            // >= 0; identical to the bit in every run
  std::string group;             // points of a group share a colour, and a line if `joined`
  std::vector<StudyValue> more;  // values of the table's `more` columns
  double floor = 0.0;            // resolution of the measurement: a smaller error is compared and drawn as this
  double resolved() const { return std::isfinite(error) ? std::max(error, floor) : error; }
};

struct ParetoTable {
  std::string study;                           // stem of the file names
  std::string title;                           // one line: what is compared
  std::string cost_name, cost_axis;            // column, such as cost_us; axis title with unit
  std::string error_name, error_axis;          // the same
  std::vector<std::string> more;               // further columns, identical in every run
  std::vector<ParetoRow> rows;                 //
  std::vector<std::string> sentences;          // conclusions computed from the rows
  bool front_by_group = false;                 // one front per group: each group answers a separate question
  bool joined = true;                          // points of a group are joined in their order
  std::vector<std::size_t> drawn = {};         // rows on the plot; empty: all
  double least_error = 0.0, most_error = 0.0;  // range of the plot; 0: of the rows. Arrows mark values beyond
};

// Rows not dominated in cost and error, the cheapest first. Of equal rows, the first.
std::vector<std::size_t> pareto_front(const std::vector<ParetoRow>& rows);

// Front of the whole table, or of each group, as indices into table.rows.
std::vector<std::vector<std::size_t>> fronts(const ParetoTable& table, const std::vector<std::size_t>& rows);
std::vector<std::vector<std::size_t>> fronts(const ParetoTable& table);

// Columns: group, label, `more`, error, cost, and whether the row is on the front.
std::string to_csv(const ParetoTable& table);
// Study, title, units, rows, front, sentences. Numbers that are not finite become null.
nlohmann::ordered_json to_json(const ParetoTable& table);

// Two significant digits, for sentences: 0.0031, 37, 6,200.
std::string two_digits(double value);

// Writes STUDY.csv, STUDY.json, STUDY.svg and STUDY.png; prints the front and the sentences. `further`: members of the
// JSON between the front and the sentences.
Status write_study(OutputFolder& out, const ParetoTable& table, const nlohmann::ordered_json& further);
Status write_study(OutputFolder& out, const ParetoTable& table);
Status write_json(OutputFolder& out, const std::string& name, const nlohmann::ordered_json& json);
// Writes a further file of a study.
Status write_text(OutputFolder& out, const std::string& name, const std::string& text);
// Error returned by an interrupted study or other verb.
Error interrupted(const char* verb = "study");
// Writes STEM.svg and STEM.png.
Status plot_pareto(OutputFolder& out, const std::string& stem, const ParetoTable& table);

}  // namespace pliant
