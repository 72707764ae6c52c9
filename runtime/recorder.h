// Rows written by one clock and kept by another. The writer pushes into a ring and never waits. The owner of the file
// drains the ring between ticks (lockstep) or from another thread (real time). Rows that find the ring full are counted
// as lost.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/exchange.h"

namespace pliant {

template <class Row>
class Recorder {
 public:
  explicit Recorder(std::size_t capacity) : ring_(capacity) {}

  // Writing clock. Does not allocate or wait.
  void record(const Row& row) {
    if (!ring_.push(row)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
  // The same: rows that the writer could not even make.
  void lose(std::uint64_t rows) { lost_.fetch_add(rows, std::memory_order_relaxed); }
  // Owner: moves the rows recorded since the last call into `rows`.
  void drain(std::vector<Row>& rows) {
    Row row;
    while (ring_.pop(row)) rows.push_back(row);
  }
  std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  Ring<Row> ring_;
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace pliant
