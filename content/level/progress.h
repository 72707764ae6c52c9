// Says on stderr that work goes on, once it has taken over a second; then at most once a second.
#pragma once

#include <iostream>
#include <string>

#include "runtime/clock.h"
#include "runtime/printable.h"

namespace pliant {

class LongWork {
 public:
  // `doing`: "preparing meshes, now `heart`".
  void say(const std::string& doing) {
    if (now_ns() - last_ < 1'000'000'000) return;
    last_ = now_ns();
    std::cerr << "pliant: still " << printable(doing) << '\n';
  }

 private:
  std::uint64_t last_ = now_ns();
};

}  // namespace pliant
