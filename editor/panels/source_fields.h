// The fields of a level that is played: what moves each of its probes and tools.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "editor/core/panel.h"
#include "editor/play/play.h"

namespace pliant {

inline constexpr const char* kMouseSource = "mouse";

class SourceFields {
 public:
  void draw(Editor& editor, Play& play);

 private:
  void draw_source(Play& play, const std::string& name, const std::vector<std::string>& choices);

  std::map<std::string, std::string> files_;  // of scripts, as they are typed
};

}  // namespace pliant
