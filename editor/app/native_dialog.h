// The desktop's own dialog for files: zenity or kdialog, where there is one.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

namespace pliant {

struct FileWish {
  std::string title;
  bool save = false;
  std::filesystem::path folder;  // where one begins
  std::string name;              // of what is saved, suggested
};

bool native_dialog_there();
// Waits for the answer, on a thread of its own. Empty: nothing was chosen, or `stop` was set. False: no dialog came up.
bool native_dialog(const FileWish& wish, const std::atomic<bool>& stop, std::filesystem::path& chosen);

}  // namespace pliant
