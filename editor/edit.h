// The editor as the command calls it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

struct EditOptions {
  std::string file;                           // a level or a mesh; empty: the start page
  double unit = 1.0;                          // [m] that one unit of a bare mesh is
  std::string input;                          // a script of events (editor/ui/script.h); empty: only the hand
  std::string out = ".";                      // folder of the script's screenshots
  int width = 1600, height = 900;             // [pixel]
  std::string config;                         // folder of settings; empty: the user's own
  std::vector<std::filesystem::path> levels;  // that ship, for the start page
};

// Until the window is closed. An error is what kept the editor from opening, or a script's step that failed.
Status edit(const EditOptions& options);

}  // namespace pliant
