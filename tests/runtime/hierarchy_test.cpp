// The hierarchy against a naive twin: a map from child to parent.
#include "runtime/hierarchy.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace pliant {
namespace {

constexpr std::uint32_t kRoot = 0xffffffffu;

TEST(Hierarchy, KeepsParentsBeforeChildrenInAnyTree) {
  std::mt19937 random(3);
  Hierarchy hierarchy;
  std::map<std::uint32_t, std::uint32_t> parents;  // by entity index; those are given out of order
  for (std::uint32_t step = 0; step < 3000; ++step) {
    const std::uint32_t node = (step * 1234577u) % 3001u;  // 3001 is prime: each once
    const bool root = parents.empty() || random() % 8 == 0;
    const std::uint32_t parent =
        root ? kRoot : std::next(parents.begin(), static_cast<std::ptrdiff_t>(random() % parents.size()))->first;
    hierarchy.add({node, 0}, root ? kNoEntity : Entity{parent, 0});
    ASSERT_TRUE(parents.emplace(node, parent).second);
  }
  ASSERT_EQ(hierarchy.order().size(), parents.size());
  for (std::size_t i = 0; i < hierarchy.order().size(); ++i) {
    const Hierarchy::Link& link = hierarchy.order()[i];
    ASSERT_LT(link.parent, static_cast<std::int32_t>(i)) << "a child stands before its parent";
    const std::uint32_t parent =
        link.parent < 0 ? kRoot : hierarchy.order()[static_cast<std::size_t>(link.parent)].entity.index;
    ASSERT_EQ(parent, parents.at(link.entity.index));
  }
}

}  // namespace
}  // namespace pliant
