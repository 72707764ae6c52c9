// Exchange between clocks: TripleBuffer (newest state wins) and Ring (every item, in order). Both are wait-free for one
// writer and one reader; neither allocates after construction.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pliant {

// Newest state wins. The writer fills `write()` and calls publish(); the reader calls acquire() and uses `read()`.
// Three slots: one being written, one being read, and one between, which either side swaps for its slot.
template <class T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  // Every slot starts as a copy of `initial`: a reader that is first sees a complete state.
  explicit TripleBuffer(const T& initial) : slots_{initial, initial, initial} {}

  // Writer. The slot may hold any older state; overwrite all of it.
  T& write() { return slots_[writing_]; }

  // Writer. Returns true if the state published before this one was seen by the reader (false: it was replaced unseen).
  bool publish() {
    const std::uint8_t previous = between_.exchange(writing_ | kFresh, std::memory_order_acq_rel);
    writing_ = previous & kSlot;
    return (previous & kFresh) == 0;
  }

  // Writer. True while the reader has not taken the last published state.
  bool unseen() const { return (between_.load(std::memory_order_relaxed) & kFresh) != 0; }

  // Reader. Takes the newest state if there is one; returns whether it did.
  bool acquire() {
    if ((between_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
    return true;
  }
  const T& read() const { return slots_[reading_]; }

  // For set-up before either side starts (sizing the slots).
  std::array<T, 3>& slots() { return slots_; }

 private:
  static constexpr std::uint8_t kSlot = 3, kFresh = 4;
  std::array<T, 3> slots_{};
  alignas(64) std::uint8_t writing_ = 0;
  alignas(64) std::uint8_t reading_ = 1;
  alignas(64) std::atomic<std::uint8_t> between_{2};
};

// Every item, in order, up to a fixed capacity (rounded up to a power of two). A push into a full ring is refused.
template <class T>
class Ring {
 public:
  explicit Ring(std::size_t capacity) {
    std::size_t size = 1;
    while (size < capacity) size *= 2;
    items_.resize(size);
  }

  // Writer. False when the ring is full: the item was not taken, and the writer must count it as lost.
  bool push(const T& item) {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_.load(std::memory_order_acquire) == items_.size()) return false;
    items_[tail & (items_.size() - 1)] = item;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

  // Writer. True: the next push succeeds; the reader can only make more room.
  bool has_room() const {
    return tail_.load(std::memory_order_relaxed) - head_.load(std::memory_order_acquire) < items_.size();
  }

  // Reader. False when the ring is empty.
  bool pop(T& item) {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return false;
    item = items_[head & (items_.size() - 1)];
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  std::size_t capacity() const { return items_.size(); }

 private:
  std::vector<T> items_;
  alignas(64) std::atomic<std::uint64_t> head_{0};  // next to pop
  alignas(64) std::atomic<std::uint64_t> tail_{0};  // next to push
};

}  // namespace pliant
