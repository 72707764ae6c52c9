// Devices in the window: emulated ones behind the real drivers (emulated/emulated_pliant.cpp) move probes, are stopped
// by the key, armed by the panel's button, unplugged and found again. The window asks about devices that a level may
// not open.
#include <algorithm>
#include <cmath>

#include "content/files/image.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class DeviceWindowTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
    write_text(folder / "plate.obj", plate_obj());
  }
  // The smallest level with two probes, 4 cm apart, that request devices.
  void write_level(const std::string& first = "falcon; spacemouse") const {
    const fs::path from = fs::path(PLIANT_SOURCE_DIR) / "content/levels";
    fs::copy_file(from / "minimal.bin", folder / "minimal.bin");
    Json level = Json::parse(read_text(from / "minimal.gltf"));
    const auto probe = [](const char* name, double x, const char* id) {
      return Json{{"name", name},
                  {"translation", {x, 0.0, 0.0}},
                  {"extensions",
                   {{"PLIANT_probe", {{"radius", 0.002}, {"device", name}}},
                    {"PLIANT_haptic_device", {{"driver", "external"}, {"id", id}}}}}};
    };
    level["nodes"][1] = probe("cap", -0.02, first.c_str());
    level["nodes"][2] = probe("pad", 0.02, "any");
    level["scenes"][0]["nodes"] = {0, 1, 2};
    write_text(folder / "two.gltf", level.dump(2));
  }
  Said shown(const std::vector<std::string>& probes, const std::string& events, const std::string& before = {},
             const std::string& level = "plate.obj") const {
    write_text(folder / "events.csv", "time_s,event,args\n" + events);
    std::vector<std::string> all{"run",   level, "--window", "--input", "events.csv",
                                 "--out", "out", "--size",   "760x620"};
    for (const std::string& probe : probes) {
      all.push_back("--probe");
      all.push_back(probe);
    }
    return pliant(all,
                  before + " XDG_CONFIG_HOME=" + quoted((folder / "config").string()) +
                      " ASAN_OPTIONS=detect_leaks=0 timeout 100 xvfb-run -a -s '-screen 0 800x640x24'",
                  PLIANT_EMULATED);
  }
  struct Row {
    double time, x, y, force;
  };
  std::vector<Row> rows_of(const std::string& probe) const {
    const ForcesTable table = read_forces(folder / "out" / "forces.csv");
    std::vector<Row> rows;
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      if (table.rows[i].at("probe") == probe)
        rows.push_back({table.number(i, "time_s"), table.number(i, "x"), table.number(i, "y"),
                        std::hypot(table.number(i, "fx"), table.number(i, "fy"), table.number(i, "fz"))});
    return rows;
  }
  static double largest(const std::vector<Row>& rows, double from, double to) {
    double most = 0.0;
    for (const Row& row : rows)
      if (row.time >= from && row.time < to) most = std::max(most, row.force);
    return most;
  }
};

// The hand lifts, presses, slides (from 1.4 s), lifts (4.5 s) and presses again (5.2 s).
TEST_F(DeviceWindowTest, CapAndPadMoveProbesAndTheStopKeyLatchesUntilThePanelArms) {
  write_level();
  const Said said =
      shown({}, "2.3,key,F12\n2.6,key,F9\n3.2,key,F12\n4.0,click,Devices/pad/Arm\n7.5,close,\n", {}, "two.gltf");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("Novint Falcon"), std::string::npos) << "passed over, and said so: " << said.err;
  const Json all = report("out");
  for (const Json& probe : all["probes"]) {
    if (probe["name"] == "mouse") continue;  // added by the window
    EXPECT_EQ(probe["source"], probe["name"] == "cap" ? "device:spacemouse:emulated" : "device:dualsense:emulated");
    EXPECT_GT(probe["contact_ticks"], 200) << probe["name"];
  }
  for (const char* name : {"cap", "pad"}) {
    const std::vector<Row> rows = rows_of(name);
    ASSERT_GT(rows.size(), 3000u);
    const auto [low, high] = std::minmax_element(rows.begin(), rows.end(), [](Row a, Row b) { return a.x < b.x; });
    EXPECT_GT(high->x - low->x, 0.003) << name << " did not slide";
    EXPECT_GT(std::max_element(rows.begin(), rows.end(), [](Row a, Row b) { return a.y < b.y; })->y, 0.005);
  }
  const std::vector<Row> pad = rows_of("pad");
  EXPECT_GT(largest(pad, 0.0, 2.3), 0.05) << "nothing was felt before the stop";
  EXPECT_EQ(largest(pad, 3.2, 4.0), 0.0) << "the stop does not hold";
  EXPECT_GT(largest(pad, 4.9, 7.4), 0.05) << "armed by the panel's button, lifted and pressed, it is felt again";
  EXPECT_NE(said.err.find("device of `pad`: active -> tripped"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("the emergency stop was pressed"), std::string::npos) << said.err;
  const auto felt = load_image(folder / "out" / "screenshot-001.png"),
             stopped = load_image(folder / "out" / "screenshot-002.png");
  ASSERT_TRUE(felt && stopped);
  // The panel is at the right: its bright text, and the bars that change.
  std::size_t bright = 0, differ = 0;
  for (std::size_t y = 20; y < 600; ++y)
    for (std::size_t x = 450; x < 745; ++x) {
      const std::size_t i = 4 * (y * 760 + x);
      bright += felt->rgba[i] > 180 && felt->rgba[i + 1] > 180 && felt->rgba[i + 2] > 180;
      differ += std::abs(int{felt->rgba[i]} - int{stopped->rgba[i]}) > 40;
    }
  EXPECT_GT(bright, 800u) << "no panel";
  EXPECT_GT(differ, 300u) << "the panel says the same after the stop";
}

