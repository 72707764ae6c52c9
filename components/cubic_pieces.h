// Cubics over consecutive intervals, kept by value: no allocation where a law is copied in a tick, and only the pieces
// in use are copied.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pliant {

// From x = at on, with t = x - at: value + t (slope + t (second + t third)).
struct CubicPiece {
  double at, value, slope, second, third;
  double integral;  // up to `at`; of what, its owner says
};

template <std::size_t most>
struct CubicPieces {
  std::uint32_t count = 0;
  std::array<CubicPiece, most> piece;

  CubicPieces() {}  // the pieces are not initialised
  CubicPieces(const CubicPieces& other) noexcept { *this = other; }
  CubicPieces& operator=(const CubicPieces& other) noexcept {
    count = other.count;
    for (std::uint32_t i = 0; i < count; ++i) piece[i] = other.piece[i];
    return *this;
  }
  void add(const CubicPiece& more) { piece[count++] = more; }
  // The number of pieces that begin at x or before.
  std::uint32_t begun(double x) const {
    std::uint32_t found = 0;
    for (std::uint32_t i = 0; i < count; ++i) found += x >= piece[i].at;
    return found;
  }
};

}  // namespace pliant
