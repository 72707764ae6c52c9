// Where the corpus of meshes lies.
#pragma once

#include <filesystem>

namespace pliant {

// PLIANT_CORPUS from the environment, else the data folder's corpus/: in a build tree, what lies beside the source
// tree. It need not be there.
std::filesystem::path corpus_folder();

}  // namespace pliant
