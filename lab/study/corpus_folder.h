// Location of the mesh corpus.
#pragma once

#include <filesystem>

namespace pliant {

// PLIANT_CORPUS from the environment, else the data folder's corpus/ (in a build tree, the one beside the source tree).
// The folder may be absent.
std::filesystem::path corpus_folder();

}  // namespace pliant
