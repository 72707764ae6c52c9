// A list of findings that grows, up to as many as a reader can use.
#pragma once

#include <string>
#include <utility>

#include "content/level/finding.h"

namespace pliant {

class FindingList {
 public:
  // `code`: of every finding that has no other.
  FindingList(Findings& findings, const char* code) : findings_(findings), code_(code) {}
  void error(std::string pointer, std::string what, std::string cure = {}) {
    add({Severity::kError, std::move(pointer), std::move(what), std::move(cure), code_});
  }
  void warn(std::string pointer, std::string what, std::string cure = {}) {
    add({Severity::kWarning, std::move(pointer), std::move(what), std::move(cure), code_});
  }
  void add(Finding finding) {
    if (findings_.size() < kMostFindings) findings_.push_back(std::move(finding));
  }

 private:
  static constexpr std::size_t kMostFindings = 1000;
  Findings& findings_;
  const char* const code_;
};

}  // namespace pliant
