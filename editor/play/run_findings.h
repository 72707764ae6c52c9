// What a run has shown to be wrong with a probe or tool: its force was withheld, or it touched nothing.
#pragma once

#include <string>
#include <vector>

#include "editor/play/play.h"

namespace pliant {

struct RunFinding {
  std::string effector;
  std::string brief;  // beside the picture, while it is so; empty: not now
  std::string text;   // half a sentence with its cure, behind the name; empty: nothing yet
};
std::vector<RunFinding> run_findings(const State& state, const PlayStatus& status,
                                     const std::vector<PlayTrace>& traces);

}  // namespace pliant