TEST_F(DeviceWindowTest, AnUnpluggedCapIsFoundAgainWithoutARestart) {
  const Said said = shown({"cap=device:spacemouse"}, "2.6,key,F12\n7.0,close,\n", "PLIANT_UNPLUG=2:3.5");
  ASSERT_EQ(said.status, 0) << said.err;
  const std::vector<Row> rows = rows_of("cap");
  const auto spread = [&](double from, double to) {
    double low = 1e9, high = -1e9;
    for (const Row& row : rows)
      if (row.time >= from && row.time < to) low = std::min(low, row.y), high = std::max(high, row.y);
    return high - low;
  };
  EXPECT_GT(spread(0.0, 1.9), 0.01);
  EXPECT_LT(spread(2.4, 3.3), 1e-6) << "nobody is there";
  EXPECT_GT(spread(4.2, 6.8), 0.01) << "plugged in again, it does not move the probe";
  EXPECT_NE(said.err.find("device of `cap`: active -> disconnected"), std::string::npos) << said.err;
}

// A device with a servo: the stop trips its guard.
TEST_F(DeviceWindowTest, TheStopKeyTripsAServedDeviceInTheMiddleOfAPressAndNothingComesBackByItself) {
  write_text(folder / "press.csv", "time_s,x,y,z\n0,0,0.01,0\n1,0,0.01,0\n1.6,0,-0.004,0\n60,0,-0.004,0\n");
  const Said said = shown({"finger=device:simulated:touch,path=press.csv"}, "3.0,key,F9\n4.5,key,F12\n5.0,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(report("out")["probes"][0]["source"], "device:simulated:touch,path=press.csv") << "no hand holds it";
  const std::vector<Row> rows = rows_of("finger");
  EXPECT_GT(largest(rows, 1.6, 3.0), 0.3);
  EXPECT_EQ(largest(rows, 3.6, 5.0), 0.0);
  EXPECT_NE(said.err.find("the emergency stop was pressed"), std::string::npos) << said.err;
}

TEST_F(DeviceWindowTest, WhatALevelMayNotOpenIsAskedForInTheWindow) {
  write_level("network:192.0.2.7:5000");
  const Said said = shown({}, "1.0,key,F12\n1.5,click,Question/Not now\n2.5,key,F12\n3.0,close,\n", {}, "two.gltf");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.err.find("which is not there"), std::string::npos) << said.err;
  const auto asked = load_image(folder / "out" / "screenshot-001.png"),
             answered = load_image(folder / "out" / "screenshot-002.png");
  ASSERT_TRUE(asked && answered);
  std::size_t differ = 0;
  for (std::size_t y = 200; y < 300; ++y)
    for (std::size_t x = 120; x < 440; ++x) {
      const std::size_t i = 4 * (y * 760 + x);
      differ += std::abs(int{asked->rgba[i]} - int{answered->rgba[i]}) > 40;
    }
  EXPECT_GT(differ, 300u) << "the question is not seen, or stays";
}

TEST_F(DeviceWindowTest, AScriptThatPressesWhatIsNotThereSaysSo) {
  const Said said = shown({"cap=device:spacemouse"}, "0.5,click,Devices/cap/Arm\n4.5,close,\n");
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("`Devices/cap/Arm`, which is not there"), std::string::npos) << said.err;
}

}  // namespace
}  // namespace pliant::testing
