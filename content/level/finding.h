// What a check found in a file: where (a JSON pointer, or empty for the file as a whole), what, and how bad.
#pragma once

#include <string>
#include <vector>

namespace pliant {

enum class Severity {
  kError,    // the file is refused
  kWarning,  // read, but not as its author may expect
  kNote,     // worth knowing
};

struct Finding {
  Severity severity = Severity::kError;
  std::string pointer;  // JSON pointer, e.g. /meshes/0/primitives/0
  std::string message;  // what is wrong, and after a semicolon what to do
};
using Findings = std::vector<Finding>;

inline bool any_error(const Findings& findings) {
  for (const Finding& finding : findings)
    if (finding.severity == Severity::kError) return true;
  return false;
}

}  // namespace pliant
