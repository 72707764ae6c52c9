// A small picture and the description of each shipped level: read in the background, drawn if missing.
#pragma once

#include <imgui.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pliant {

class Editor;

struct LevelPicture {
  std::string about;
  unsigned texture = 0;          // 0: none (yet)
  ImVec2 low{0, 0}, high{1, 1};  // of the texture that is shown
};

class LevelPictures {
 public:
  // Starts reading if needed. On the interface's thread with its context current, as in every call.
  void update(Editor& editor, const std::vector<std::filesystem::path>& levels);
  const LevelPicture& of(const std::filesystem::path& level) { return pictures_[level]; }

 private:
  std::map<std::filesystem::path, LevelPicture> pictures_;
  bool read_texts_ = false;
  std::size_t next_ = 0;
};

}  // namespace pliant
