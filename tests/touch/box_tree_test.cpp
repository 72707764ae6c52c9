// The tree of boxes against every box looked at one by one.
#include "systems/touch/collide/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scenes/count_allocations.h"

namespace pliant {
namespace {

class RandomBoxes {
 public:
  explicit RandomBoxes(unsigned seed) : engine_(seed) {}
  float unit() { return std::uniform_real_distribution<float>(-1, 1)(engine_); }
  std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  Box box(float spread, float size) {
    const vec3 middle = spread * vec3(unit(), unit(), unit());
    const vec3 half = size * glm::abs(vec3(unit(), unit(), unit()));
    return {middle - half, middle + half};
  }

 private:
  std::mt19937 engine_;
};

std::vector<std::uint32_t> found(const BoxTree& tree, const Box& box) {
  std::vector<std::uint32_t> ids;
  tree.visit(box, [&](std::uint32_t id) { ids.push_back(id); });
  return ids;
}

void expect_as_brute_force(const BoxTree& tree, const std::vector<Box>& boxes, const Box& box) {
  std::vector<std::uint32_t> want, got = found(tree, box);
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].empty() && !box.empty() && glm::all(glm::lessThanEqual(boxes[i].min, box.max)) &&
        glm::all(glm::lessThanEqual(box.min, boxes[i].max)))
      want.push_back(i);
  std::sort(got.begin(), got.end());
  ASSERT_EQ(got, want);
}

TEST(BoxTree, FindsWhatBruteForceFindsWhileThousandsOfBoxesMove) {
  for (const std::size_t count : {1, 2, 3, 40, 4000}) {
    RandomBoxes random(static_cast<unsigned>(count));
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(random.box(1.0f, 0.03f));
    BoxTree tree(boxes);
    for (int round = 0; round < 60; ++round) {
      for (int n = 0; n < 20; ++n) expect_as_brute_force(tree, boxes, random.box(1.1f, n % 4 ? 0.05f : 0.5f));
      for (std::size_t n = 0; n < count / 4 + 1; ++n) {
        const std::uint32_t id = random.below(count);
        const vec3 step = (round % 3 ? 0.002f : 0.5f) * vec3(random.unit(), random.unit(), random.unit());
        boxes[id] = {boxes[id].min + step, boxes[id].max + step};
        if (n % 17 == 0) boxes[id] = random.box(1.0f, n % 2 ? 0.3f : 1e-4f);
        tree.move(id, boxes[id]);
      }
      ASSERT_LE(tree.height(), 1.45 * std::log2(static_cast<double>(count) + 2) + 1);
    }
  }
}

TEST(BoxTree, BoxesThatTouchMeetAndEmptyOnesDoNot) {
  std::vector<Box> boxes{{vec3(0), vec3(1)}, {vec3(1, 0, 0), vec3(2, 1, 1)}, {}, {vec3(0.5f), vec3(0.5f)}};
  BoxTree tree(boxes);
  expect_as_brute_force(tree, boxes, {vec3(1, 1, 1), vec3(3, 3, 3)});
  expect_as_brute_force(tree, boxes, {vec3(-10), vec3(10)});
  EXPECT_TRUE(found(tree, Box{}).empty());
  boxes[0] = {};
  boxes[2] = {vec3(0), vec3(0.1f)};
  for (const std::uint32_t i : {0, 2}) tree.move(i, boxes[i]);
  expect_as_brute_force(tree, boxes, {vec3(-10), vec3(10)});
  EXPECT_TRUE(found(BoxTree(), {vec3(-10), vec3(10)}).empty());
}

TEST(BoxTree, StaysBalancedWhenEverythingMovesInOrderAndWhenAllBoxesCoincide) {
  constexpr std::uint32_t kCount = 4096;
  for (const float apart : {1.0f, 0.0f}) {
    std::vector<Box> boxes(kCount, Box{vec3(0), vec3(0.5f)});
    BoxTree tree(boxes);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const vec3 at(10 + apart * static_cast<float>(i), 0, 0);
      boxes[i] = {at, at + vec3(0.5f)};
      tree.move(i, boxes[i]);
    }
    EXPECT_LE(tree.height(), 1.45 * std::log2(kCount) + 1);
    for (const float x : {9.0f, 10.2f, 500.3f, 4105.7f})
      expect_as_brute_force(tree, boxes, {vec3(x, 0, 0), vec3(x + 0.1f, 1, 1)});
  }
}

TEST(BoxTree, MovingAndVisitingDoNotAllocate) {
  RandomBoxes random(9);
  std::vector<Box> boxes;
  for (int i = 0; i < 1000; ++i) boxes.push_back(random.box(1.0f, 0.05f));
  BoxTree tree(boxes);
  std::size_t met = 0;
  const CountAllocations allocations;
  for (int i = 0; i < 1000; ++i) {
    tree.move(random.below(1000), random.box(1.0f, 0.05f));
    tree.visit(random.box(1.0f, 0.1f), [&](std::uint32_t) { ++met; });
  }
  EXPECT_EQ(allocations.count(), 0u);
  EXPECT_GT(met, 0u);
}

TEST(BoxTree, TheSameCallsGiveTheSameOrderOfVisits) {
  const auto play = [] {
    RandomBoxes random(7);
    std::vector<Box> boxes;
    for (int i = 0; i < 500; ++i) boxes.push_back(random.box(1.0f, 0.05f));
    BoxTree tree(boxes);
    for (int i = 0; i < 2000; ++i) tree.move(random.below(500), random.box(1.0f, 0.05f));
    return found(tree, {vec3(-0.7f), vec3(0.7f)});
  };
  EXPECT_EQ(play(), play());
}

}  // namespace
}  // namespace pliant
