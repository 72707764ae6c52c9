// A painted layer against a plain array, and the memory of many versions.
#include "editor/paint/paint_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace pliant {
namespace {

TEST(PaintLayer, HoldsWhatAPlainArrayHoldsAfterThousandsOfRandomWrites) {
  std::mt19937 random(7);
  for (const std::size_t size : {1u, 4095u, 4096u, 4097u, 20000u}) {
    std::vector<float> plain(size, 1.0f);
    PaintLayer layer = PaintLayer::from(plain);
    for (int round = 0; round < 200; ++round) {
      std::vector<IndexedValue> changes;
      for (int i = 0; i < 20; ++i) {
        changes.push_back({static_cast<std::uint32_t>(random() % size), float(random() % 100)});
        plain[changes.back().index] = changes.back().value;
      }
      layer = layer.with(changes);
    }
    EXPECT_EQ(layer.flatten(), plain);
    EXPECT_EQ(layer.size(), size);
    for (std::size_t i = 0; i < size; i += 97) EXPECT_EQ(layer.value(i), plain[i]);
    EXPECT_TRUE(layer == PaintLayer::from(plain));
  }
}

TEST(PaintLayer, EveryOlderVersionStaysAsItWasAndSharesWhatWasNotTouched) {
  const std::size_t size = 100 * PaintLayer::kChunk, chunk = PaintLayer::kChunk * sizeof(float);
  std::vector<PaintLayer> undo{PaintLayer::constant(size, 1.0f)};
  EXPECT_EQ(undo[0].bytes_not_shared_with({}), chunk) << "a constant is one chunk, however long";
  for (std::uint32_t stroke = 0; stroke < 50; ++stroke) {
    const IndexedValue changes[]{{stroke * 8000, float(stroke) + 2}, {stroke * 8000 + 1, 5.0f}};
    undo.push_back(undo.back().with(changes));
    EXPECT_LE(undo.back().bytes_not_shared_with(undo[undo.size() - 2]), 2 * chunk);
    EXPECT_GE(undo.back().bytes_not_shared_with(undo[undo.size() - 2]), chunk);
  }
  for (std::uint32_t version = 0; version <= 50; ++version)
    for (std::uint32_t stroke = 0; stroke < 50; ++stroke)
      EXPECT_EQ(undo[version].value(stroke * 8000), stroke < version ? float(stroke) + 2 : 1.0f);
}

TEST(PaintLayer, AWriteOfTheSameBitsSharesEverything) {
  std::vector<float> values(10000, 3.0f);
  const PaintLayer layer = PaintLayer::from(values);
  const IndexedValue same[]{{5, 3.0f}, {9000, 3.0f}}, there_and_back[]{{5, 4.0f}, {5, 3.0f}};
  EXPECT_EQ(layer.with(same).bytes_not_shared_with(layer), 0u);
  EXPECT_TRUE(layer.with(there_and_back) == layer);
}

TEST(PaintLayer, EqualityIsOfBits) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(PaintLayer::from(std::vector{nan, 1.0f}) == PaintLayer::from(std::vector{nan, 1.0f}));
  EXPECT_FALSE(PaintLayer::from(std::vector{0.0f}) == PaintLayer::from(std::vector{-0.0f}));
  EXPECT_FALSE(PaintLayer::constant(4096, 0.0f) == PaintLayer::constant(4095, 0.0f)) << "zeros behind the end";
  EXPECT_TRUE(PaintLayer::constant(5000, 2.0f) == PaintLayer::from(std::vector<float>(5000, 2.0f)));
  EXPECT_TRUE(PaintLayer() == PaintLayer::from({}));
}

}  // namespace
}  // namespace pliant
