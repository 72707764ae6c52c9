// The hierarchy against a naive twin: a map from child to parent.
#include "runtime/hierarchy.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace pliant {
namespace {

constexpr std::uint32_t kRoot = 0xffffffffu;
using Parents = std::map<std::uint32_t, std::uint32_t>;  // by entity index

bool hangs_below(const Parents& parents, std::uint32_t node, std::uint32_t ancestor) {
  for (; node != kRoot; node = parents.at(node))
    if (node == ancestor) return true;
  return false;
}

void compare(const Hierarchy& hierarchy, const Parents& parents) {
  ASSERT_EQ(hierarchy.order().size(), parents.size());
  std::set<std::uint32_t> seen;
  for (std::size_t i = 0; i < hierarchy.order().size(); ++i) {
    const Hierarchy::Link& link = hierarchy.order()[i];
    ASSERT_LT(link.parent, static_cast<std::int32_t>(i)) << "a child stands before its parent";
    const std::uint32_t parent =
        link.parent < 0 ? kRoot : hierarchy.order()[static_cast<std::size_t>(link.parent)].entity.index;
    ASSERT_EQ(parent, parents.at(link.entity.index));
    ASSERT_TRUE(seen.insert(link.entity.index).second);
    ASSERT_EQ(hierarchy.parent(link.entity).index, parent);
  }
}

TEST(Hierarchy, KeepsParentsBeforeChildrenUnderRandomAddMoveAndRemove) {
  std::mt19937 random(3);
  Hierarchy hierarchy;
  Parents parents;
  std::uint32_t next = 0;
  int refused = 0, moved = 0, removed = 0;
  for (int step = 0; step < 3000; ++step) {
    const auto pick = [&] {
      return std::next(parents.begin(), static_cast<std::ptrdiff_t>(random() % parents.size()))->first;
    };
    const auto act = random() % 10;
    const std::uint32_t parent = parents.empty() || random() % 8 == 0 ? kRoot : pick();
    if (parents.empty() || act < 4) {
      hierarchy.add({next, 0}, parent == kRoot ? kNoEntity : Entity{parent, 0});
      parents[next++] = parent;
    } else if (act < 9) {
      const std::uint32_t node = pick();
      const bool legal = parent == kRoot || !hangs_below(parents, parent, node);
      ASSERT_EQ(hierarchy.move({node, 0}, parent == kRoot ? kNoEntity : Entity{parent, 0}), legal);
      if (legal) parents[node] = parent;
      ++(legal ? moved : refused);
    } else {
      const std::uint32_t node = pick();
      std::set<std::uint32_t> expected, got;
      for (const auto& [child, its_parent] : parents)
        if (hangs_below(parents, child, node)) expected.insert(child);
      const std::vector<Entity> taken = hierarchy.remove({node, 0});
      ASSERT_EQ(taken.front().index, node) << "parents come first";
      for (Entity entity : taken) got.insert(entity.index);
      ASSERT_EQ(got, expected);
      for (std::uint32_t gone : expected) parents.erase(gone);
      ++removed;
    }
    compare(hierarchy, parents);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(refused, 20);
  EXPECT_GT(moved, 500);
  EXPECT_GT(removed, 100);
}

}  // namespace
}  // namespace pliant
