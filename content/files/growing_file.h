// A file that grows by whole records while something runs: rows, or ticks of a recording. A write that fails is noticed
// then and not at the end; the file is cut behind its last whole record, and nothing more is written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/result.h"

namespace pliant {

class GrowingFile {
 public:
  // A new, empty file: one that is there is refused. It is locked (flock) while it is open, so that others can tell it
  // from one that a killed process left.
  static Result<GrowingFile> create(const std::filesystem::path& path);
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&&) = delete;
  ~GrowingFile();

  void add(std::string_view record);
  void flush();
  // What kept a record from being written; nothing so far, else no more is written.
  const std::optional<Error>& failure() const { return failure_; }
  // Of the records since the last flush that came through, those that are whole in the file when one failed.
  std::size_t kept_since_flush() const { return kept_; }
  std::size_t waiting() const { return ends_.size(); }  // records for the next flush

  // After a failure, with the room that records give back: cuts the last `records` of those kept and ends with `bytes`.
  bool end_instead(std::size_t records, std::string_view bytes);
  bool is_open() const { return file_ >= 0; }
  Status close();

 private:
  GrowingFile() = default;
  void fail(int error, std::size_t written);
  std::filesystem::path path_;
  int file_ = -1;
  std::string buffer_;
  std::vector<std::size_t> ends_;  // of the records in the buffer
  std::size_t flushed_ = 0;        // [byte] of whole records in the file
  std::size_t kept_ = 0;
  std::optional<Error> failure_;
};

// Removes what a killed process left aside of `file`: `file`.partial-PID and `file`.partial-PID-N, if it begins with
// `magic` and nobody has it open. True: somebody has one open, and writes into `file` now.
bool remove_abandoned(const std::filesystem::path& file, std::string_view magic);

// Locks a folder while it lives, as far as its file system can: between a look and the file that is made after it,
// nobody else looks.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int folder_;
};

}  // namespace pliant
