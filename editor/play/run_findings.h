// Problems of a probe or tool in a run: its force was withheld, or it touched nothing.
#pragma once

#include <string>
#include <vector>

#include "editor/play/play.h"

namespace pliant {

struct RunFinding {
  std::string effector;
  std::string brief;  // beside the picture, while it lasts; empty: none
  std::string text;   // half a sentence with its remedy, after the name; empty: none yet
};
std::vector<RunFinding> run_findings(const State& state, const PlayStatus& status,
                                     const std::vector<PlayTrace>& traces);

}  // namespace pliant
