// Texts, lists and files that keys name, in a hash of what goes into a result.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/hash.h"

namespace pliant {

void add_text(Hash& hash, const std::string& text);
// The bytes of the file that a key calls `name`, relative to the level's folder, and of TetGen's other one. Nothing
// where no such file is there.
void add_named_file(Hash& hash, const std::filesystem::path& folder, const std::string& name);
// Of numbers without gaps between them.
template <class T>
void add_values(Hash& hash, const std::vector<T>& values) {
  hash.add(values.size());
  hash.add_bytes(values.data(), values.size() * sizeof(T));
}

}  // namespace pliant
