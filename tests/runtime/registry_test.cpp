// The registry against a naive twin: a map from entity to optional components.
#include "runtime/registry.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>

namespace pliant {
namespace {

struct Mass {
  double kilograms = 0.0;
};
struct Label {
  std::string text;
};
struct Marked {};

struct NaiveRow {
  std::optional<double> mass;
  std::optional<std::string> label;
  bool marked = false;
};
using Key = std::pair<std::uint32_t, std::uint32_t>;
Key key(Entity entity) {
  return {entity.index, entity.version};
}

// The registry must agree with the map.
void compare(Registry& registry, const std::map<Key, NaiveRow>& naive) {
  ASSERT_EQ(registry.size(), naive.size());
  std::map<Key, double> masses, heavy_labels;
  std::set<Key> all_three;
  for (const auto& [k, row] : naive) {
    const Entity entity{k.first, k.second};
    ASSERT_TRUE(registry.alive(entity));
    ASSERT_EQ(registry.has<Mass>(entity), row.mass.has_value());
    ASSERT_EQ(registry.has<Label>(entity), row.label.has_value());
    ASSERT_EQ(registry.has<Marked>(entity), row.marked);
    if (row.mass) {
      ASSERT_EQ(registry.get<Mass>(entity).kilograms, *row.mass);
      masses[k] = *row.mass;
    }
    if (row.label) {
      ASSERT_EQ(registry.find<Label>(entity)->text, *row.label);
      if (row.mass) heavy_labels[k] = *row.mass;
      if (row.mass && row.marked) all_three.insert(k);
    }
  }
  std::map<Key, double> seen;
  for (auto [entity, mass] : registry.view<const Mass>()) {
    static_assert(std::is_same_v<decltype(mass), const Mass&>);
    ASSERT_TRUE(seen.emplace(key(entity), mass.kilograms).second);
  }
  ASSERT_EQ(seen, masses);
  seen.clear();
  for (auto [entity, label, mass] : registry.view<const Label, Mass>()) {
    static_assert(std::is_same_v<decltype(mass), Mass&>);
    ASSERT_EQ(label.text, *naive.at(key(entity)).label);
    ASSERT_TRUE(seen.emplace(key(entity), mass.kilograms).second);
  }
  ASSERT_EQ(seen, heavy_labels);
  std::set<Key> three;
  const Registry& constant = registry;
  for (auto [entity, mass, label, mark] : constant.view<Mass, Label, Marked>()) {
    static_assert(std::is_same_v<decltype(mass), const Mass&>);
    three.insert(key(entity));
  }
  ASSERT_EQ(three, all_three);
}

TEST(Registry, AgreesWithANaiveMapUnderRandomOperations) {
  std::mt19937 random(7);
  Registry registry;
  std::map<Key, NaiveRow> naive;
  std::vector<Entity> dead;
  const auto pick = [&]() -> std::pair<const Key, NaiveRow>& {
    return *std::next(naive.begin(), static_cast<std::ptrdiff_t>(random() % naive.size()));
  };
  for (int step = 0; step < 6000; ++step) {
    const auto act = random() % 8;
    if (naive.empty() || act < 2) {
      const Entity made = registry.create();
      ASSERT_TRUE(naive.emplace(key(made), NaiveRow{}).second) << "an entity that lives was handed out again";
    } else {
      auto& [k, row] = pick();
      const Entity entity{k.first, k.second};
      if (act == 2 && naive.size() > 20) {
        registry.destroy(entity);
        dead.push_back(entity);
        naive.erase(k);
      } else if (act == 3) {
        row.mass ? registry.remove<Mass>(entity) : (void)registry.add<Mass>(entity, {static_cast<double>(step)});
        row.mass = row.mass ? std::nullopt : std::optional<double>(step);
      } else if (act == 4) {
        row.label ? registry.remove<Label>(entity) : (void)registry.add<Label>(entity, {std::to_string(step)});
        row.label = row.label ? std::nullopt : std::optional<std::string>(std::to_string(step));
      } else if (act == 5) {
        row.marked ? registry.remove<Marked>(entity) : (void)registry.add<Marked>(entity);
        row.marked = !row.marked;
      } else if (act == 6 && row.mass) {
        registry.get<Mass>(entity).kilograms = *(row.mass = -step);
      }
    }
    if (step % 100 == 0) compare(registry, naive);
    if (HasFatalFailure()) return;
  }
  for (Entity entity : dead) {
    EXPECT_FALSE(registry.alive(entity));
    EXPECT_FALSE(registry.has<Mass>(entity));
    EXPECT_EQ(registry.find<Label>(entity), nullptr);
  }
  EXPECT_GT(dead.size(), 100u);
}

TEST(Registry, StaleEntityDoesNotReachTheOneThatTookItsPlace) {
  Registry registry;
  const Entity first = registry.create();
  registry.add<Mass>(first, {1.0});
  registry.destroy(first);
  const Entity second = registry.create();
  registry.add<Mass>(second, {2.0});
  EXPECT_EQ(second.index, first.index);
  EXPECT_NE(second, first);
  EXPECT_EQ(registry.find<Mass>(first), nullptr);
  EXPECT_EQ(registry.get<Mass>(second).kilograms, 2.0);
  registry.remove<Mass>(first);  // a stale removal takes nothing away
  EXPECT_TRUE(registry.has<Mass>(second));
}

TEST(Registry, ViewOfATypeThatNobodyAddedIsEmpty) {
  struct Never {};
  Registry registry;
  registry.add<Mass>(registry.create(), {1.0});
  const auto view = registry.view<Mass, const Never>();
  EXPECT_FALSE(view.begin() != view.end());
}

TEST(Registry, NoEntityIsNeverAlive) {
  Registry registry;
  EXPECT_FALSE(registry.alive(kNoEntity));
  EXPECT_FALSE(registry.has<Mass>(kNoEntity));
  (void)registry.create();
  EXPECT_FALSE(registry.alive(kNoEntity));
}

}  // namespace
}  // namespace pliant
