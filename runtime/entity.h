// An entity identifies a row across component pools: a slot and the version of its occupant. The version detects stale
// identifiers.
#pragma once

#include <cstdint>

namespace pliant {

struct Entity {
  std::uint32_t index = 0xffffffffu;
  std::uint32_t version = 0;
  friend bool operator==(Entity, Entity) = default;
};

inline constexpr Entity kNoEntity{};

}  // namespace pliant
