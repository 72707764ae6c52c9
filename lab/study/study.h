// `pliant study`: speed against error, measured on what ships.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

struct StudyOptions {
  std::string name;  // of a study, or "all"
  std::string out;   // folder; empty: out/study
  bool quick = false;
  bool force = false;  // replaces what an earlier study wrote
  bool list = false;
};
int study(const StudyOptions& options);

}  // namespace pliant
