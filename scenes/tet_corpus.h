// Tetrahedral meshes of the corpus, ready to stand in a test. Where the corpus is absent there are none: skip.
#pragma once

#include <filesystem>

#include "components/tet_mesh.h"
#include "content/tets/tet_file.h"

namespace pliant::scenes {

inline constexpr double kCorpusSize = 0.1;  // [m] what every mesh is scaled to

// `corpus`: the folder.
std::vector<std::filesystem::path> corpus_tets(const std::filesystem::path& corpus);

// Scaled, from the origin up, each piece held by the lowest quarter of its height: one topples otherwise.
TetMesh stand(TetFile file);

}  // namespace pliant::scenes
