// The part of `pliant inspect` for tetrahedra: of a tetrahedral file, and of a level's soft bodies.
#pragma once

#include <nlohmann/json.hpp>
#include <stop_token>

#include "content/level/level.h"
#include "content/mesh/mesh_build.h"

namespace pliant {

// Tissue of each soft body as it would be spawned: nodes by group, tetrahedra, volume, quality, pieces, and `problems`,
// its expected deficiencies. A single object with `problem`: the level cannot be spawned. Empty: the level has no soft
// body.
nlohmann::ordered_json describe_tissue(const Level& level);
void print_tissue(const nlohmann::ordered_json& tissue);

// A bare mesh as tissue, with the defaults of PLIANT_soft_body: preview_soft_body as JSON, or {"problem"}, or null if
// `stop` was requested first.
nlohmann::ordered_json describe_as_tissue(const BuiltMesh& surface, const std::stop_token& stop);
void print_as_tissue(const nlohmann::ordered_json& tissue);

// Prints the contents of a tetrahedral file; returns the exit status.
int inspect_tets(const std::filesystem::path& path, bool as_json);

}  // namespace pliant
