// How far a long piece of work has come, on stderr: nothing in the first second; then a line that is redrawn on a
// terminal, or a line every few seconds elsewhere.
#pragma once

#include <cstdint>
#include <string>

namespace pliant {

// What the library says beside its results (pliant/process.h) goes to stderr; that work goes on, only while no Progress
// says how far.
void log_to_stderr();

// A line stands on the terminal that the next output has to clear. From any thread.
bool progress_line_stands();

class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void update(double share);  // [1] of the whole, done

 private:
  std::string what_;
  bool terminal_;
  bool shown_ = false;
  std::uint64_t begin_, last_;  // [ns]
};

}  // namespace pliant
