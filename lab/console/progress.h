// Progress of a long computation on stderr. Nothing is printed in the first second; then one line is redrawn on a
// terminal, or a line is printed every few seconds elsewhere.
#pragma once

#include <cstdint>
#include <string>

namespace pliant {

// Sends the library's log (pliant/process.h) to stderr. Messages that work goes on are dropped while a Progress is
// shown.
void log_to_stderr();

// True while the terminal shows a progress line that the next output must clear. Thread-safe.
bool progress_line_stands();

class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void update(double share);  // [1] completed share of the whole

 private:
  std::string what_;
  bool terminal_;
  bool shown_ = false;
  std::uint64_t begin_, last_;  // [ns]
};

}  // namespace pliant
