// Libraries that were not written for hostile input (Assimp, Draco) run in a child process of bounded time and memory:
// whatever a damaged file makes them do, the level is refused in a sentence and this process goes on.
#pragma once

#include <cstdint>
#include <functional>

#include "content/files/file_io.h"
#include "runtime/result.h"

namespace pliant {

// Runs `work` in a child and returns what it returned. `input_bytes`, the size of what it reads, sets the bounds:
// `seconds` of its own processor time and one more for every 4 MB, times the factor of the limits where it is above 1;
// kReaderMemory and 64 bytes for each of them. A busy machine takes nothing of that; a child that waits instead of
// working is ended after `wall` seconds (0: thirty times as many, a minute at least). It must not touch threads or
// devices. `used`: where the seconds of processor time are added that it took.
Result<Bytes> in_isolation(std::size_t input_bytes, const std::function<Result<Bytes>()>& work,
                           double seconds = limits::kReaderTime.most, double wall = 0.0, double* used = nullptr);

// [s] of processor time that reading so many bytes may take, beside the seconds that every child has.
double reading_time(std::size_t input_bytes);

// For handing arrays over: what was appended is taken in the same order. take() fails at the end of the bytes.
void append_bytes(Bytes& out, const void* data, std::size_t size);
class Taker {
 public:
  explicit Taker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool take(void* data, std::size_t size);
  std::span<const std::uint8_t> rest() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace pliant
