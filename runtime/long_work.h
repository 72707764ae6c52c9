// Progress of long work. It is reported to the watch of this thread, which may stop the work, or else to the log.
#pragma once

#include <cstdint>
#include <string>

#include "pliant/progress.h"

namespace pliant {

// Thrown where a watch stops the work; caught where the watch began.
struct WorkStopped {};

// During its lifetime, long work on this thread reports to `progress`; an empty function watches nothing. Not across
// threads: parallel work reports between its parts, on the thread that distributes it.
class WatchedWork {
 public:
  explicit WatchedWork(const OpenProgress& progress);
  ~WatchedWork();
  WatchedWork(const WatchedWork&) = delete;
  WatchedWork& operator=(const WatchedWork&) = delete;

 private:
  friend class LongWork;
  friend void begin_part(double from, double to);
  friend void check_in();
  const OpenProgress& progress_;
  WatchedWork* before_;
  double from_ = 0.0, to_ = 1.0;  // [1] of the whole: the current part
  double share_ = 0.0;            // [1] as last reported
  std::string doing_;             // as last reported
  std::uint64_t reported_ = 0;    // [ns] time of the last report
};

// The work that follows on this thread covers `from` to `to` [1] of the watched whole.
void begin_part(double from, double to);

class LongWork {
 public:
  LongWork();
  // `doing`: "preparing meshes, now `heart`". `done` [1]: share of the current part; below 0: unknown. A watch is
  // called at most fifty times a second; WorkStopped is thrown where it stops the work. The log (LogLevel::kInfo) gets
  // a line once the work has taken over a second, then at most one a second.
  void say(const std::string& doing, double done = -1.0);

 private:
  std::uint64_t last_;  // [ns]
};

// Reports from work without a LongWork object.
inline void check_in(const std::string& doing, double done = -1.0) {
  LongWork().say(doing, done);
}

// Repeats the last report.
void check_in();

}  // namespace pliant
