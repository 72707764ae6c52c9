#include "lab/files/output_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

#include "content/files/file_io.h"
#include "lab/files/run_files.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr const char* kReserve = ".reserve";
constexpr const char* kListCopy = ".list";
constexpr off_t kReserved = 256 << 10, kLeastReserved = 32 << 10;  // [byte] for report.json and forces.png
constexpr int kMostFolders = 100000;
constexpr int kFolderAttempts = 8;  // attempts, while other runs create and remove the same folders

bool is_there(const fs::path& file) {
  std::error_code error;
  return fs::symlink_status(file, error).type() != fs::file_type::not_found;
}

bool is_folder(const fs::path& file) {
  std::error_code error;
  return fs::symlink_status(file, error).type() == fs::file_type::directory;
}

// Name of an entry in `folder` that has the name of a result but that no run wrote; empty if there is none.
std::string foreign_result(const fs::path& folder) {
  const std::set<std::string> listed = listed_files(folder);
  if (listed.empty() && is_there(folder / kRunList)) return kRunList;
  for (const std::string& name : result_files(folder))
    if (!listed.count(name) || is_folder(folder / name)) return name;
  return {};
}

bool is_taken(const fs::path& folder) {
  return clear_abandoned(folder) || is_there(folder / kRunList) || !result_files(folder).empty();
}

// The folder with its symbolic links resolved before `..` is applied. Its own last component is kept, so that FOLDER-2
// is created beside it.
fs::path resolved(const fs::path& folder) {
  std::error_code error;
  fs::path whole = fs::absolute(folder, error);
  if (!whole.has_filename()) whole = whole.parent_path();  // "out/" is "out"
  const bool named = whole.filename() != "." && whole.filename() != "..";
  fs::path at = fs::weakly_canonical(named ? whole.parent_path() : whole, error);
  if (error) return whole.lexically_normal();
  return named ? at / whole.filename() : at;
}

}  // namespace

Result<OutputFolder> OutputFolder::create(const fs::path& folder, bool replace) {
  OutputFolder out;
  std::error_code error;
  out.given_ = folder;
  out.replace_ = replace;
  out.asked_ = resolved(folder);
  out.folder_ = out.asked_;
  const bool there = fs::is_directory(out.asked_, error);
  if (there && replace) {
    if (clear_abandoned(out.asked_))
      return Error{folder.string(), "is in use by another run", "wait for it, or choose another with --out"};
    if (const std::string name = foreign_result(out.asked_); !name.empty())
      return Error{(folder / name).string(), "was not written by a run, so --force does not replace it",
                   "move it away, or use another --out"};
  }
  const Status opened = there && !replace && is_taken(out.asked_) ? out.choose_next() : out.open(out.asked_);
  if (!opened) return opened.error().at(folder.string());
  return out;
}

