#include "content/files/growing_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "content/files/file_io.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {
constexpr std::size_t kFlushAt = 32768;  // [byte]

// Writes as much as possible; `error` is the errno if not everything was written.
std::size_t write_all(int file, std::string_view bytes, int& error) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count = ::write(file, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      error = count < 0 ? errno : ENOSPC;
      break;
    }
    written += static_cast<std::size_t>(count);
  }
  return written;
}

}  // namespace

Result<GrowingFile> GrowingFile::create(const fs::path& path) {
  GrowingFile file;
  file.path_ = path;
  file.file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);  // always a new file
  if (file.file_ < 0) return not_written(path.string(), "cannot be written", errno);
  ::flock(file.file_, LOCK_EX | LOCK_NB);  // without lock support, files of killed processes are never removed
  return file;
}

GrowingFile::GrowingFile(GrowingFile&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      buffer_(std::move(other.buffer_)),
      ends_(std::move(other.ends_)),
      flushed_(other.flushed_),
      kept_(other.kept_),
      failure_(std::move(other.failure_)) {}

GrowingFile::~GrowingFile() {
  if (file_ >= 0) ::close(file_);
}

void GrowingFile::add(std::string_view record) {
  if (failure_) return;
  buffer_ += record;
  ends_.push_back(buffer_.size());
  if (buffer_.size() >= kFlushAt) flush();
}

void GrowingFile::flush() {
  if (failure_ || file_ < 0) return;
  int error = 0;
  const std::size_t written = write_all(file_, buffer_, error);
  if (error != 0) return fail(error, written);
  flushed_ += written;
  buffer_.clear();
  ends_.clear();
}

void GrowingFile::fail(int error, std::size_t written) {
  kept_ = static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), written) - ends_.begin());
  failure_ = not_written(path_.string(), "could not be written to its end", error);
  const std::size_t whole = flushed_ + (kept_ > 0 ? ends_[kept_ - 1] : 0);
  if (::ftruncate(file_, static_cast<off_t>(whole)) != 0) failure_->what += " (its last row is not whole)";
}

bool GrowingFile::end_instead(std::size_t records, std::string_view bytes) {
  const std::size_t left = kept_ - std::min(records, kept_);
  const auto whole = static_cast<off_t>(flushed_ + (left > 0 ? ends_[left - 1] : 0));
  int error = 0;
  return ::ftruncate(file_, whole) == 0 && ::lseek(file_, whole, SEEK_SET) == whole &&
         write_all(file_, bytes, error) == bytes.size();
}

Status GrowingFile::close() {
  flush();
  if (file_ >= 0 && ::close(std::exchange(file_, -1)) != 0 && !failure_)
    failure_ = not_written(path_.string(), "could not be written to its end", errno);
  if (failure_) return *failure_;
  return Done{};
}

bool remove_abandoned(const fs::path& file, std::string_view magic) {
  bool alive = false;
  const std::string begin = file.filename().string() + ".partial-";
  std::vector<fs::path> found;
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > begin.size() && name.starts_with(begin) &&
        name.find_first_not_of("0123456789-", begin.size()) == std::string::npos)
      found.push_back(entry.path());
  }
  for (const fs::path& each : found) {
    const int opened = ::open(each.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (opened < 0) continue;
    std::string bytes(magic.size(), '\0');
    if (::read(opened, bytes.data(), bytes.size()) == static_cast<ssize_t>(magic.size()) && bytes == magic) {
      if (::flock(opened, LOCK_EX | LOCK_NB) == 0)
        fs::remove(each, error);
      else
        alive = alive || errno == EWOULDBLOCK;
    }
    ::close(opened);
  }
  return alive;
}

FolderLock::FolderLock(const fs::path& folder)
    : folder_(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  while (folder_ >= 0 && ::flock(folder_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) ::close(folder_);
}

}  // namespace pliant
