#include "content/mesh/hilbert.h"

#include <algorithm>
#include <array>
#include <utility>

#include "runtime/parallel.h"

namespace pliant {
namespace {

// Spreads 16 bits to every third position.
std::uint64_t spread(std::uint64_t x) {
  x = (x | (x << 16)) & 0x0000ff0000ffull;
  x = (x | (x << 8)) & 0x00f00f00f00full;
  x = (x | (x << 4)) & 0x0c30c30c30c3ull;
  x = (x | (x << 2)) & 0x249249249249ull;
  return x;
}

// Least significant digit first. Stable: equal keys keep their index order. Skips digits that all keys share.
void radix_sort(std::vector<HilbertItem>& items) {
  constexpr unsigned kDigit = 12, kPasses = 3 * kHilbertBits / kDigit;
  constexpr std::size_t kBuckets = std::size_t{1} << kDigit;
  std::vector<std::array<std::uint32_t, kBuckets>> counts(kPasses);
  for (const HilbertItem& item : items)
    for (unsigned pass = 0; pass < kPasses; ++pass) ++counts[pass][(item.key >> (pass * kDigit)) & (kBuckets - 1)];

  std::vector<HilbertItem> sorted(items.size());
  for (unsigned pass = 0; pass < kPasses; ++pass) {
    auto& first = counts[pass];
    if (std::find(first.begin(), first.end(), items.size()) != first.end()) continue;
    std::uint32_t sum = 0;
    for (std::uint32_t& place : first) sum += std::exchange(place, sum);
    for (const HilbertItem& item : items) sorted[first[(item.key >> (pass * kDigit)) & (kBuckets - 1)]++] = item;
    items.swap(sorted);
  }
}

}  // namespace

std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t axis[3] = {x, y, z};
  // Undo the excess work of rotating and reflecting, from the coarsest bit down.
  for (std::uint32_t q = 1u << (kHilbertBits - 1); q > 1; q >>= 1) {
    const std::uint32_t lower = q - 1;
    for (std::uint32_t& a : axis) {
      const std::uint32_t set = (a & q) ? ~0u : 0u;
      const std::uint32_t swap = (axis[0] ^ a) & lower & ~set;
      axis[0] ^= swap | (lower & set);
      a ^= swap;
    }
  }
  // Gray encode.
  axis[1] ^= axis[0];
  axis[2] ^= axis[1];
  std::uint32_t flip = 0;
  for (std::uint32_t q = 1u << (kHilbertBits - 1); q > 1; q >>= 1) flip ^= (axis[2] & q) ? q - 1 : 0u;
  return (spread(axis[0] ^ flip) << 2) | (spread(axis[1] ^ flip) << 1) | spread(axis[2] ^ flip);
}

std::vector<HilbertItem> hilbert_sort(std::span<const vec3> points) {
  Box box;
  for (const vec3& p : points) box.add(p);
  const dvec3 origin(box.min);
  const dvec3 size = points.empty() ? dvec3(0) : dvec3(box.max) - origin;
  const double longest = std::max({size.x, size.y, size.z});
  constexpr double kCells = double(1u << kHilbertBits);
  const double to_cell = longest > 0.0 ? kCells / longest : 0.0;

  std::vector<HilbertItem> items(points.size());
  parallel_for(points.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const dvec3 cell = glm::min((dvec3(points[i]) - origin) * to_cell, dvec3(kCells - 1.0));
      items[i] = {hilbert_key(static_cast<std::uint32_t>(cell.x), static_cast<std::uint32_t>(cell.y),
                              static_cast<std::uint32_t>(cell.z)),
                  static_cast<std::uint32_t>(i)};
    }
  });
  radix_sort(items);
  return items;
}

std::vector<std::uint32_t> hilbert_order(std::span<const vec3> points) {
  std::vector<std::uint32_t> order;
  order.reserve(points.size());
  for (const HilbertItem& item : hilbert_sort(points)) order.push_back(item.index);
  return order;
}

}  // namespace pliant
