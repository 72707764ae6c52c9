// Tetrahedral meshes of the corpus, prepared for tests. Without the corpus there are none: skip.
#pragma once

#include <filesystem>

#include "components/tet_mesh.h"
#include "content/tets/tet_file.h"

namespace pliant::scenes {

inline constexpr double kCorpusSize = 0.1;  // [m] size to which every mesh is scaled

// `corpus`: the folder.
std::vector<std::filesystem::path> corpus_tets(const std::filesystem::path& corpus);

// Scaled, placed on the origin, each piece pinned at the lowest quarter of its height: one would topple otherwise.
TetMesh stand(TetFile file);

}  // namespace pliant::scenes
