// A run of `pliant` as a process of its own: this very program, without a terminal.
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
  // Begins `pliant ARGUMENTS` with the working directory `from`. `folder` is its own. What it says on stderr is kept in
  // memory: a full disk is among what it may say.
  // `timeout` [s]; 0: none.
  static Result<Child> start(const std::vector<std::string>& arguments, const std::filesystem::path& from,
                             const std::filesystem::path& folder, double timeout);
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  ~Child();  // kills it where it still runs

  bool is_over();  // looks; kills it when its time is over
  // Once it is over:
  bool timed_out() const { return timed_out_; }
  bool succeeded() const { return status_ == 0 && !timed_out_ && !lost_; }
  std::optional<int> exit_status() const;  // nothing: a signal ended it, or nobody knows
  std::string complaint() const;           // the sentence that it ended with; made up where it said none
  double seconds() const { return seconds_; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  Child() = default;
  void end();
  pid_t process_ = -1;
  int said_ = -1;  // its stderr
  int status_ = -1;
  bool timed_out_ = false, lost_ = false;  // lost: nobody knows its status
  double timeout_ = 0.0, seconds_ = 0.0;
  Clock::time_point begun_;
  std::filesystem::path folder_;
};

}  // namespace pliant
