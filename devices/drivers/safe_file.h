// A second name of a driver's line, for Driver::safe_line(): it keeps its number while the driver's thread opens the
// line anew, and a guard process gets it from another thread.
#pragma once

#include <fcntl.h>
#include <unistd.h>

namespace pliant {

class SafeFile {
 public:
  SafeFile() = default;
  ~SafeFile() { close(); }
  SafeFile(const SafeFile&) = delete;
  SafeFile& operator=(const SafeFile&) = delete;

  int number() const { return file_; }  // -1: there is no line
  void keep(int line) {
    if (line < 0) return;
    if (file_ < 0)
      file_ = ::fcntl(line, F_DUPFD_CLOEXEC, 3);
    else
      (void)::dup3(line, file_, O_CLOEXEC);
  }
  // A line that is lost is not kept open: a device that is plugged in again would get another name.
  void lose() {
    if (const int none = file_ >= 0 ? ::open("/dev/null", O_WRONLY | O_CLOEXEC) : -1; none >= 0) {
      (void)::dup3(none, file_, O_CLOEXEC);
      ::close(none);
    }
  }
  void close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }

 private:
  int file_ = -1;
};

}  // namespace pliant