// Creates the folder if it is missing, and the hidden staging folder in it.
Status OutputFolder::open(const fs::path& folder) {
  std::error_code error;
  const fs::path staging = folder / (".partial-" + std::to_string(::getpid()));
  bool staged = false;
  for (int attempt = 0; !staged && attempt < kFolderAttempts; ++attempt) {
    std::vector<fs::path> missing;
    for (fs::path at = folder; !fs::exists(at, error) && at.has_relative_path(); at = at.parent_path())
      missing.push_back(at);
    std::reverse(missing.begin(), missing.end());
    error.clear();
    for (const fs::path& at : missing) {
      if (fs::create_directory(at, error)) made_.push_back(at);
      if (error) break;  // no error and not created: another run was faster
    }
    if (!error) staged = fs::create_directory(staging, error);
    if (!error && !staged)
      return Error{folder.string(), "contains `" + staging.filename().string() + "` of another process", "remove it"};
    // A run that ended early may remove the folder between the check and the creation.
    if (error && error != std::errc::no_such_file_or_directory) break;
  }
  if (!staged) return Error{folder.string(), "cannot be created: " + error.message(), "choose another with --out"};
  folder_ = folder;
  staging_ = staging;
  marker_ = begin_list(staging_);
  if (marker_ < 0) return not_written(folder.string(), "cannot be written to", errno);
  const int reserve = ::open((staging_ / kReserve).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (reserve >= 0) {
    off_t bytes = kReserved;
    while (bytes >= kLeastReserved && ::posix_fallocate(reserve, 0, bytes) != 0) bytes /= 2;
    ::close(reserve);
  }
  return Done{};
}

// The first of FOLDER-2, FOLDER-3, ... that does not exist or is empty.
Status OutputFolder::choose_next() {
  for (int n = 2; n < kMostFolders; ++n) {
    const fs::path next = asked_.string() + "-" + std::to_string(n);
    std::error_code error;
    if (fs::is_directory(next, error) && !clear_abandoned(next) && fs::is_empty(next, error)) return open(next);
    if (is_there(next)) continue;
    if (fs::create_directory(next, error)) {  // false: another run has just created it
      made_.push_back(next);
      return open(next);
    }
    if (error) return Error{asked_.string(), "cannot be created: " + error.message(), "choose another with --out"};
  }
  return Error{asked_.string(), "has results, and so have all that follow", "choose another with --out"};
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : given_(std::move(other.given_)),
      asked_(std::move(other.asked_)),
      folder_(std::move(other.folder_)),
      staging_(std::move(other.staging_)),
      replace_(other.replace_),
      marker_(std::exchange(other.marker_, -1)),
      made_(std::move(other.made_)),
      names_(std::move(other.names_)) {
  other.staging_.clear();
  other.made_.clear();
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  if (marker_ >= 0) ::close(marker_);
  for (auto at = made_.rbegin(); at != made_.rend(); ++at) fs::remove(*at, ignored);  // only if empty
}

fs::path OutputFolder::stage(const std::string& name) {
  if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.push_back(name);
  return staging_ / name;
}

void OutputFolder::free_reserve() {
  std::error_code ignored;
  fs::remove(staging_ / kReserve, ignored);
}

fs::path OutputFolder::shown() const {
  if (moved() && (given_.filename() == "." || given_.filename() == "..")) return folder_;
  const std::string all = folder_.string(), asked = asked_.string();
  fs::path shown = given_.has_filename() ? given_ : given_.parent_path();
  return shown += all.substr(std::min(asked.size(), all.size()));
}

Error OutputFolder::at_place(Error error) const {
  const std::string staged = staging_.string();
  if (error.where.starts_with(staged)) error.where = shown().string() + error.where.substr(staged.size());
  return error;
}

// Moves everything staged into the next free folder.
Status OutputFolder::move_on() {
  const fs::path staged = staging_;
  const int marker = std::exchange(marker_, -1);
  const Status next = choose_next();
  if (marker_ >= 0) ::close(std::exchange(marker_, marker));
  if (!next) return next.error();
  std::error_code error;
  fs::remove_all(staging_, error);
  fs::rename(staged, staging_, error);
  if (error) staging_ = staged;
  if (error)
    return Error{shown().string(), "cannot be moved into place: " + error.message(),
                 "remove what is there, or choose another --out"};
  return Done{};
}

// Places the list as a hard link, so that the staging folder remains identified as this run's until the end. Returns 0
// or errno.
int OutputFolder::place_list() {
  const fs::path copy = staging_ / kListCopy;
  if (::link((staging_ / kRunList).c_str(), copy.c_str()) != 0) return ENOTSUP;
  const int error = move_file(copy, folder_ / kRunList, replaces());
  std::error_code ignored;
  fs::remove(copy, ignored);
  return error;
}

Status OutputFolder::commit() {
  free_reserve();
  std::erase_if(names_,
                [&](const std::string& name) { return !is_there(staging_ / name); });  // the file could not be written
  std::optional<Error> wrong;  // the first error; the other files are still moved into place
  const auto note_first = [&](const std::string& name, const char* what, int error, const char* cure) {
    if (wrong) return;
    wrong = not_written((shown() / name).string(), what, error);
    if (cure && wrong->code != kDiskFull) wrong->cure = cure;
  };
  const std::string list = list_text(names_);
  if (::pwrite(marker_, list.data(), list.size(), 0) != static_cast<ssize_t>(list.size()))
    note_first(kRunList, "cannot be written", errno, nullptr);
  std::set<std::string> old = replace_ ? listed_files(folder_) : std::set<std::string>();
  const auto in_the_way = [&](const std::string& name) {
    return is_there(folder_ / name) && (!old.count(name) || is_folder(folder_ / name));
  };
  // The list is placed first: if the process is killed, it names the files that may follow.
  int placed = EEXIST;
  for (int attempt = 0; placed == EEXIST && attempt < kFolderAttempts; ++attempt) {
    if (std::any_of(names_.begin(), names_.end(), in_the_way) || (!replaces() && is_there(folder_ / kRunList))) {
      if (const Status next = move_on(); !next) return next.error();
      old.clear();
    }
    placed = place_list();
  }
  constexpr const char *kNotMoved = "cannot be moved into place",
                       *kCure = "remove what is there, or choose another --out";
  std::erase_if(names_, [&](const std::string& name) {
    const int error = move_file(staging_ / name, folder_ / name, old.count(name) != 0);
    if (error != 0) note_first(name, kNotMoved, error, kCure);
    return error != 0;
  });
  if (placed != 0)  // a file system without links
    if (const int error = move_file(staging_ / kRunList, folder_ / kRunList, replaces()); error != 0)
      note_first(kRunList, kNotMoved, error, kCure);
  std::error_code error;
  for (const std::string& name : old)
    if (std::find(names_.begin(), names_.end(), name) == names_.end() && !is_folder(folder_ / name))
      fs::remove(folder_ / name, error);
  made_.clear();
  if (wrong) return *wrong;
  return Done{};
}

}  // namespace pliant
