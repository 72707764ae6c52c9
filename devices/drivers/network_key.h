// The shared key of the network device: HMAC-SHA256 of each frame (RFC 2104, FIPS 180-4). Whoever has the key may move
// the device and be its hand; it says nothing of who reads along. SHA-256 is libcrypto's. Nothing here allocates after
// it was made.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "runtime/result.h"

namespace pliant {

class FrameKey {
 public:
  static constexpr std::size_t kTag = 32;                        // bytes behind each frame
  static constexpr std::size_t kShortest = 16, kLongest = 4096;  // bytes of a key

  explicit FrameKey(std::span<const std::uint8_t> secret);
  // From a file that not everyone may read; an end of line behind the key is not part of it.
  static Result<FrameKey> from_file(const std::string& path);
  static Result<FrameKey> from_environment(const std::string& name);

  void tag(std::span<const std::uint8_t> bytes, std::span<std::uint8_t, kTag> out) const;
  bool fits(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t, kTag> tag) const;

 private:
  // SHA-256 after the key's inner and outer block, which are the same for every frame.
  alignas(8) std::array<std::uint8_t, 112> inner_{}, outer_{};
};

// "127.0.0.1:17716,key=FILE", ",key-env=NAME": the address, and the key where one is named.
struct KeyedAddress {
  std::string address;
  std::optional<FrameKey> key;
};
Result<KeyedAddress> parse_keyed_address(const std::string& id);

}  // namespace pliant
