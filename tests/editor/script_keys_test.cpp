// Paths as curves: through their keys, no deeper than these, and restored from a file.
#include "editor/document/script_keys.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "content/level/script.h"

namespace pliant {
namespace {

ScriptKeys press() {
  ScriptKeys script;
  script.keys = {{0.0, {0, 0.1, 0}, {0, 1, 0}, 0.02},
                 {1.0, {0, 0.1, 0}, {0, 1, 0}, -0.005},
                 {2.5, {0.03, 0.1, 0}, {0, 1, 0}, -0.005},
                 {3.0, {0.03, 0.1, 0}, {0, 1, 0}, 0.02}};
  return script;
}

TEST(ScriptKeys, GoThroughEveryKeyAtItsTime) {
  const ScriptKeys script = press();
  for (const PathKey& key : script.keys) EXPECT_LT(length(position_at(script, key.time) - key.position()), 1e-15);
}

TEST(ScriptKeys, ASmoothPathNeverLeavesTheRangeOfTheKeysAroundIt) {
  const ScriptKeys script = press();
  for (double t = 0; t <= 3.0; t += 1e-3) {
    const dvec3 at = position_at(script, t);
    EXPECT_GE(at.y, 0.095 - 1e-15);
    EXPECT_LE(at.y, 0.12 + 1e-15);
    if (t >= 1.0 && t <= 2.5) EXPECT_NEAR(at.y, 0.095, 1e-15);  // constant while it slides
  }
}

TEST(ScriptKeys, ASmoothPathHasNoJumpInItsVelocity) {
  const ScriptKeys script = press();
  constexpr double dt = 1e-5;
  for (double t = dt; t < 3.0; t += 1e-3) {
    const dvec3 before = (position_at(script, t) - position_at(script, t - dt)) / dt,
                after = (position_at(script, t + dt) - position_at(script, t)) / dt;
    EXPECT_LT(length(after - before), 5e-3) << t;
  }
}

TEST(ScriptKeys, ComeBackFromTheFileThatEveryRunReads) {
  const auto file = std::filesystem::temp_directory_path() / ("pliant_keys_" + std::to_string(::getpid()) + ".csv");
  const ScriptKeys script = press();
  ASSERT_TRUE(save_keys(script, file).ok());
  const Result<ScriptKeys> again = load_keys(file);
  ASSERT_TRUE(again.ok()) << again.error().message();
  EXPECT_EQ(*again, script);
  const Result<Path> path = load_script(file);
  ASSERT_TRUE(path.ok());
  for (const PathRow& row : path->rows) EXPECT_LT(length(row.position - position_at(script, row.time)), 1e-8);
  std::filesystem::remove(file);
}

TEST(ScriptKeys, OfAPathStayWithinTheTolerance) {
  Path path;
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.003 * i;
    path.rows.push_back({t, {0.02 * std::cos(3 * t), 0.02 * std::sin(5 * t), 0.001 * t}, {1, 0, 0, 0}});
  }
  const ScriptKeys script = keys_of(path, 1e-3);
  EXPECT_LT(script.keys.size(), 100u);
  EXPECT_GT(script.keys.size(), 5u);
  for (const PathRow& row : path.rows) EXPECT_LE(length(row.position - position_at(script, row.time)), 1e-3 + 1e-12);
}

}  // namespace
}  // namespace pliant
