// Makes text of unknown origin (names from files, arguments, devices) safe for a terminal, a table or a plot.
#pragma once

#include <string>
#include <string_view>

namespace pliant {

// Valid UTF-8 on one line. Control bytes and DEL are escaped as \n, \r, \t or \x1b, bytes that are not valid UTF-8 as
// \x9b. C1 controls, bidirectional controls, and line and paragraph separators are escaped as \u202e. Everything else
// is unchanged, including the backslash.
std::string printable(std::string_view text);

}  // namespace pliant
