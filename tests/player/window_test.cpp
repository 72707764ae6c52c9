// The window on a virtual display (Xvfb), with input events from a file and from X.
#include <algorithm>
#include <array>
#include <cmath>

#include "content/files/image.h"
#include "content/level/script.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

// Under the leak sanitizer: display drivers keep allocations, from libraries that are unloaded at the check.
constexpr const char* kDriversLeak = "ASAN_OPTIONS=detect_leaks=0 ";

class WindowTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    if (!there("xvfb-run")) GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
    write_text(folder / "plate.obj", plate_obj());
  }
  static bool there(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
  }
  Said shown(const std::vector<std::string>& arguments, const std::string& events) const {
    write_text(folder / "events.csv", "time_s,event,args\n" + events);
    std::vector<std::string> all{"run"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    for (const char* more : {"--window", "--input", "events.csv", "--out", "out", "--size", "240x160"})
      all.push_back(more);
    return pliant(all, std::string(kDriversLeak) + "timeout 60 xvfb-run -a -s '-screen 0 400x300x24'");
  }
  Json probe(const std::string& name) const {
    const Json all = report("out");
    for (const Json& each : all["probes"])
      if (each["name"] == name) return each;
    ADD_FAILURE() << "no probe " << name;
    return {};
  }
  // The last row of every probe has the final force on the hand.
  void expect_no_force_at_the_end() const {
    const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
    const std::size_t probes = report("out")["probes"].size();
    ASSERT_GE(forces.rows.size(), probes);
    for (std::size_t i = forces.rows.size() - probes; i < forces.rows.size(); ++i)
      for (const char* axis : {"fx", "fy", "fz"}) EXPECT_EQ(forces.number(i, axis), 0.0) << forces.rows[i].at("probe");
  }
};

// Standard deviation of a picture's pixels, 0 to 255.
double contrast(const fs::path& file) {
  const auto image = load_image(file);
  if (!image) return 0.0;
  double sum = 0, squares = 0, count = 0;
  for (std::size_t i = 0; i < image->rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    sum += image->rgba[i];
    squares += double(image->rgba[i]) * image->rgba[i];
    ++count;
  }
  return std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
}

