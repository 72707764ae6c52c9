// Divides a change of the document into parameters that a running session can apply at once, and the rest, which waits
// for the next Play.
#pragma once

#include <string>
#include <vector>

#include "editor/document/state.h"

namespace pliant {

struct LiveEdit {
  std::string object, key;  // as in Session::set
  double value = 0.0;
};
struct LiveEdits {
  std::vector<LiveEdit> now;
  bool later = false;  // there are other changes
};
LiveEdits live_edits(const State& before, const State& after);

}  // namespace pliant
