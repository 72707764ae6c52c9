// All findings of `pliant validate`.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>

#include "components/world.h"
#include "content/level/finding.h"
#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

// Checks the document against glTF 2.0 and the PLIANT_* extensions against their table, then builds the meshes; each
// step relies on the previous one. Returns all findings; the level can be loaded if none is an error. `prepare` runs
// the checks that a run performs on a world before its first tick (content does not depend on systems).
// `unit` [m]: of a bare mesh; empty: not said.
Findings validate_level(const std::filesystem::path& path, const std::function<Status(World&)>& prepare = {},
                        std::optional<double> unit = {});

// The same for a level in memory whose document has been checked; referenced files are looked up beside `level.path`.
// Once `stop` is set it soon returns the findings so far.
Findings validate_level(Level level, const std::function<Status(World&)>& prepare = {},
                        const std::atomic<bool>* stop = nullptr);

}  // namespace pliant
