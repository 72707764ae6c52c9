#include "lab/files/run_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>

#include "content/files/file_io.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kListTitle = "files that a run of pliant wrote here; --force replaces these and no others\n";

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_result(std::string_view name) {
  for (const std::string_view known : {"report.json", "forces.csv", "forces.png", "bodies.csv"})
    if (name == known) return true;
  constexpr std::string_view kFrame = "frame-", kPng = ".png";
  return name.size() == kFrame.size() + 4 + kPng.size() && name.starts_with(kFrame) && name.ends_with(kPng) &&
         is_number(name.substr(kFrame.size(), 4));
}

enum class Staged : std::uint8_t { kOthers, kAbandoned, kAlive };

// A hidden folder belongs to a run if it has a run's list. The run has ended if the list is unlocked.
Staged state_of(const fs::path& staging) {
  const int list = ::open((staging / kRunList).c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  if (list < 0) return Staged::kOthers;
  std::string begin(kListTitle.size(), '\0');
  const bool ours =
      ::read(list, begin.data(), begin.size()) == static_cast<ssize_t>(kListTitle.size()) && begin == kListTitle;
  const bool free = ours && ::flock(list, LOCK_EX | LOCK_NB) == 0;
  ::close(list);
  return !ours ? Staged::kOthers : free ? Staged::kAbandoned : Staged::kAlive;
}

}  // namespace

std::set<std::string> listed_files(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code error;
  if (!fs::is_regular_file(folder / kRunList, error)) return names;  // for instance a link to an endless device
  std::ifstream in(folder / kRunList);
  std::string line;
  if (!std::getline(in, line) || line + '\n' != kListTitle) return names;
  while (std::getline(in, line))
    if (!line.empty() && line != "." && line != ".." && line.find('/') == std::string::npos) names.insert(line);
  return names;
}

std::string list_text(const std::vector<std::string>& names) {
  std::string text(kListTitle);
  for (const std::string& name : names) text += name + '\n';
  return text;
}

std::vector<std::string> result_files(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (std::string name = entry.path().filename().string(); is_result(name)) names.push_back(std::move(name));
  return names;
}

int begin_list(const fs::path& staging) {
  const int list = ::open((staging / kRunList).c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (list < 0) return -1;
  ::flock(list, LOCK_EX | LOCK_NB);  // locked while empty: no other run takes it for an abandoned one
  if (::write(list, kListTitle.data(), kListTitle.size()) == static_cast<ssize_t>(kListTitle.size())) return list;
  const int error = errno;
  ::close(list);
  errno = error;
  return -1;
}

bool clear_abandoned(const fs::path& folder) {
  constexpr std::string_view kPartial = ".partial-";
  bool alive = false;
  std::vector<fs::path> abandoned;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPartial) || !is_number(std::string_view(name).substr(kPartial.size()))) continue;
    if (!entry.is_directory(error) || entry.is_symlink(error)) continue;
    const Staged state = state_of(entry.path());
    if (state == Staged::kAbandoned) abandoned.push_back(entry.path());
    alive = alive || state == Staged::kAlive;
  }
  for (const fs::path& each : abandoned) fs::remove_all(each, error);
  return alive;
}

}  // namespace pliant
