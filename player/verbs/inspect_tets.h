// The part of `pliant inspect` that knows tetrahedra: of a file of them, and of a level's soft bodies.
#pragma once

#include <nlohmann/json.hpp>

#include "content/level/level.h"

namespace pliant {

// Tissue of each soft body as it would be spawned: nodes by group, tetrahedra, volume, quality, pieces, and
// `problems`, what it will not do well. An object with
// `problem` stands for a level that cannot be spawned. Empty: the level has no soft body.
nlohmann::ordered_json describe_tissue(const Level& level);
void print_tissue(const nlohmann::ordered_json& tissue);

// Says what is in a file of tetrahedra; returns the exit status.
int inspect_tets(const std::filesystem::path& path, bool as_json);

}  // namespace pliant
