// The shipped levels as cards, each with its picture and what it shows.
#pragma once

#include <filesystem>

#include "editor/app/app.h"
#include "editor/panels/level_pictures.h"

namespace pliant {

class LevelCards {
 public:
  // Opens the one that is pressed.
  void draw(App& app, Editor& editor);

 private:
  bool card(const std::filesystem::path& level, float w, float picture, float h);

  LevelPictures pictures_;
};

}  // namespace pliant
