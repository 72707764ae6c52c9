// The one way to end a run early: Ctrl-C and other signals, or a reason of the run's own, such as a full disk. The loop
// sees requested(), ends, lets the devices go, and the report of what ran is written.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "runtime/result.h"

namespace pliant {

// What is said at the second Ctrl-C, and at the third.
struct InterruptWords {
  const char* second = "ending, results are being written; press Ctrl-C again to quit at once without them";
  const char* third = "quit at once; results of this run were not written";
};

// Of verbs that write all of their files or none.
inline constexpr InterruptWords kAllOrNothing{"ending; press Ctrl-C again to quit at once",
                                              "quit at once; nothing was written"};

// From its beginning to its end SIGINT, SIGTERM and SIGHUP only request the end of the run, however often they come.
// Only the third Ctrl-C ends the process at once, without a report; the second one says so. Signals that arrive
// together (from the terminal and from a program that forwards it) count as one Ctrl-C. SIGHUP and SIGINT stay ignored
// where they were (nohup; what a script runs in the background). One at a time.
class Interrupt {
 public:
  explicit Interrupt(InterruptWords words = {});
  // Signals do what they did before. After one of them has ended the run they do nothing any more: the process is about
  // to end, with the status of that run; a third Ctrl-C still ends it at once.
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool requested() const;
  // From any thread: requests the end of the run because of an error. The first error stays.
  void end(Error why) const;
  // The error that ended the run; nothing where only a signal did, or nothing has.
  std::optional<Error> reason() const;

  // A staged file or folder, which the third Ctrl-C removes.
  void remove_if_forced(std::filesystem::path staged) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pliant
