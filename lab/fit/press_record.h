// The record of an indenter: force over depth, and over time if the file has it. Columns are found by name and unit,
// such as `time_s,depth_mm,force_N`. A run's forces.csv is read too.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/result.h"

namespace pliant {

struct PressRecord {
  std::string name;           // of the file
  std::vector<double> time;   // [s] ascending; empty: the file has none
  std::vector<double> depth;  // [m] > 0: pressed in
  std::vector<double> force;  // [N] > 0: against the indenter
  std::vector<bool> contact;  // per row: in contact, from a run's file, or else depth > 0
  std::string probe;          // of a run's file: the probe these rows belong to
  std::vector<std::string> notes;
  std::size_t size() const { return depth.size(); }
};

// Cells are separated by commas, semicolons or tabs; with the latter two, numbers may have decimal commas. Column names
// may end with a unit, as NAME_UNIT, `NAME [UNIT]` or `NAME (UNIT)`:
//   time, t: s ms us min h;  depth, indentation, displacement, d: m cm mm um nm;  force, load, f: N mN uN nN kN.
// `probe`: selects one of several in a forces.csv. `whole`: of a forces.csv, takes the norm of the force with friction,
// as in a report, instead of the normal force. Rows of a tool are rejected. Errors name the file and the line.
Result<PressRecord> read_press(const std::filesystem::path& file, const std::string& probe = {}, bool whole = false);
Result<PressRecord> parse_press(std::string_view text, const std::string& where, const std::string& probe = {},
                                bool whole = false);

}  // namespace pliant
