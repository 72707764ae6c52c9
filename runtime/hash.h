// A 64-bit running hash (FNV-1a over 8-byte words with a final mix) for "same input, same bits". Not for security.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace pliant {

class Hash {
 public:
  void add_bytes(const void* data, std::size_t size) {
    const unsigned char* p = static_cast<const unsigned char*>(data);
    for (; size >= 8; p += 8, size -= 8) {
      std::uint64_t word;
      std::memcpy(&word, p, 8);
      add_word(word);
    }
    std::uint64_t word = 0;
    if (size) std::memcpy(&word, p, size);
    add_word(word ^ (static_cast<std::uint64_t>(size) << 56));
  }
  template <class T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    add_bytes(&value, sizeof value);
  }
  template <class T>
  void add(std::span<const T> values) {
    static_assert(std::is_arithmetic_v<T>);
    add_bytes(values.data(), values.size_bytes());
  }
  std::uint64_t value() const {
    std::uint64_t x = state_;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
  }

 private:
  void add_word(std::uint64_t word) { state_ = ((state_ ^ word) * 0x100000001b3ull) ^ (state_ >> 47); }
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

}  // namespace pliant
