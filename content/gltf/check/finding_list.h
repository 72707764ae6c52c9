// A list of findings that grows, up to as many as a reader can use.
#pragma once

#include <string>
#include <utility>

#include "content/level/finding.h"

namespace pliant {

class FindingList {
 public:
  explicit FindingList(Findings& findings) : findings_(findings) {}
  void error(std::string pointer, std::string message) {
    add(Severity::kError, std::move(pointer), std::move(message));
  }
  void warn(std::string pointer, std::string message) {
    add(Severity::kWarning, std::move(pointer), std::move(message));
  }

 private:
  static constexpr std::size_t kMostFindings = 1000;
  void add(Severity severity, std::string pointer, std::string message) {
    if (findings_.size() < kMostFindings) findings_.push_back({severity, std::move(pointer), std::move(message)});
  }
  Findings& findings_;
};

}  // namespace pliant
