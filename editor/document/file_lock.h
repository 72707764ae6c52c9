// Advisory lock of an open file: .NAME.lock beside it contains process and host. A second editor is informed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pliant {

struct LockHolder {
  int process = 0;
  std::uint64_t started = 0;  // of the process, in the kernel's clock ticks: detects reused process ids
  std::string host, user, since;
};

std::filesystem::path lock_of(const std::filesystem::path& file);
// The editor that has the file open: a running process, or one on another host, which cannot be checked.
std::optional<LockHolder> lock_holder(const std::filesystem::path& file);
// "anna on ward3 (process 4711), since 2026-05-04 10:03"
std::string text_of(const LockHolder& holder);

// Locked until destruction.
class FileLock {
 public:
  // Replaces the lock of an editor that no longer runs. Not locked if another editor has it, or the folder is not
  // writable (then no one can save there).
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
