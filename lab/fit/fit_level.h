// Loading, checking and saving the level that a fit writes its keys into.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"
#include "lab/fit/fit.h"

namespace pliant {

// A file or the name of a shipped level.
Result<Level> level_to_fit(const std::string& name, std::optional<double> unit);
// Index of the node of that name that has a mesh; errors list the nodes that have one.
Result<std::int32_t> object_to_fit(const Level& level, const std::string& name);
// Checks that `out` is glTF and does not exist or may be replaced.
Status check_out(const FitOptions& options);
// Writes the level to `out`; a note lists referenced files that are missing beside `out`.
Status save_fitted(const Level& level, const FitOptions& options);

}  // namespace pliant
