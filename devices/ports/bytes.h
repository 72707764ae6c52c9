// Little-endian numbers in a packet, bounds-checked: beyond the span nothing is written, and reads return zero; see
// ok().
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace pliant {

class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::uint8_t> into) : into_(into) {}

  template <std::integral T>
  void put(T value) {
    auto bits = static_cast<std::make_unsigned_t<T>>(value);
    if (into_.size() - at_ < sizeof(T)) {
      ok_ = false;
      return;
    }
    for (std::size_t i = 0; i < sizeof(T); ++i) into_[at_++] = static_cast<std::uint8_t>(bits >> (8 * i));
  }
  // Single precision on the wire.
  void put_real(double value) { put(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }

  std::size_t size() const { return at_; }
  bool ok() const { return ok_; }

 private:
  std::span<std::uint8_t> into_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> from) : from_(from) {}

  template <std::integral T>
  T get() {
    if (from_.size() - at_ < sizeof(T)) {
      ok_ = false;
      return 0;
    }
    std::make_unsigned_t<T> bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bits = static_cast<std::make_unsigned_t<T>>(bits | static_cast<std::make_unsigned_t<T>>(from_[at_++]) << (8 * i));
    return static_cast<T>(bits);
  }
  double get_real() { return std::bit_cast<float>(get<std::uint32_t>()); }

  std::size_t left() const { return from_.size() - at_; }
  bool ok() const { return ok_; }

 private:
  std::span<const std::uint8_t> from_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace pliant
