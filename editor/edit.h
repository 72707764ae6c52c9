// The editor's interface for the command.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

struct EditOptions {
  std::string file;                           // a level or a mesh; empty: the start page
  double unit = 1.0;                          // [m] length unit of a bare mesh
  std::string input;                          // a script of events (editor/ui/script.h); empty: user input
  std::string out = ".";                      // folder of the script's screenshots
  int width = 1600, height = 900;             // [pixel]
  std::string config;                         // folder of settings; empty: the user's own
  std::vector<std::filesystem::path> levels;  // shipped levels, for the start page
};

// Runs until the window is closed. Error: the editor could not open, or a script's step failed.
Status edit(const EditOptions& options);

}  // namespace pliant
