// What a person types into a field of numbers: "5 mm", "1/10", "0,1", "2*(3 + 1) cm", "45 deg", "1.2 N/mm".
//
// A number without a unit is in the field's own. Units are SI's with their prefixes and a few that stand on rulers and
// in papers (in, ft, deg, bar, min); kept apart by dimension, so that a force is no length. What could be read in two
// ways is refused, never guessed: "1,000", "5 mm + 3", a unit of another dimension.
#pragma once

#include <string>
#include <string_view>

#include "runtime/result.h"

namespace pliant::ui {

// `unit` is the field's: "mm", "N/m", "kg/m3", "%"; "", "1" and "\u00d7" are of plain numbers. The value is in it.
// Errors are half a sentence with the cure, for behind what was typed.
Result<double> parse_quantity(std::string_view text, std::string_view unit);

// How many of `unit` one of its SI base is: 1000 of "mm"; 1 of what is no unit of the table (lx, cd).
double in_si(std::string_view unit);

}  // namespace pliant::ui
