// A child process that runs this program, without a terminal.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

class Child {
 public:
  using Clock = std::chrono::steady_clock;
  // Starts `pliant ARGUMENTS` in the working directory `from`. `folder`: the run's output. Its stderr is kept in
  // memory, because a full disk is a possible error. `timeout` [s]; 0: none.
  static Result<Child> start(const std::vector<std::string>& arguments, const std::filesystem::path& from,
                             const std::filesystem::path& folder, double timeout);
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  ~Child();  // kills it if it still runs

  bool is_over();  // polls; kills it after the time-out
  // Valid once it is over:
  bool timed_out() const { return timed_out_; }
  bool succeeded() const { return status_ == 0 && !timed_out_ && !lost_; }
  std::optional<int> exit_status() const;  // empty: ended by a signal, or unknown
  std::string complaint() const;           // its last sentence on stderr; a generated one if it printed none
  double seconds() const { return seconds_; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  Child() = default;
  void end();
  pid_t process_ = -1;
  int said_ = -1;  // its stderr
  int status_ = -1;
  bool timed_out_ = false, lost_ = false;  // lost: its status is unknown
  double timeout_ = 0.0, seconds_ = 0.0;
  Clock::time_point begun_;
  std::filesystem::path folder_;
};

}  // namespace pliant