TEST_F(WindowTest, TheMouseTouchesTheDemoOrganAndAScreenshotShowsIt) {
  const Said said = shown({"three_probes", "--probe", "finger=mouse"},
                          "0.0,key,Tab\n0.0,move,120 80\n0.3,press,\n1.5,key,F12\n1.8,release,\n2.1,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  const Json finger = probe("finger");
  EXPECT_EQ(finger["source"], "mouse");
  EXPECT_GT(finger["contact_ticks"], 100);
  EXPECT_GT(finger["max_depth_m"], 1e-4);
  EXPECT_EQ(report("out")["mode"], "window");
  EXPECT_GT(report("out")["frame_ms"]["p50"], 0.0);
  EXPECT_GT(contrast(folder / "out" / "screenshot-001.png"), 10.0) << "the screenshot is blank";
  expect_no_force_at_the_end();
}

TEST_F(WindowTest, EveryScreenshotThatIsAskedForIsTaken) {
  const Said said = shown({"plate.obj"}, "0.5,key,F12\n0.5,key,F12\n0.5,key,F12\n3.0,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  for (const char* file : {"screenshot-001.png", "screenshot-002.png", "screenshot-003.png"})
    EXPECT_GT(contrast(folder / "out" / file), 1.0) << file;
  EXPECT_FALSE(fs::exists(folder / "out" / "screenshot-004.png"));
}

TEST_F(WindowTest, MouseAndScriptPressTogetherAndFeelForce) {
  write_text(folder / "press.csv", press_csv(0.002));
  const Said said = shown({"plate.obj", "--probe", "finger=mouse", "--probe", "tip=script:press.csv"},
                          "0.0,key,Tab\n0.0,move,120 80\n0.2,press,\n1.6,release,\n1.9,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  for (const char* name : {"finger", "tip"}) {
    EXPECT_GT(probe(name)["contact_ticks"], 100) << name;
    EXPECT_GT(probe(name)["max_force_N"], 0.05) << name;
  }
  expect_no_force_at_the_end();
}

TEST_F(WindowTest, ClosingWhileItPressesStillWritesTheReportAndLeavesNoForce) {
  const Said said = shown({"plate.obj"}, "0.0,key,Tab\n0.0,move,120 80\n0.1,press,\n0.8,key,Esc\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(probe("mouse")["source"], "mouse") << "a bare mesh in a window is the mouse's";
  EXPECT_GT(report("out")["ticks"], 500);
  EXPECT_EQ(read_text(folder / "out" / "forces.png").substr(1, 3), "PNG");
  expect_no_force_at_the_end();
}

TEST_F(WindowTest, SecondsEndItAndADroppedFileThatIsNoneLeavesTheLevelAsItWas) {
  const Said said = shown({"plate.obj", "--seconds", "1"}, "0.1,drop,nowhere.glb\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(report("out")["level"], "plate");
  EXPECT_GE(report("out")["ticks"].get<int>() + report("out")["overruns"].get<int>(), 1000);
}

// Mean difference of the channels of two pictures of one size, 0 to 255.
double difference(const fs::path& a, const fs::path& b) {
  const auto x = load_image(a), y = load_image(b);
  if (!x || !y || x->rgba.size() != y->rgba.size()) return 255.0;
  double sum = 0;
  for (std::size_t i = 0; i < x->rgba.size(); ++i) sum += std::abs(int{x->rgba[i]} - int{y->rgba[i]});
  return sum / (0.75 * static_cast<double>(x->rgba.size()));
}

TEST_F(WindowTest, ShowsWhatARunWithoutOneShows) {
  write_text(folder / "hold.csv", "time_s,x,y,z\n0,0,0.01,0\n0.3,0.01,-0.008,0\n60,0.01,-0.008,0\n");
  const Said said = shown({"plate.obj", "--set", "*.deformable.reach=0.04", "--probe", "tip=script:hold.csv"},
                          "0.0,key,Tab\n4.0,key,F12\n6.0,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  auto still = [&](const std::string& script, const std::string& out) {
    const Said drawn =
        pliant({"run", "plate.obj", "--set", "*.deformable.reach=0.04", "--headless", "--probe", "tip=script:" + script,
                "--seconds", "4.5", "--frames", "1", "--size", "240x160", "--out", out});
    ASSERT_EQ(drawn.status, 0) << drawn.err;
  };
  still("hold.csv", "still");
  write_text(folder / "lift.csv", "time_s,x,y,z\n0,0.01,0.03,0\n60,0.01,0.03,0\n");
  still("lift.csv", "lifted");
  const fs::path window = folder / "out" / "screenshot-001.png";
  EXPECT_LT(difference(window, folder / "still" / "frame-0000.png"), 0.3);
  EXPECT_GT(difference(window, folder / "lifted" / "frame-0000.png"), 0.5) << "any picture would pass";
}

TEST_F(WindowTest, SlowPicturesDoNotTakeTheForceFromAMouseThatPresses) {
  write_text(folder / "fine.obj", plate_obj(500));
  const Said said = shown({"fine.obj"}, "0.0,key,Tab\n0.0,move,120 80\n0.8,press,\n4.5,release,\n5.5,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  expect_no_force_at_the_end();
  if (report("out")["frame_ms"]["p50"] < 250.0)
    GTEST_SKIP() << "pictures come faster here than the touch clock's patience with a silent mouse";
  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  std::size_t felt = 0, without = 0, waiting = 0;  // ticks; waiting: for the force to return
  for (std::size_t i = 0; i < forces.rows.size(); ++i) {
    const bool force = forces.number(i, "fx") != 0.0 || forces.number(i, "fy") != 0.0 || forces.number(i, "fz") != 0.0;
    if (force) {
      ++felt;
      without += waiting;
      waiting = 0;
    } else if (felt > 0) {
      ++waiting;
    }
  }
  ASSERT_GT(felt, 500u) << "it hardly pressed";
  EXPECT_LT(without, felt / 10);
}

// The position of a probe's device in the last row before `time` [s].
std::array<double, 3> position_at(const ForcesTable& forces, const std::string& probe, double time) {
  std::array<double, 3> at{};
  for (std::size_t i = 0; i < forces.rows.size(); ++i)
    if (forces.rows[i].at("probe") == probe && forces.number(i, "time_s") <= time)
      at = {forces.number(i, "x"), forces.number(i, "y"), forces.number(i, "z")};
  return at;
}
double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST_F(WindowTest, AScriptStartsOverInAWindowAndHoldsItsLastRowWithoutOne) {
  write_text(folder / "dip.csv", "time_s,x,y,z\n0,0,0.03,0\n0.5,0,0.01,0\n1,0,0.03,0\n");
  const std::vector<std::string> run{"plate.obj", "--probe", "tip=script:dip.csv", "--seconds", "2.7"};
  const Said said = shown(run, "");
  ASSERT_EQ(said.status, 0) << said.err;
  const ForcesTable again = read_forces(folder / "out" / "forces.csv");
  EXPECT_NEAR(position_at(again, "tip", 0.5)[1], 0.01, 1e-3);
  EXPECT_NEAR(position_at(again, "tip", 1.5)[1], 0.01, 1e-3);
  EXPECT_NEAR(position_at(again, "tip", 2.5)[1], 0.01, 1e-3);
  std::vector<std::string> still{"run"};
  still.insert(still.end(), run.begin(), run.end());
  for (const char* more : {"--headless", "--frames", "0", "--out", "still"}) still.push_back(more);
  ASSERT_EQ(pliant(still).status, 0);
  EXPECT_EQ(position_at(read_forces(folder / "still" / "forces.csv"), "tip", 1.5)[1], 0.03);
}

TEST_F(WindowTest, TheMouseTakesAToolFromItsScriptAndLeavesItWhereItIsLetGo) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "tissue under a sanitizer takes minutes";
#endif
  // `./dev run hand`, as in the README: grabbed at its first finger's knuckle, moved to the right, released.
  const Said said =
      shown({"hand"},
            "0.0,key,Tab\n0.0,move,110 20\n1.0,press,\n2.5,move,120 20\n2.6,move,130 20\n2.7,move,140 20\n"
            "4.5,release,\n6.0,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  ASSERT_FALSE(forces.rows.empty());
  const double end = forces.number(forces.rows.size() - 1, "time_s");
  const auto begin = position_at(forces, "hand", 0.0), led = position_at(forces, "hand", 0.8),
             let_go = position_at(forces, "hand", end - 0.7), left = position_at(forces, "hand", end);
  EXPECT_GT(distance(begin, led), 1e-3) << "its script leads it until it is taken hold of";
  EXPECT_GT(std::hypot(let_go[0] - led[0], let_go[2] - led[2]), 0.01) << "it was not carried";
  EXPECT_LT(distance(let_go, left), 1e-6) << "its script leads it on";
  double fastest = 0;
  for (std::size_t i = 1; i < forces.rows.size(); ++i) {
    if (forces.number(i, "time_s") > 2.4) break;  // the pointer itself jumps later
    const double dt = forces.number(i, "time_s") - forces.number(i - 1, "time_s");
    const auto at = [&](std::size_t k) {
      return std::array{forces.number(k, "x"), forces.number(k, "y"), forces.number(k, "z")};
    };
    fastest = std::max(fastest, distance(at(i), at(i - 1)) / dt);
  }
  EXPECT_LT(fastest, 0.5) << "[m/s]: it jumps where it is taken";
  expect_no_force_at_the_end();
}

TEST_F(WindowTest, ADroppedMeshTakesTheLevelsPlace) {
  write_text(folder / "other.obj", plate_obj());
  for (const std::string close : {"9.0", "40.0"}) {  // on a slow machine it is still loading when the first one closes
    fs::remove_all(folder / "out");
    const Said said =
        shown({"plate.obj", "--set", "*.deformable.stiffness=500"}, "0.1,drop,other.obj\n" + close + ",close,\n");
    ASSERT_EQ(said.status, 0) << said.err;
    EXPECT_NE(said.err.find("--set are for the first level"), std::string::npos) << said.err;
    if (fs::exists(folder / "out" / "other" / "report.json")) break;
  }
  EXPECT_EQ(report("out")["level"], "plate");
  EXPECT_EQ(report("out/other")["level"], "other");
}

TEST_F(WindowTest, ThePanelOfLevelsOpensAnother) {
  const fs::path levels = fs::path(PLIANT_SOURCE_DIR) / "content/levels";
  fs::copy_file(levels / "minimal.gltf", folder / "beside.gltf");
  for (const char* part : {"minimal.bin", "minimal.csv"}) fs::copy_file(levels / part, folder / part);
  for (const std::string close : {"3.0", "40.0"}) {  // as above
    fs::remove_all(folder / "out");
    const Said said = shown({"plate.obj"}, "0.1,key,L\n0.5,click,Levels/beside\n" + close + ",close,\n");
    ASSERT_EQ(said.status, 0) << said.err;
    if (fs::exists(folder / "out" / "beside" / "report.json")) break;
  }
  EXPECT_EQ(report("out/beside")["level"], "beside");
}

// A probe that keeps 2 mm: its force is the stiffness times that, after every change.
TEST_F(WindowTest, ASliderOfTheLevelIsFeltAtOnceAndUndone) {
  write_text(folder / "hold.csv", "time_s,x,y,z\n0,0,0.01,0\n0.3,0,-0.002,0\n90,0,-0.002,0\n");
  const Said said = shown(
      {"plate.obj", "--probe", "tip=script:hold.csv", "--record", "p.rec", "--set",
       R"(scene.simulation.expose=[{"key":"plate.deformable.stiffness","name":"Soft","range":[100,920],"step":50}])"},
      "0.0,key,L\n1.0,click,Sliders/Soft\n2.2,click,Sliders/Undo\n3.4,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  const ForcesTable forces = read_forces(folder / "out" / "forces.csv");
  std::vector<double> levels;  // [N] forces that lasted for 50 ticks
  int lasted = 0;
  for (std::size_t i = 1; i < forces.rows.size(); ++i) {
    if (forces.rows[i].at("probe") != "tip" || forces.number(i, "depth_m") < 0.00199) continue;
    const double now = forces.number(i, "fn");
    lasted = std::abs(now - forces.number(i - 1, "fn")) < 1e-6 ? lasted + 1 : 0;
    if (lasted == 50 && (levels.empty() || std::abs(levels.back() - now) > 1e-3)) levels.push_back(now);
  }
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_NEAR(levels[0], 0.6, 1e-6);
  EXPECT_NEAR(levels[1], 1.0, 1e-6) << "the middle of the slider, in steps of 50 N/m";
  EXPECT_NEAR(levels[2], 0.6, 1e-6);
  const Said again = pliant({"run", "plate.obj", "--replay", "p.rec", "--out", "again", "--frames", "0"});
  EXPECT_NE(again.err.find("holds 2 changes"), std::string::npos) << again.err;
}

TEST_F(WindowTest, TheMouseTakesAnotherProbeAndItsPathIsAScript) {
  write_text(folder / "hold.csv", "time_s,x,y,z\n0,0.03,0.02,0\n90,0.03,0.02,0\n");
  const Said said = shown({"plate.obj", "--probe", "a=mouse", "--probe", "b=script:hold.csv"},
                          "0.0,key,Tab\n0.0,move,120 80\n0.3,key,M\n0.6,move,121 81\n0.7,press,\n1.5,release,\n"
                          "1.6,key,Tab\n1.6,key,L\n1.7,click,Levels/Record\n3.0,click,Levels/Record\n4.0,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_GT(probe("b")["contact_ticks"], 100);
  EXPECT_GT(probe("b")["max_force_N"], 0.05);
  EXPECT_EQ(probe("a")["contact_ticks"], 0);
  const auto path = load_script(folder / "out" / "path-001.csv");
  ASSERT_TRUE(path.ok()) << path.error().message();
  EXPECT_GT(path->rows.back().time, 0.5);
  expect_no_force_at_the_end();
}

TEST_F(WindowTest, TheSameLevelAnewIsWrittenBesideWhatWasWrittenOfIt) {
  for (const std::string close : {"9.0", "40.0"}) {  // on a slow machine it is still loading when the first one closes
    for (const char* old : {"out", "out-2", "out-3", "p.rec", "p-2.rec", "p-3.rec"}) fs::remove_all(folder / old);
    const std::string second = std::to_string(std::stod(close) / 2);
    const Said said =
        shown({"plate.obj", "--record", "p.rec"}, "0.5,key,R\n" + second + ",key,R\n" + close + ",close,\n");
    ASSERT_EQ(said.status, 0) << said.err;
    if (fs::exists(folder / "out-3")) break;
  }
  for (const char* file : {"out/report.json", "out-2/report.json", "out-3/report.json", "p.rec", "p-2.rec", "p-3.rec"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
}

TEST_F(WindowTest, AFailureBeforeTheFirstTickLeavesTheEarlierRecordingAndNothingElse) {
  ASSERT_EQ(pliant({"run", "plate.obj", "--probe", "p=orbit", "--seconds", "0.2", "--frames", "0", "--record", "p.rec",
                    "--out", "first"})
                .status,
            0);
  const std::string recorded = read_text(folder / "p.rec");
  fs::create_directory(folder / "no-shaders");
  const std::string before = std::string(kDriversLeak) + "PLIANT_SHADERS=" + quoted((folder / "no-shaders").string()) +
                             " timeout 60 xvfb-run -a -s '-screen 0 400x300x24' bash -c '\"$@\"; echo $? >status' -";
  // The command's own status: xvfb-run's differs if its cleanup fails.
  const auto expect_failure = [&](const std::vector<std::string>& arguments) {
    fs::remove(folder / "status");
    const Said said = pliant(arguments, before);
    EXPECT_EQ(read_text(folder / "status"), "1\n") << said.err;
  };
  expect_failure({"run", "plate.obj", "--window", "--record", "p.rec", "--force", "--out", "out"});
  EXPECT_EQ(read_text(folder / "p.rec"), recorded);
  expect_failure({"run", "plate.obj", "--window", "--record", "new.rec", "--out", "out"});
  EXPECT_FALSE(fs::exists(folder / "new.rec"));
  EXPECT_FALSE(fs::exists(folder / "out"));
  for (const auto& entry : fs::directory_iterator(folder))
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
}

TEST_F(WindowTest, ARecordingWithAPauseReplaysToTheSameHash) {
  write_text(folder / "press.csv", press_csv(0.002));
  const Said said = shown({"plate.obj", "--probe", "tip=script:press.csv", "--field", "cpu", "--record", "p.rec"},
                          "0.6,key,Space\n0.9,key,Space\n2.5,close,\n");
  ASSERT_EQ(said.status, 0) << said.err;
  ASSERT_EQ(pliant({"run", "plate.obj", "--replay", "p.rec", "--frames", "0", "--out", "again"}).status, 0);
  EXPECT_GT(probe("tip")["contact_ticks"], 100);
  EXPECT_EQ(report("again")["hash"], report("out")["hash"]);
  EXPECT_EQ(report("again")["ticks"], report("out")["ticks"]);
}

TEST_F(WindowTest, ALostDisplayEndsTheRunLikeAnyOtherError) {
  if (!there("Xvfb")) GTEST_SKIP() << "Xvfb is missing; install xvfb";
  write_text(folder / "lose.sh",
             "cd " + quoted(folder.string()) +
                 "\nXvfb -displayfd 3 -screen 0 400x300x24 3>number 2>/dev/null &\nserver=$!\n"
                 "for i in $(seq 300); do [ -s number ] && break; sleep 0.1; done\n"
                 "export DISPLAY=:$(cat number)\n" +
                 quoted(PLIANT_BINARY) +
                 " run plate.obj --window --probe p=orbit --record p.rec --out out --size 240x160 &\npid=$!\n"
                 "until [ -s out/.partial-$pid/forces.csv ]; do kill -0 $pid || break; sleep 0.02; done\n"
                 "kill -9 $server\nwait $pid\n");
  const std::string line = std::string("env -u WAYLAND_DISPLAY ") + kDriversLeak + "timeout 100 bash " +
                           quoted((folder / "lose.sh").string()) + " >" + quoted((folder / "said").string()) + " 2>&1";
  const int status = std::system(line.c_str());
  const std::string said = read_text(folder / "said");
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 1) << said;
  EXPECT_NE(said.find("pliant: error: display: "), std::string::npos) << said;
  ASSERT_TRUE(fs::exists(folder / "out" / "report.json")) << said;
  EXPECT_NE(report("out")["ended"].get<std::string>().find("display"), std::string::npos) << report("out")["ended"];
  EXPECT_GT(report("out")["ticks"], 0);
  EXPECT_EQ(read_text(folder / "out" / "forces.png").substr(1, 3), "PNG");
  EXPECT_TRUE(fs::exists(folder / "p.rec"));
  expect_no_force_at_the_end();
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
}

TEST_F(WindowTest, EventsOfTheDisplayItselfMoveAndCloseIt) {
  if (!there("xdotool")) GTEST_SKIP() << "xdotool is missing; install it to try the window with real events";
  write_text(folder / "hand.sh", "cd " + quoted(folder.string()) + "\n" + quoted(PLIANT_BINARY) +
                                     " run plate.obj --window --out out --size 240x160 &\n"
                                     "id=$(timeout 40 xdotool search --sync --onlyvisible --class pliant | tail -n 1)\n"
                                     "xdotool mousemove --window $id 200 100; sleep 0.3; xdotool mousemove --window "
                                     "$id 120 80; xdotool key Tab; sleep 1\n"
                                     "xdotool mousedown 1; sleep 2; xdotool mouseup 1; sleep 0.2\n"
                                     "kill -TERM $!; wait $!\n");
  const std::string line = std::string("env -u WAYLAND_DISPLAY ") + kDriversLeak +
                           "timeout 60 xvfb-run -a -s '-screen 0 400x300x24' sh " +
                           quoted((folder / "hand.sh").string()) + " >" + quoted((folder / "said").string()) + " 2>&1";
  ASSERT_EQ(std::system(line.c_str()), 0) << read_text(folder / "said");
  EXPECT_GT(probe("mouse")["contact_ticks"], 50);
  expect_no_force_at_the_end();
}

TEST_F(WindowTest, EventsThatMakeNoSenseAreRefusedWithTheirLine) {
  for (const char* wrong : {"0.1,jump,3\n", "0.1,move,3\n", "x,move,3 4\n", "0.1,key,Q9\n", "1,close,\n0,close,\n",
                            "0.1\n", "0.1,drop,\n", "0,press,middle twice\n", "inf,close,\n"}) {
    const Said said = shown({"plate.obj"}, wrong);
    EXPECT_EQ(said.status, 1) << wrong;
    EXPECT_NE(said.err.find("events.csv:"), std::string::npos) << wrong << said.err;
  }
}

}  // namespace
}  // namespace pliant::testing
