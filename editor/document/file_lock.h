// Who edits a file: .NAME.lock beside it, with process and host, for as long as an editor has it open. It binds nobody;
// a second editor is told.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pliant {

struct LockHolder {
  int process = 0;
  std::uint64_t started = 0;  // of the process, in the kernel's clock ticks: a number that is used again is another's
  std::string host, user, since;
};

std::filesystem::path lock_of(const std::filesystem::path& file);
// The editor that has the file open: another process that runs, or one of another host, of which nobody can tell.
std::optional<LockHolder> lock_holder(const std::filesystem::path& file);
// "anna on ward3 (process 4711), since 2026-05-04 10:03"
std::string text_of(const LockHolder& holder);

// Held until it is destroyed.
class FileLock {
 public:
  // Takes over what an editor left that runs no more. Not held where another one has it, or where the folder cannot be
  // written: then nobody there can save either.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  bool held() const { return held_; }
  bool took_over() const { return took_over_; }

 private:
  std::filesystem::path lock_;
  bool held_ = false, took_over_ = false;
};

}  // namespace pliant
