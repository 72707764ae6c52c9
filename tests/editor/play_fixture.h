// A level of a sheet and a probe that is played without a window.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "content/level_file.h"
#include "editor/play/play.h"
#include "scenes/scenes.h"

namespace pliant::test {

namespace fs = std::filesystem;

inline PlaySource script(const fs::path& folder, const std::string& rows) {
  const fs::path file = folder / "press.csv";
  std::ofstream(file) << "time_s,x,y,z\n" << rows;
  return {PlaySource::Kind::kScript, file.string()};
}

class PlayTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("pliant-play-" + std::to_string(::getpid()) + "-" +
                                          ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder);
    fs::create_directories(folder / "levels");
    fs::create_directory_symlink(fs::path(PLIANT_SOURCE_DIR) / "content/environments", folder / "environments");
  }
  void TearDown() override { fs::remove_all(folder); }

  // A shipped level with its scripts, where it may be changed.
  fs::path bring(const std::string& name) const {
    for (const auto& each : fs::directory_iterator(fs::path(PLIANT_SOURCE_DIR) / "content/levels"))
      if (each.path().filename().string().starts_with(name.substr(0, name.find('.'))))
        fs::copy_file(each.path(), folder / "levels" / each.path().filename(), fs::copy_options::overwrite_existing);
    return folder / "levels" / name;
  }
  // The hash that `pliant run` prints for the level on disk.
  std::string hash_of_run(const fs::path& level, double seconds) const {
    const std::string line =
        "cd '" + folder.string() + "' && env -u DISPLAY -u WAYLAND_DISPLAY '" PLIANT_BINARY "' run '" + level.string() +
        "' --lockstep --headless --frames 0 --seconds " + std::to_string(seconds) + " --out out --force >said 2>&1";
    if (std::system(line.c_str()) != 0) {
      std::ifstream said(folder / "said");
      ADD_FAILURE() << std::string(std::istreambuf_iterator<char>(said), {});
      return {};
    }
    return nlohmann::json::parse(std::ifstream(folder / "out" / "report.json"))["hash"];
  }
  // Options of a run in which a script of such rows moves the probe `tip`.
  PlayOptions pressing(const std::string& rows) const {
    PlayOptions options;
    options.sources = {{"tip", script(folder, rows)}};
    return options;
  }
  fs::path folder;
};

inline std::unique_ptr<PlayRun> run_of(const State& state, const fs::path& file, PlayOptions options = {}) {
  options.level = [state, file]() -> Result<Level> {
    Level level = level_of(state);
    level.path = file;
    return level;
  };
  options.paused = true;
  auto run = std::make_unique<PlayRun>(std::move(options));
  run->wait();
  EXPECT_EQ(run->status().error, "");
  return run;
}

inline PlayStatus after(PlayRun& run, std::uint64_t ticks) {
  run.step(ticks);
  run.wait();
  EXPECT_EQ(run.status().error, "");
  return run.status();
}

template <class Condition>
bool comes_true(Condition condition) {
  for (int i = 0; i < 1000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

// A linear law that reaches 2 cm.
inline Deformable soft_law() {
  Deformable law;
  law.reach = 0.02;
  return law;
}

// A sheet of 10 cm in y = 0 and a probe above its middle, which the script given presses in.
inline State pressed_sheet(const Deformable& law, double radius = 0.0) {
  Level level;
  level.meshes.push_back({"sheet", {scenes::sheet(24, 0.1)}});
  LevelNode sheet;
  sheet.name = "sheet";
  sheet.mesh = 0;
  sheet.deformable = law;
  LevelNode tip;
  tip.name = "tip";
  tip.local.translation = {0, 0.02f, 0};
  tip.probe.emplace();
  tip.probe->radius = radius;
  tip.device.emplace();
  tip.device->max_force = 10.0;
  tip.device->max_slew = 5000.0;
  tip.probe_device = "tip";
  level.nodes = {sheet, tip};
  NodeId next = 1;
  return state_of(std::move(level), next);
}

}  // namespace pliant::test
