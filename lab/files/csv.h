// Text and numbers as the files in CSV have them: forces.csv and bodies.csv.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "components/math.h"

namespace pliant {

// A cell (RFC 4180): names come from files and may hold commas and quotes; the rest is made printable
// (runtime/printable.h), so that a row is one line. Every text in a CSV file goes through here.
//
// A spreadsheet evaluates a cell that begins with =, +, - or @ (full-width ones too), also behind blanks, and behind a
// semicolon where that separates cells. Where that is no number an apostrophe stands before it, which spreadsheets do
// not show as part of a formula and csv_cells() takes off.
std::string csv_text(const std::string& name);

// The cells of a line, with `mark` between them: one more than there are marks. In a cell in quotes, which blanks may
// stand before, marks mean nothing and two quotes are one. The apostrophes of csv_text() are taken off.
void csv_cells(std::string_view line, char mark, std::vector<std::string>& cells);

// Which cell of a header is `name`; kNoColumn: none.
inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);
std::size_t csv_column(const std::vector<std::string>& header, std::string_view name);

// Appends a comma and the value, with nine digits: exact for a float, and 1e-9 relative for what is kept in double. -0
// becomes 0, and so does what has decayed to (nearly) less than a double holds, so that every reader takes it.
void put(std::string& line, double value);
void put(std::string& line, const dvec3& v);  // x, y, z
void put(std::string& line, const dquat& q);  // w, x, y, z

}  // namespace pliant
