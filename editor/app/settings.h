// What the editor remembers of its user: $XDG_CONFIG_HOME/pliant/editor.json, else ~/.config/pliant/editor.json. A file
// that cannot be read is set aside, never overwritten silently.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

struct Settings {
  static constexpr std::size_t kMostRecent = 12;
  bool light = false;                            // theme
  double scale = 0.0;                            // [1] of the interface; 0: the display's
  double left = 260, right = 330, bottom = 210;  // [point] sizes of the panels
  std::vector<std::string> recent;               // files, newest first
  std::map<std::string, std::string> keys;       // action id -> keys, where they differ from the default
  std::map<std::string, std::string> presets;    // name -> JSON, of the user's own
  bool snap = false;
  double snap_move = 0.01, snap_turn = 15.0, snap_scale = 0.1;  // [m], [degrees], [1]
  bool local_axes = false;
  double autosave = 30.0;  // [s] between copies for recovery

  // `folder` empty: the user's. `note` gets a sentence where something was not as it should be.
  static Settings load(const std::filesystem::path& folder, std::string& note);
  Status save() const;                           // atomically
  void used(const std::filesystem::path& file);  // is the newest of `recent`

 private:
  std::filesystem::path file_;
};

// Where recovery copies of documents without a file go; made when it is first written to.
std::filesystem::path state_folder();

}  // namespace pliant
