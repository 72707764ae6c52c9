// Says on stderr that work goes on, once it has taken over a second; then at most once a second.
#pragma once

#include <atomic>
#include <iostream>
#include <string>

#include "runtime/clock.h"
#include "runtime/printable.h"

namespace pliant {

class LongWork {
 public:
  // `doing`: "preparing meshes, now `heart`".
  void say(const std::string& doing) {
    if (silent || now_ns() - last_ < 1'000'000'000) return;
    last_ = now_ns();
    std::cerr << "pliant: still " << printable(doing) << '\n';
  }
  inline static std::atomic<int> silent{0};  // how many others tell how far the whole is

 private:
  std::uint64_t last_ = now_ns();
};

}  // namespace pliant
