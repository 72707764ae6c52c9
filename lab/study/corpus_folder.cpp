#include "lab/study/corpus_folder.h"

#include <cstdlib>

#include "lab/files/content_folder.h"

namespace pliant {

std::filesystem::path corpus_folder() {
  if (const char* folder = std::getenv("PLIANT_CORPUS"); folder && *folder) return folder;
  std::error_code no;
  return std::filesystem::weakly_canonical(data_folder() / "corpus", no);
}

}  // namespace pliant
