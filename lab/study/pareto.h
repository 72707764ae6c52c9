// Cost against error: what every study measures, how it is written and drawn.
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

// What stands in a table's further columns. A number that is not finite was not measured, or says that it failed: an
// empty cell in the CSV, null in the JSON.
using StudyValue = std::variant<std::string, double, std::int64_t, bool>;

// A way to do the job. An error that is not finite says that it failed: it is on no front, and stands on the plot's
// upper edge.
struct ParetoRow {
  std::string label;             // of the point on the plot: short
  double cost = 0.0;             // > 0; a timing differs from run to run
  double error = 0.0;            // >= 0; the same bits in every run
  std::string group;             // points of one group share a colour, and a line where `joined`
  std::vector<StudyValue> more;  // the table's columns of that name
  double floor = 0.0;            // what was measured resolves no less: a smaller error counts, and is drawn, as this
  double resolved() const { return std::isfinite(error) ? std::max(error, floor) : error; }
};

struct ParetoTable {
  std::string study;                           // names the files
  std::string title;                           // one line: what is compared with what
  std::string cost_name, cost_axis;            // column, such as cost_us; axis, with its unit
  std::string error_name, error_axis;          // the same
  std::vector<std::string> more;               // further columns, the same in every run
  std::vector<ParetoRow> rows;                 //
  std::vector<std::string> sentences;          // what it shows, computed from the rows
  bool front_by_group = false;                 // each group has a front of its own: it answers a question of its own
  bool joined = true;                          // points of a group are joined in their order
  std::vector<std::size_t> drawn = {};         // rows on the plot; empty: all
  double least_error = 0.0, most_error = 0.0;  // the plot's range; 0: the rows' own. What is beyond stands on the edge,
                                               // as an arrow
};

// The rows that none betters in cost and error both, the cheapest first. Of equals the first.
std::vector<std::size_t> pareto_front(const std::vector<ParetoRow>& rows);

// Of the whole table, or of each group; places in table.rows.
std::vector<std::vector<std::size_t>> fronts(const ParetoTable& table, const std::vector<std::size_t>& rows);
std::vector<std::vector<std::size_t>> fronts(const ParetoTable& table);

// Columns: group, label, `more`, error, cost, and whether the row is on the front.
std::string to_csv(const ParetoTable& table);
// Study, title, units, rows, front, sentences. Numbers that are not finite are null.
nlohmann::ordered_json to_json(const ParetoTable& table);

// With two digits, for sentences: 0.0031, 37, 6,200.
std::string two_digits(double value);

// STUDY.csv, STUDY.json, STUDY.svg and STUDY.png; prints the front and the sentences. `further`: members of the JSON
// between the front and the sentences.
Status write_study(OutputFolder& out, const ParetoTable& table, const nlohmann::ordered_json& further);
Status write_study(OutputFolder& out, const ParetoTable& table);
Status write_json(OutputFolder& out, const std::string& name, const nlohmann::ordered_json& json);
// One of a study's further files.
Status write_text(OutputFolder& out, const std::string& name, const std::string& text);
// What a study, or another verb, that was ended early returns.
Error interrupted(const char* verb = "study");
// STEM.svg and STEM.png.
Status plot_pareto(OutputFolder& out, const std::string& stem, const ParetoTable& table);

}  // namespace pliant
