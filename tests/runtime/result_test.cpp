#include "runtime/result.h"

#include <gtest/gtest.h>

#include <memory>

#include "runtime/hash.h"

namespace pliant {
namespace {

Result<std::unique_ptr<int>> halve(int number) {
  if (number % 2) return Error{"number", "is odd; give an even one"};
  return std::make_unique<int>(number / 2);
}

TEST(Result, HoldsTheValueOrTheSentenceThatSaysWhyNot) {
  auto good = halve(8);
  ASSERT_TRUE(good);
  EXPECT_EQ(**good, 4);
  const std::unique_ptr<int> moved = std::move(good).value();
  EXPECT_EQ(*moved, 4);
  const auto bad = halve(3);
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().message(), "number: is odd; give an even one");
  EXPECT_EQ((Error{"", "sentence"}).message(), "sentence");
}

TEST(ResultDeathTest, TakingAValueThatIsNotThereStopsTheProgramAndSaysWhatTheErrorWas) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto bad = halve(3);
  EXPECT_DEATH((void)bad.value(), "internal error: a Result was used without a check: .*odd");
}

// Every single bit, and the length, must count.
TEST(Hash, ChangesWithEveryBitAndWithTheLength) {
  unsigned char data[27] = {};
  const auto hash_of = [&](std::size_t size) {
    Hash hash;
    hash.add_bytes(data, size);
    return hash.value();
  };
  const std::uint64_t zeros = hash_of(sizeof data);
  for (std::size_t bit = 0; bit < 8 * sizeof data; ++bit) {
    data[bit / 8] ^= static_cast<unsigned char>(1u << (bit % 8));
    EXPECT_NE(hash_of(sizeof data), zeros) << bit;
    data[bit / 8] = 0;
  }
  for (std::size_t size = 0; size < sizeof data; ++size) EXPECT_NE(hash_of(size), hash_of(size + 1)) << size;
}

TEST(Hash, IsTheSameForTheSameValuesAndDependsOnTheirOrder) {
  Hash a, b, c;
  a.add(1.5);
  a.add(std::uint32_t{7});
  b.add(1.5);
  b.add(std::uint32_t{7});
  c.add(std::uint32_t{7});
  c.add(1.5);
  EXPECT_EQ(a.value(), b.value());
  EXPECT_NE(a.value(), c.value());
}

}  // namespace
}  // namespace pliant
