// The user's settings: $XDG_CONFIG_HOME/pliant/editor.json, else ~/.config/pliant/editor.json. An unreadable file is
// renamed, never silently overwritten.
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
  std::map<std::string, std::string> keys;       // action id -> keys, if they differ from the default
  std::map<std::string, std::string> presets;    // the user's presets: name -> JSON
  bool snap = false;
  double snap_move = 0.01, snap_turn = 15.0, snap_scale = 0.1;  // [m], [degrees], [1]
  bool local_axes = false;
  std::string navigation;                // of other programs (editor/app/navigation.h); "": the editor's own
  std::map<std::string, bool> sections;  // those opened or closed otherwise than at first, by address
  double autosave = 30.0;                // [s] between copies for recovery

  // Empty `folder`: the user's. `note` receives a sentence if the file is faulty.
  static Settings load(const std::filesystem::path& folder, std::string& note);
  Status save() const;                           // atomically
  void used(const std::filesystem::path& file);  // moves it to the front of `recent`

 private:
  std::filesystem::path file_;
};

// Folder of recovery copies of documents without a file; created on first use.
std::filesystem::path state_folder();

}  // namespace pliant
