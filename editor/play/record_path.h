// The way that a probe or tool took in a run, as a path that can be edited: few keys, and how far they are from it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "editor/document/surface_path.h"
#include "editor/play/play.h"

namespace pliant {

struct RecordedPath {
  ScriptKeys keys;     // from 0 s on
  double begin = 0.0;  // [s] of the run: where the first key is
  double error = 0.0;  // [m] the farthest that the script, as it is followed, is from the run at any tick
};

// Of effector `which` of `count`, without its rest before and after. As few keys as a smooth curve within `tolerance`
// [m] of the run needs; each has its height over the closest of the surfaces.
Result<RecordedPath> path_of_past(const PlayPast& past, std::size_t which, std::size_t count, double rate,
                                  double tolerance, const std::vector<PathSurface>& surfaces = {});

// Of the probe or tool of this name in the run that is on, or in the last one: becomes the script of its device, in one
// step that can be undone. A probe that is not the document's (the mouse's) becomes one. The work is done in the
// background; what came of it is said.
void record_path(Editor& editor, Play& play, const std::string& name, double tolerance);

}  // namespace pliant
