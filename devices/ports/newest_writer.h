// A thread that writes the newest of what it was given: what is replaced before its turn is never written. For devices
// whose output is a state (a rumble, a trigger) and may take longer to write than the touch clock can wait.
#pragma once

#include <atomic>
#include <thread>
#include <utility>

#include "runtime/exchange.h"

namespace pliant {

// Write: bool(const Output&), called on the thread; false: it failed, and nothing more is written. give() is called by
// one thread and neither waits nor allocates. The destructor waits until the last output is written.
template <class Output, class Write>
class NewestWriter {
 public:
  explicit NewestWriter(Write write) : write_(std::move(write)), thread_([this] { run(); }) {}
  ~NewestWriter() {
    ended_.store(true, std::memory_order_release);
    wake();
    thread_.join();
  }

  // Fills the next output.
  template <class Fill>
  void give(Fill&& fill) {
    fill(newest_.write());
    newest_.publish();
    wake();
  }
  bool failed() const { return failed_.load(std::memory_order_acquire); }

 private:
  void wake() {
    given_.fetch_add(1, std::memory_order_release);
    given_.notify_one();
  }
  void run() {
    for (std::uint32_t seen = 0;;) {
      given_.wait(seen, std::memory_order_acquire);
      seen = given_.load(std::memory_order_acquire);
      const bool last = ended_.load(std::memory_order_acquire);
      if (newest_.acquire() && !failed() && !write_(newest_.read())) failed_.store(true, std::memory_order_release);
      if (last) return;
    }
  }

  Write write_;
  TripleBuffer<Output> newest_;
  std::atomic<std::uint32_t> given_{0};
  std::atomic<bool> ended_{false}, failed_{false};
  std::thread thread_;  // last: it uses all members above
};

}  // namespace pliant
