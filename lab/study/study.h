// `pliant study`: speed against error, measured on the shipped code.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

struct StudyOptions {
  std::string name;  // name of a study, or "all"
  std::string out;   // folder; empty: out/study
  bool quick = false;
  bool force = false;  // replace an earlier study's files
  bool list = false;
};
int study(const StudyOptions& options);

}  // namespace pliant
