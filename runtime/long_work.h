// Long work that says where it is: to whoever watches this thread, who may end it, or to the log.
#pragma once

#include <cstdint>
#include <string>

#include "pliant/progress.h"

namespace pliant {

// Thrown where a watch ends the work; caught where the watch began.
struct WorkStopped {};

// While it lives, long work on this thread tells `progress`; an empty one watches nothing. Not across threads: work
// that is shared out says where it is between its parts, on the thread that shares it out.
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
  double from_ = 0.0, to_ = 1.0;  // [1] of the whole: the part under way
  double share_ = 0.0;            // [1] as it was told last
  std::string doing_;             // the same
  std::uint64_t told_ = 0;        // [ns] when
};

// What follows on this thread is from `from` to `to` [1] of the whole that is watched.
void begin_part(double from, double to);

class LongWork {
 public:
  LongWork();
  // `doing`: "preparing meshes, now `heart`". `done` [1]: of the part under way; below 0: not known. To a watch fifty
  // times a second at most: it throws WorkStopped where the watch ends the work. To the log (LogLevel::kInfo) once the
  // work has taken over a second, then at most once a second.
  void say(const std::string& doing, double done = -1.0);

 private:
  std::uint64_t last_;  // [ns]
};

// A place in work that has no LongWork of its own.
inline void check_in(const std::string& doing, double done = -1.0) {
  LongWork().say(doing, done);
}

// Within what was said last.
void check_in();

}  // namespace pliant
