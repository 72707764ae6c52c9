// A finding of a check of a file: severity, place, fault, remedy and code.
#pragma once

#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

enum class Severity {
  kError,    // the file is rejected
  kWarning,  // read, but perhaps not as its author expects
  kNote,     // worth knowing
};

struct Finding {
  Severity severity = Severity::kError;
  std::string pointer;  // JSON pointer, e.g. /meshes/0/primitives/0; empty: the whole file
  std::string what;     // the fault
  std::string cure;     // the remedy; empty: none is known
  std::string code;     // what programs go by: docs/codes.md
  std::string message() const { return sentence_of(what, cure); }
};
using Findings = std::vector<Finding>;

inline Error error_of(const Finding& finding) {
  return {finding.pointer, finding.what, finding.cure, finding.code};
}
// `family`: the code where the error has none.
inline Finding finding_of(const Error& error, std::string pointer, const char* family) {
  return {Severity::kError, std::move(pointer), error.what, error.cure, error.code.empty() ? family : error.code};
}
inline Finding finding_of(const Note& note, Severity severity, std::string pointer) {
  return {severity, std::move(pointer), note.what, note.cure, note.code};
}

inline bool any_error(const Findings& findings) {
  for (const Finding& finding : findings)
    if (finding.severity == Severity::kError) return true;
  return false;
}

}  // namespace pliant
