// A finding of a check of a file: place (a JSON pointer, or empty for the whole file), message and severity.
#pragma once

#include <string>
#include <vector>

namespace pliant {

enum class Severity {
  kError,    // the file is rejected
  kWarning,  // read, but perhaps not as its author expects
  kNote,     // worth knowing
};

struct Finding {
  Severity severity = Severity::kError;
  std::string pointer;  // JSON pointer, e.g. /meshes/0/primitives/0
  std::string message;  // the fault, and after a semicolon the remedy
};
using Findings = std::vector<Finding>;

inline bool any_error(const Findings& findings) {
  for (const Finding& finding : findings)
    if (finding.severity == Severity::kError) return true;
  return false;
}

}  // namespace pliant
