// CRC-32 of IEEE 802.3 (zlib, PNG): polynomial 0xEDB88320 reflected, initial value and final XOR all ones. The check
// value of "123456789" is 0xCBF43926.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace pliant {

namespace crc32_detail {
constexpr std::array<std::uint32_t, 256> make_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) ? 0xEDB88320u : 0u);
    table[i] = value;
  }
  return table;
}
inline constexpr std::array<std::uint32_t, 256> kTable = make_table();
}  // namespace crc32_detail

// `before`: the checksum of the preceding bytes, if they come in pieces.
constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t before = 0) {
  std::uint32_t value = ~before;
  for (const std::uint8_t byte : bytes) value = (value >> 8) ^ crc32_detail::kTable[(value ^ byte) & 0xFF];
  return ~value;
}

}  // namespace pliant
