// The motion of a probe or tool in a run as an editable path: few keys, and their error.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "editor/document/surface_path.h"
#include "editor/play/play.h"

namespace pliant {

struct RecordedPath {
  ScriptKeys keys;     // from 0 s on
  double begin = 0.0;  // [s] of the run at the first key
  double error = 0.0;  // [m] the largest deviation of the followed script from the run at any tick
};

// Of effector `which` of `count`, without rest before and after. As few keys as a smooth curve within `tolerance` [m]
// of the run needs; heights are relative to the closest surface.
Result<RecordedPath> path_of_past(const PlayPast& past, std::size_t which, std::size_t count, double rate,
                                  double tolerance, const std::vector<PathSurface>& surfaces = {});

// Makes the motion of the named probe or tool in the current or last run the script of its device, in one undoable
// step. A probe that is not in the document (the mouse's) is added. Runs in the background; the result is reported.
void record_path(Editor& editor, Play& play, const std::string& name, double tolerance);

}  // namespace pliant
