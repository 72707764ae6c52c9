// The only way to end a run early: by a signal such as Ctrl-C, or by an error of the run such as a full disk. The loop
// polls requested(), stops, releases the devices, and the report is still written.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "runtime/result.h"

namespace pliant {

// Messages printed at the second and at the third Ctrl-C.
struct InterruptWords {
  const char* second = "ending, results are being written; press Ctrl-C again to quit at once without them";
  const char* third = "quit at once; results of this run were not written";
};

// For verbs that write either all of their files or none.
inline constexpr InterruptWords kAllOrNothing{"ending; press Ctrl-C again to quit at once",
                                              "quit at once; nothing was written"};

// While an Interrupt exists, SIGINT, SIGTERM and SIGHUP only request the end of the run. The second Ctrl-C prints a
// warning; the third ends the process at once, without a report. Signals that arrive together (from the terminal and
// from a program that forwards them) count as one Ctrl-C. SIGHUP and SIGINT remain ignored if they were ignored before
// (nohup; background jobs of a script). Only one Interrupt may exist at a time.
class Interrupt {
 public:
  explicit Interrupt(InterruptWords words = {});
  ~Interrupt();  // restores the previous handlers, unless a signal arrived: later signals then do not change the exit
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool requested() const;
  // Thread-safe. Requests the end of the run because of an error; the first error is kept.
  void end(Error why) const;
  // The error that ended the run. Empty if a signal ended it, or if nothing did.
  std::optional<Error> reason() const;

  // A staged file or folder that the third Ctrl-C removes.
  void remove_if_forced(std::filesystem::path staged) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pliant
