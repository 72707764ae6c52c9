// The part of `pliant inspect` that knows tetrahedra: of a file of them, and of a level's soft bodies.
#pragma once

#include <nlohmann/json.hpp>
#include <stop_token>

#include "content/level/level.h"
#include "content/mesh/mesh_build.h"

namespace pliant {

// Tissue of each soft body as it would be spawned: nodes by group, tetrahedra, volume, quality, pieces, and
// `problems`, what it will not do well. An object with
// `problem` stands for a level that cannot be spawned. Empty: the level has no soft body.
nlohmann::ordered_json describe_tissue(const Level& level);
void print_tissue(const nlohmann::ordered_json& tissue);

// What a bare mesh would be as tissue, with the defaults of PLIANT_soft_body: preview_soft_body as JSON, or
// {"problem"}, or null where `stop` came first.
nlohmann::ordered_json describe_as_tissue(const BuiltMesh& surface, const std::stop_token& stop);
void print_as_tissue(const nlohmann::ordered_json& tissue);

// Says what is in a file of tetrahedra; returns the exit status.
int inspect_tets(const std::filesystem::path& path, bool as_json);

}  // namespace pliant
