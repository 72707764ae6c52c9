// Text of unknown origin (names from files, arguments, devices) as it may stand in a terminal, a table or a plot.
#pragma once

#include <string>
#include <string_view>

namespace pliant {

// Valid UTF-8 on one line. What a terminal would act on, or what would reorder or break the line, is written as an
// escape: control bytes and DEL as \n, \r, \t or \x1b, bytes that are no UTF-8 as \x9b; C1 controls, bidirectional
// controls, and line and paragraph separators as \u202e. Everything else is as it was, the backslash too.
std::string printable(std::string_view text);

}  // namespace pliant
