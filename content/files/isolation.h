// Runs libraries that were not written for hostile input (Assimp, Draco) in a child process with limited time and
// memory. If a damaged file crashes them, the level is rejected with one sentence and this process continues.
#pragma once

#include <cstdint>
#include <functional>

#include "content/files/file_io.h"
#include "runtime/result.h"

namespace pliant {

// Runs `work` in a child process and returns its result. `work` must not use threads or devices. CPU time limit:
// `seconds` plus one second for every 4 MB of `input_bytes`, times the limit factor if that is above 1. Memory limit:
// kReaderMemory plus 64 bytes for every input byte. CPU load from other processes does not count. A child that waits
// instead of working is killed after `wall` seconds (0: thirty times its CPU time limit, at least a minute). `used`:
// the child's CPU time is added here.
Result<Bytes> in_isolation(std::size_t input_bytes, const std::function<Result<Bytes>()>& work,
                           double seconds = limits::kReaderTime.most, double wall = 0.0, double* used = nullptr);

// [s] CPU time allowed for reading so many bytes, in addition to the fixed seconds per child.
double reading_time(std::size_t input_bytes);

// Serialisation of arrays: read back in the order of appending. take() fails at the end of the bytes.
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
