// The memory order of a mesh: along a three-dimensional Hilbert curve. Points near in space are near in memory, and
// every run of vertices is a compact patch.
//
// J. Skilling, "Programming the Hilbert curve", AIP Conf. Proc. 707 (2004): axes to transposed index, here without
// branches. 16 bits per axis: a cell is 1/65536 of the longest side, far below any edge that can be touched.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "components/math.h"

namespace pliant {

inline constexpr unsigned kHilbertBits = 16;  // per axis; a key has three times as many

// The position of an integer cell (each coordinate < 2^kHilbertBits) along the curve. A bijection onto [0, 2^48).
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z);

// A point's index and its position along the curve.
struct HilbertItem {
  std::uint64_t key;
  std::uint32_t index;
};

// All (finite) points, sorted by key, equal keys by index. The cells are cubes over the points' bounding box.
std::vector<HilbertItem> hilbert_sort(std::span<const vec3> points);

// Indices only: the i-th point along the curve is points[result[i]].
std::vector<std::uint32_t> hilbert_order(std::span<const vec3> points);

}  // namespace pliant
