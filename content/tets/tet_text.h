// Reads the bytes of an untrusted file as lines, words, numbers or raw values; tracks the position for errors.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "runtime/result.h"

namespace pliant {

class TetText {
 public:
  TetText(std::span<const std::uint8_t> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  // Binary values are byte-swapped if `swapped`; errors then name a byte instead of a line.
  void set_binary(bool binary, bool swapped) {
    binary_ = binary;
    swapped_ = swapped;
  }
  bool binary() const { return binary_; }

  std::size_t left() const { return bytes_.size() - at_; }
  // The rest of the line, without its end; false at the end of the file.
  bool line(std::string_view& out);
  // The next word, across lines; false at the end. `comments`: '#' begins a comment to the end of its line.
  bool word(std::string_view& out, bool comments = false);
  // The next word as a number; false if there is none, or it is not finite. `comments` as above.
  bool number(double& out, bool comments = false);
  bool integer(std::int64_t& out, bool comments = false);
  // A binary value.
  template <class T>
  bool raw(T& out) {
    if (left() < sizeof(T)) return false;
    std::uint8_t value[sizeof(T)];
    std::memcpy(value, bytes_.data() + at_, sizeof(T));
    if (swapped_) std::reverse(value, value + sizeof(T));
    std::memcpy(&out, value, sizeof(T));
    at_ += sizeof(T);
    return true;
  }
  bool skip(std::uint64_t bytes);
  bool skip_past(std::string_view mark);  // after the next occurrence; false: none

  // At the last word or line, or this byte.
  Error fault(const std::string& what, const std::string& cure = "save the mesh again") const;

 private:
  std::string_view text() const { return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()}; }

  std::span<const std::uint8_t> bytes_;
  std::string name_;
  std::size_t at_ = 0;
  std::size_t taken_ = 0;  // where the last word or line begins
  bool binary_ = false, swapped_ = false;
};

bool to_number(std::string_view word, double& out);  // finite ones only
bool to_integer(std::string_view word, std::int64_t& out);

}  // namespace pliant
