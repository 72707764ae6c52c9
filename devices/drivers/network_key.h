// The shared key of the network device: HMAC-SHA256 of each frame (RFC 2104, FIPS 180-4). It authenticates the engine
// and the device to each other; it does not encrypt. SHA-256 is libcrypto's. No allocation after construction.
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
  static constexpr std::size_t kTag = 32;                        // bytes appended to each frame
  static constexpr std::size_t kShortest = 16, kLongest = 4096;  // bytes of a key

  explicit FrameKey(std::span<const std::uint8_t> secret);
  // From a file that not everyone may read; a final end of line is not part of the key.
  static Result<FrameKey> from_file(const std::string& path);
  static Result<FrameKey> from_environment(const std::string& name);

  void tag(std::span<const std::uint8_t> bytes, std::span<std::uint8_t, kTag> out) const;
  bool fits(std::span<const std::uint8_t> bytes, std::span<const std::uint8_t, kTag> tag) const;

 private:
  // SHA-256 states after the key's inner and outer block, which are the same for every frame.
  alignas(8) std::array<std::uint8_t, 112> inner_{}, outer_{};
};

// "127.0.0.1:17716,key=FILE", ",key-env=NAME": the address, and the key if one is given.
struct KeyedAddress {
  std::string address;
  std::optional<FrameKey> key;
};
Result<KeyedAddress> parse_keyed_address(const std::string& id);

}  // namespace pliant
