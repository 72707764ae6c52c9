// Parses the text of number fields: "5 mm", "1/10", "0,1", "2*(3 + 1) cm", "45 deg", "1.2 N/mm".
//
// A number without a unit is in the field's own. Units are SI with prefixes, and some common ones (in, ft, deg, bar,
// min). Dimensions are checked: a force is not a length. Ambiguous text is rejected, never guessed: "1,000", "5 mm +
// 3", a unit of another dimension.
#pragma once

#include <string>
#include <string_view>

#include "runtime/result.h"

namespace pliant::ui {

// `unit` is the field's: "mm", "N/m", "kg/m3", "%"; "", "1" and "\u00d7" are plain numbers. The result is in it. Errors
// are half a sentence with the remedy, to follow the typed text.
Result<double> parse_quantity(std::string_view text, std::string_view unit);

// Conversion factor from SI to `unit`: 1000 for "mm"; 1 for units not in the table (lx, cd).
double in_si(std::string_view unit);

}  // namespace pliant::ui
