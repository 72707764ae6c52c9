// What an indenter measured: force over depth, and over time where the file has it. Columns by name and unit, such as
// `time_s,depth_mm,force_N`; a run's forces.csv is read too.
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
  std::vector<bool> contact;  // of each row: as a run's file says it, else where the depth is above 0
  std::string probe;          // of a run's file, whose rows these are
  std::vector<std::string> notes;
  std::size_t size() const { return depth.size(); }
};

// Between commas, semicolons or tabs; between the latter two numbers may have decimal commas. Names of columns, and the
// units that they may end with, as NAME_UNIT, `NAME [UNIT]` or `NAME (UNIT)`:
//   time, t: s ms us min h;  depth, indentation, displacement, d: m cm mm um nm;  force, load, f: N mN uN nN kN.
// `probe`: of a forces.csv with several, which one. `whole`: of a forces.csv the norm of the force, with friction, as a
// report has it, instead of the normal one. A tool's rows are refused. Errors name the file and the line.
Result<PressRecord> read_press(const std::filesystem::path& file, const std::string& probe = {}, bool whole = false);
Result<PressRecord> parse_press(std::string_view text, const std::string& where, const std::string& probe = {},
                                bool whole = false);

}  // namespace pliant
