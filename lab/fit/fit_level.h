// The level that a fit is written into.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"
#include "lab/fit/fit.h"

namespace pliant {

// A file or the name of a shipped level.
Result<Level> level_to_fit(const std::string& name, double unit);
// The node of that name, which has a mesh; errors name those that have one.
Result<std::int32_t> object_to_fit(const Level& level, const std::string& name);
// `out` is glTF, and free or to be replaced.
Status check_out(const FitOptions& options);
// The level into `out`, and the files that it names but `out` has not beside it, in a note.
Status save_fitted(const Level& level, const FitOptions& options);

}  // namespace pliant
