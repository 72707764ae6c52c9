#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "content/mesh/hilbert.h"

namespace pliant {
namespace {

TEST(Hilbert, KeysOfASubcubeAreABijectionAndConsecutiveCellsShareAFace) {
  constexpr std::uint32_t n = 16;  // the curve's first n^3 cells fill the cube at the origin
  std::vector<glm::ivec3> cell(n * n * n, glm::ivec3(-1));
  for (std::uint32_t x = 0; x < n; ++x)
    for (std::uint32_t y = 0; y < n; ++y)
      for (std::uint32_t z = 0; z < n; ++z) {
        const std::uint64_t key = hilbert_key(x, y, z);
        ASSERT_LT(key, cell.size());
        ASSERT_EQ(cell[key].x, -1) << "two cells with one key";
        cell[key] = {x, y, z};
      }
  for (std::size_t i = 1; i < cell.size(); ++i) {
    const glm::ivec3 step = glm::abs(cell[i] - cell[i - 1]);
    ASSERT_EQ(step.x + step.y + step.z, 1) << "at " << i;
  }
}

TEST(Hilbert, NeighbouringKeysAreNeighbouringCellsAtFullResolution) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const auto x = static_cast<std::uint32_t>(random() & 0xffff), y = static_cast<std::uint32_t>(random() & 0xffff),
               z = static_cast<std::uint32_t>(random() & 0xffff);
    std::uint64_t lowest = ~0ull;
    std::set<std::uint64_t> block;  // an aligned cube of eight cells is a run of eight keys
    for (std::uint32_t c = 0; c < 8; ++c) {
      const std::uint64_t key = hilbert_key((x & ~1u) | (c & 1), (y & ~1u) | (c >> 1 & 1), (z & ~1u) | (c >> 2));
      lowest = std::min(lowest, key);
      block.insert(key);
    }
    ASSERT_EQ(block.size(), 8u);
    ASSERT_EQ(lowest % 8, 0u);
    ASSERT_EQ(*block.rbegin(), lowest + 7);
    ASSERT_LT(*block.rbegin(), 1ull << 48);
  }
}

TEST(Hilbert, OrderIsAPermutationSortedByKeyWithEqualPointsInIndexOrder) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> coordinate(-3.0f, 5.0f);
  std::vector<vec3> points;
  for (int i = 0; i < 5000; ++i) points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  points.insert(points.end(), points.begin(), points.begin() + 1000);
  const std::vector<HilbertItem> items = hilbert_sort(points);
  std::vector<bool> seen(points.size(), false);
  for (std::size_t i = 0; i < items.size(); ++i) {
    ASSERT_FALSE(seen[items[i].index]);
    seen[items[i].index] = true;
    if (i == 0) continue;
    ASSERT_LE(items[i - 1].key, items[i].key);
    if (items[i - 1].key == items[i].key) {
      ASSERT_LT(items[i - 1].index, items[i].index);
    }
  }
  EXPECT_EQ(items.size(), points.size());
}

TEST(Hilbert, OrderedPointsOfAGridStandCloserThanAnyRowOrderCouldPutThem) {
  std::vector<vec3> points;
  for (int i = 0; i < 32 * 32 * 32; ++i) points.emplace_back(i % 32, i / 32 % 32, i / 1024);
  const std::vector<std::uint32_t> order = hilbert_order(points);
  double worst_run = 0.0;  // diagonal of the box of 64 points in a row: 4x4x4 along the curve, 1x2x32 in rows
  for (std::size_t i = 0; i < order.size(); i += 64) {
    Box box;
    for (std::size_t k = i; k < i + 64; ++k) box.add(points[order[k]]);
    worst_run = std::max(worst_run, static_cast<double>(box.diagonal()));
  }
  EXPECT_LE(worst_run, std::sqrt(27.0) + 1e-6);
}

TEST(Hilbert, NothingAndOnePointAndCoincidentPointsAreFine) {
  EXPECT_TRUE(hilbert_order({}).empty());
  const std::vector<vec3> same(3, vec3(7.0f));
  EXPECT_EQ(hilbert_order(same), (std::vector<std::uint32_t>{0, 1, 2}));
}

}  // namespace
}  // namespace pliant
