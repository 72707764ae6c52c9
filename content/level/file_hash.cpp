#include "content/level/file_hash.h"

#include "content/files/file_io.h"
#include "content/tets/tet_file.h"

namespace pliant {
namespace fs = std::filesystem;

void add_text(Hash& hash, const std::string& text) {
  hash.add(text.size());
  hash.add_bytes(text.data(), text.size());
}

void add_named_file(Hash& hash, const fs::path& folder, const std::string& name) {
  if (name.empty()) return;
  const Result<fs::path> named = confined_path(folder, name);
  if (!named) return;
  for (const fs::path& file : {*named, tetgen_partner(*named)}) {
    std::error_code no;
    if (file.empty() || !fs::is_regular_file(file, no)) continue;
    const Result<Bytes> bytes = read_file(file);
    if (!bytes) continue;  // whoever needs it says so
    hash.add(bytes->size());
    hash.add_bytes(bytes->data(), bytes->size());
  }
}

}  // namespace pliant
