// The shipped level `palpation`: a lump inside tissue is found by touch alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "content/generate/palpation_level.h"
#include "content/level_file.h"
#include "systems/schedule.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/tool/tool_step.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

constexpr double kPalpationTick = 1e-3, kPalpationFinger = 0.005, kPalpationDepth = 0.0035;  // [s] [m] [m]

// [N] Felt at each place of a grid, pressed one after the other.
std::vector<double> feel(const Level& level, const std::vector<dvec2>& places) {
  Result<World> spawned = spawn(level);
  EXPECT_TRUE(spawned.ok());
  World world = std::move(*spawned);
  EXPECT_TRUE(prepare_touch(world).ok());
  EXPECT_TRUE(prepare_tools(world).ok());
  EXPECT_TRUE(prepare_soft(world).ok());
  HapticDevice* device = nullptr;
  for (auto [entity, each] : world.registry.view<HapticDevice>()) device = &each;
  Path& path = world.paths[device->path];
  path.rows.clear(), path.repeats = false, path.turns = false;
  std::vector<double> when;
  double time = 0.0;
  for (const dvec2 at : places) {
    for (const auto& [seconds, height] :
         {std::pair{0.05, 0.003}, {0.05, 0.001}, {0.1, -kPalpationDepth}, {0.15, -kPalpationDepth}, {0.05, 0.003}}) {
      time += seconds;
      path.rows.push_back({time, {at.x, height + kPalpationFinger, at.y}, {1, 0, 0, 0}});
      if (seconds == 0.15) when.push_back(time - 0.01);
    }
  }
  Schedule<World> touch(touch_schedule()), soft(soft_schedule());
  const double T = world.simulation.soft_step;
  std::vector<double> felt;
  std::uint64_t steps = 0;
  for (std::uint64_t tick = 0; felt.size() < places.size(); ++tick) {
    const double now = static_cast<double>(tick) * kPalpationTick;
    for (; static_cast<double>(steps) * T <= now + 1e-9; ++steps)
      run_soft_step(soft, world, {steps, T, static_cast<double>(steps) * T});
    touch.run(world, {tick, kPalpationTick, now});
    if (now >= when[felt.size()]) felt.push_back(device->force_sent.y);
  }
  return felt;
}

TEST(Palpation, TheLumpIsFoundByTouchAloneWithinACell) {
  Result<Level> level = load_level(std::string(PLIANT_SOURCE_DIR) + "/content/levels/palpation.glb");
  ASSERT_TRUE(level.ok());
  std::vector<dvec2> places;
  for (const double x : {-0.02, -0.01, 0.0, 0.01, 0.02})
    for (const double z : {-0.016, -0.008, 0.0, 0.008, 0.016}) places.emplace_back(x, z);
  const std::vector<double> with = feel(*level, places);
  double cell = 0.0;
  for (LevelNode& node : level->nodes)
    if (node.soft_body) cell = node.soft_body->cell, node.soft_body->materials.clear();
  std::vector<dvec2> every_other;
  for (std::size_t i = 0; i < places.size(); i += 2) every_other.push_back(places[i]);
  const std::vector<double> without = feel(*level, every_other);
  // Where more is felt than at most places: its centre of gravity.
  std::vector<double> sorted = with;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double usual = sorted[sorted.size() / 2], most = *std::max_element(with.begin(), with.end());
  dvec2 centre(0);
  double sum = 0.0;
  const auto [least_without, most_without] = std::minmax_element(without.begin(), without.end());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double more = std::max(0.0, with[i] - usual - 0.3 * (most - usual));
    centre += more * places[i], sum += more;
  }
  centre /= sum;
  std::printf("lump felt at (%.1f, %.1f) mm, is at (%.1f, %.1f); %.3f N over it, %.3f N usually, %.3f N without\n",
              1e3 * centre.x, 1e3 * centre.y, 1e3 * generate::kLump.x, 1e3 * generate::kLump.z, most, usual,
              *most_without);
  EXPECT_LT(length(centre - dvec2(generate::kLump.x, generate::kLump.z)), cell);
  EXPECT_GT(most, 1.12 * usual);                   // more than what a hand tells apart, 7 to 10 %
  EXPECT_LT(*most_without, 1.1 * *least_without);  // the cells themselves are not felt
}

}  // namespace
}  // namespace pliant
