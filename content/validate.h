// Everything that `pliant validate` says of a level.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

#include "components/world.h"
#include "content/level/finding.h"
#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

// The document against glTF 2.0, the PLIANT_* extensions against their table, then what only shows when meshes are
// built: each step relies on the one before. All findings, not only the first; the level can be loaded if none is an
// error. `prepare` is what a run does to a world before its first tick, and what it refuses then (content knows no
// systems).
Findings validate_level(const std::filesystem::path& path, const std::function<Status(World&)>& prepare = {});

// The same of a level in memory, whose document has been heard; files that it names are sought beside `level.path`.
// Once `stop` is set it soon returns what it has found so far.
Findings validate_level(Level level, const std::function<Status(World&)>& prepare = {},
                        const std::atomic<bool>* stop = nullptr);

}  // namespace pliant
