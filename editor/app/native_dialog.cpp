#include "editor/app/native_dialog.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <vector>

#include "content/openable.h"

extern char** environ;

namespace pliant {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> command_of(const FileRequest& request) {
  const std::string start = (request.folder / request.name).string();
  if (program_there("zenity")) {
    std::vector<std::string> command{"zenity", "--file-selection", "--title=" + request.title, "--filename=" + start};
    if (request.save) command.push_back("--save");
    if (!request.save) {
      std::string filter = "--file-filter=Levels and meshes |";
      for (const std::string& ending : openable_endings()) filter += " *" + ending;
      command.push_back(filter);
      command.push_back("--file-filter=All files | *");
    }
    return command;
  }
  return {"kdialog", request.save ? "--getsavefilename" : "--getopenfilename", start, "--title", request.title};
}

}  // namespace

bool program_there(const char* program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

bool native_dialog_there() {
  return program_there("zenity") || program_there("kdialog");
}

bool native_dialog(const FileRequest& request, const std::atomic<bool>& stop, fs::path& chosen) {
  chosen.clear();
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return false;
  const std::vector<std::string> command = command_of(request);
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int failed = ::posix_spawnp(&process, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  std::string answer;
  bool killed = false;
  while (failed == 0) {
    if (stop && !killed) {
      ::kill(process, SIGTERM);
      killed = true;
    }
    pollfd waits{ends[0], POLLIN, 0};
    if (::poll(&waits, 1, 100) == 0) continue;
    char text[4096];
    const ssize_t got = ::read(ends[0], text, sizeof text);
    if (got <= 0) break;
    answer.append(text, static_cast<std::size_t>(got));
  }
  ::close(ends[0]);
  if (failed != 0) return false;
  int status = 0;
  ::waitpid(process, &status, 0);
  if (killed) return true;
  if (!WIFEXITED(status) || WEXITSTATUS(status) > 1) return false;  // 1: closed without a choice
  while (!answer.empty() && answer.back() == '\n') answer.pop_back();
  if (WEXITSTATUS(status) == 0) chosen = answer;
  return true;
}

}  // namespace pliant
