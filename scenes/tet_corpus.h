// Tetrahedral meshes of the corpus, prepared for tests. Without the corpus the list is empty: skip.
#pragma once

#include <filesystem>

#include "components/tet_mesh.h"
#include "content/tets/tet_file.h"

namespace pliant::scenes {

inline constexpr double kCorpusSize = 0.1;  // [m] size to which every mesh is scaled

// `corpus`: the folder.
std::vector<std::filesystem::path> corpus_tets(const std::filesystem::path& corpus);

// Scaled, above the origin, each piece pinned in the lowest quarter of its height, so that none topples.
TetMesh stand(TetFile file);

}  // namespace pliant::scenes
