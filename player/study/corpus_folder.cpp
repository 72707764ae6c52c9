#include "player/study/corpus_folder.h"

#include <cstdlib>

namespace pliant {

std::filesystem::path corpus_folder() {
  if (const char* told = std::getenv("PLIANT_CORPUS"); told && *told) return told;
  return PLIANT_CORPUS_DIR;
}

}  // namespace pliant
