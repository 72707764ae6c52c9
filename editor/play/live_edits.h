// What of a change of the document a session that runs can take at once, and what waits for the next Play.
#pragma once

#include <string>
#include <vector>

#include "editor/document/state.h"

namespace pliant {

struct LiveEdit {
  std::string object, key;  // as Session::set has them
  double value = 0.0;
};
struct LiveEdits {
  std::vector<LiveEdit> now;
  bool later = false;  // there is more that changed
};
LiveEdits live_edits(const State& before, const State& after);

}  // namespace pliant
