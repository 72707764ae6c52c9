// Text and numbers in the CSV files of a run: forces.csv and bodies.csv.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "components/math.h"

namespace pliant {

// A text cell (RFC 4180). Names come from files and may contain commas and quotes; control characters are made
// printable (runtime/printable.h), so that a row is one line. Every text in a CSV file is written by this function.
//
// A spreadsheet evaluates a cell that begins with =, +, - or @ (full-width ones too), also after blanks, or after a
// semicolon where semicolons separate cells. Unless such a cell is a number, an apostrophe is put before it.
// Spreadsheets hide that apostrophe, and csv_cells() removes it.
std::string csv_text(const std::string& name);

// Splits a line at `mark`: one more cell than there are marks. In a quoted cell (blanks may precede the quote) marks
// are literal and two quotes are one. The apostrophes that csv_text() adds are removed.
void csv_cells(std::string_view line, char mark, std::vector<std::string>& cells);

// Index of the column `name` in a header; kNoColumn if there is none.
inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);
std::size_t csv_column(const std::vector<std::string>& header, std::string_view name);

// Appends a comma and the value with nine digits: exact for a float, 1e-9 relative for a double. -0 and magnitudes
// below 1e-100 are written as 0, so that every reader accepts them.
void put(std::string& line, double value);
void put(std::string& line, const dvec3& v);  // x, y, z
void put(std::string& line, const dquat& q);  // w, x, y, z

}  // namespace pliant
