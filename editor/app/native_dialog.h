// The desktop's file dialog through zenity or kdialog, if installed.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

namespace pliant {

struct FileRequest {
  std::string title;
  bool save = false;
  std::filesystem::path folder;  // initial folder
  std::string name;              // suggested name for saving
};

bool program_there(const char* program);  // in the folders of PATH
bool native_dialog_there();
// Blocks until answered; call on a separate thread. Empty: no choice, or `stop` was set. False: no dialog could be
// shown.
bool native_dialog(const FileRequest& request, const std::atomic<bool>& stop, std::filesystem::path& chosen);

}  // namespace pliant
