// A scene behind its handle.
#pragma once

#include <string>
#include <vector>

#include "c/border.h"

namespace pliant::c {

struct SceneHandle : Handle {
  Scene scene;
  std::vector<std::string> notes;
  std::string folder;  // of a scene from memory: was its file's, and is not part of a sentence
};

// Without the folder in which a scene from memory was.
std::string without(std::string text, const std::string& folder);
Error without(Error error, const std::string& folder);

OpenProgress progress_of_c(pliant_progress progress, void* user);

}  // namespace pliant::c
