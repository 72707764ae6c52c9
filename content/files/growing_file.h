// A file that grows by whole records during a run: table rows, or ticks of a recording. A failed write is detected at
// once. The file is then truncated after its last whole record, and no more is written.
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
  // Creates a new, empty file; rejects an existing one. The file is locked (flock) while open, which distinguishes it
  // from one left by a killed process.
  static Result<GrowingFile> create(const std::filesystem::path& path);
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&&) = delete;
  ~GrowingFile();

  void add(std::string_view record);
  void flush();
  // The first write error. After it, no more records are written.
  const std::optional<Error>& failure() const { return failure_; }
  // After a failure: how many records since the last successful flush are complete in the file.
  std::size_t kept_since_flush() const { return kept_; }
  std::size_t waiting() const { return ends_.size(); }  // records buffered for the next flush

  // After a failure: removes the last `records` of the kept ones and uses their space to append `bytes`.
  bool end_instead(std::size_t records, std::string_view bytes);
  bool is_open() const { return file_ >= 0; }
  Status close();

 private:
  GrowingFile() = default;
  void fail(int error, std::size_t written);
  std::filesystem::path path_;
  int file_ = -1;
  std::string buffer_;
  std::vector<std::size_t> ends_;  // ends of the records in the buffer
  std::size_t flushed_ = 0;        // [byte] of whole records in the file
  std::size_t kept_ = 0;
  std::optional<Error> failure_;
};

// Removes temporary files of `file` left by killed processes: `file`.partial-PID and `file`.partial-PID-N, if they
// begin with `magic` and are not open. Returns true if a process has one open, that is, writes `file` now.
bool remove_abandoned(const std::filesystem::path& file, std::string_view magic);

// Locks a folder for its lifetime, if the file system supports it. No other process checks the folder between this
// process's check and its creation of a file.
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
