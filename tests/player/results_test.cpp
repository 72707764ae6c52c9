// Folders of results, and what they may replace: only files of an earlier run, and only on request.
#include <array>

#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class Results : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_text(folder / "plate.obj", plate_obj());
  }
  Said run(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"run", "plate.obj", "--probe", "p=orbit", "--seconds", "0.1", "--frames", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return pliant(arguments);
  }
  std::size_t files_in(const std::string& out) const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / out)) ++count;
    return count;
  }
};

TEST_F(Results, ASecondRunGoesBesideTheFirstAndSaysWhere) {
  for (const std::string out : {"out/plate", "given"}) {
    const auto again = [&](const std::string& rate) {
      return out == "given" ? run({"--rate", rate, "--out", "given/"}) : run({"--rate", rate});
    };
    ASSERT_EQ(again("1000").status, 0);
    const std::string first = read_text(folder / out / "report.json");
    const Said second = again("500"), third = again("250");
    ASSERT_EQ(second.status, 0) << second.err;
    ASSERT_EQ(third.status, 0) << third.err;
    EXPECT_EQ(read_text(folder / out / "report.json"), first) << "overwritten";
    EXPECT_EQ(report(out + "-2")["rate_hz"], 500.0);
    EXPECT_EQ(report(out + "-3")["rate_hz"], 250.0);
    EXPECT_NE(second.out.find("\n" + out + "-2: "), std::string::npos) << second.out;
    EXPECT_NE(second.out.find("--force"), std::string::npos) << second.out;
  }
}

TEST_F(Results, ForceReplacesWhatARunWroteAndNothingElse) {
  ASSERT_EQ(run({"--out", "out", "--rate", "500"}).status, 0);
  write_text(folder / "out" / "frame-of-mind.png", "mine");
  write_text(folder / "out" / "notes.txt", "mine");
  const std::size_t before = files_in("out");
  const Said said = run({"--out", "out", "--force"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(report("out")["rate_hz"], 1000.0);
  EXPECT_EQ(files_in("out"), before);
  EXPECT_EQ(read_text(folder / "out" / "frame-of-mind.png"), "mine");
  EXPECT_EQ(read_text(folder / "out" / "notes.txt"), "mine");
  EXPECT_FALSE(fs::exists(folder / "out-2"));
}

TEST_F(Results, AForeignFileIsNeverReplaced) {
  for (const std::string name : {"report.json", "forces.png", "frame-0000.png", "frame-of-mind.png", ".pliant-run"}) {
    fs::remove_all(folder / "out");
    fs::remove_all(folder / "out-2");
    fs::create_directory(folder / "out");
    write_text(folder / "out" / name, "mine");
    ASSERT_EQ(run({"--out", "out"}).status, 0) << name;
    EXPECT_EQ(read_text(folder / "out" / name), "mine");
    const bool harmless = name == "frame-of-mind.png";
    EXPECT_EQ(files_in("out"), harmless ? 5u : 1u) << name;
    EXPECT_EQ(fs::exists(folder / "out-2" / "report.json"), !harmless) << name;
    if (!harmless)
      expect_refused({"run", "plate.obj", "--probe", "p=orbit", "--frames", "0", "--out", "out", "--force"}, 1, name);
    EXPECT_EQ(read_text(folder / "out" / name), "mine");
  }
}

TEST_F(Results, AListThatNamesOtherFoldersReachesNone) {
  ASSERT_EQ(run({"--out", "out"}).status, 0);
  write_text(folder / "precious", "mine");
  std::ofstream(folder / "out" / ".pliant-run", std::ios::app) << "../precious\n..\n.\n"
                                                               << (folder / "precious").string() << '\n';
  ASSERT_EQ(run({"--out", "out", "--force"}).status, 0);
  EXPECT_EQ(read_text(folder / "precious"), "mine");
}

TEST_F(Results, TwoRunsAtOnceKeepApart) {
  const std::string begin = "cd " + quoted(folder.string()) + " && { env -u DISPLAY " + quoted(PLIANT_BINARY) +
                            " run plate.obj --probe p=orbit --frames 0 --seconds ";
  const std::string line = begin + "600 --realtime --out out >.said 2>&1 & } && pid=$! && " +
                           "while kill -0 $pid && [ ! -e out/.partial-$pid/forces.csv ]; do :; done && " +
                           begin.substr(begin.find("env")) +
                           "0.1 --out out >.said2 2>&1 && kill -TERM $pid && wait $pid";
  EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 0) << read_text(folder / ".said") << read_text(folder / ".said2");
  EXPECT_EQ(report("out-2")["ticks"], 100);
  EXPECT_EQ(report("out")["mode"], "realtime");
}

TEST_F(Results, RunsThatBeginTogetherEachGetAFolder) {
  std::string line = "cd " + quoted(folder.string()) + "; pids=";
  for (int i = 0; i < 6; ++i)
    line += "; env -u DISPLAY -u WAYLAND_DISPLAY " + quoted(PLIANT_BINARY) +
            " run plate.obj --probe p=orbit --frames 0 --seconds 0.1 --out fresh/x >.said" + std::to_string(i) +
            " 2>&1 & pids=\"$pids $!\"";
  line += "; all=0; for pid in $pids; do wait $pid || all=1; done; exit $all";
  const int status = std::system(line.c_str());
  std::string said;
  for (int i = 0; i < 6; ++i) said += read_text(folder / (".said" + std::to_string(i)));
  EXPECT_EQ(WEXITSTATUS(status), 0) << said;
  for (const char* name : {"x", "x-2", "x-3", "x-4", "x-5", "x-6"})
    EXPECT_TRUE(fs::exists(folder / "fresh" / name / "report.json")) << name << '\n' << said;
}

TEST_F(Results, AFolderInThePlaceOfAResultIsNotReplaced) {
  ASSERT_EQ(run({"--out", "out"}).status, 0);
  fs::remove(folder / "out" / "forces.png");
  fs::create_directory(folder / "out" / "forces.png");
  const std::string report = read_text(folder / "out" / "report.json");
  expect_refused({"run", "plate.obj", "--probe", "p=orbit", "--frames", "0", "--out", "out", "--force"}, 1,
                 "out/forces.png");
  EXPECT_EQ(read_text(folder / "out" / "report.json"), report);
}

TEST_F(Results, AFolderBehindALinkIsTheOneThatTheSystemMeans) {
  fs::create_directories(folder / "a" / "b");
  fs::create_directory_symlink("a/b", folder / "ab");
  ASSERT_EQ(run({"--out", "ab/../sy"}).status, 0);
  EXPECT_TRUE(fs::exists(folder / "a" / "sy" / "report.json"));
  EXPECT_FALSE(fs::exists(folder / "sy"));
  fs::create_directory_symlink("a", folder / "link");
  const Said first = run({"--out", "link"}), second = run({"--out", "link"});
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_TRUE(fs::exists(folder / "a" / "report.json")) << first.out;
  EXPECT_TRUE(fs::exists(folder / "link-2" / "report.json")) << "as it says: " << second.out;
}

TEST_F(Results, WhatIsNoFileIsNoPlaceForARecordingAndNoneIsReadFromIt) {
  ASSERT_EQ(std::system(("mkfifo " + quoted((folder / "pipe").string())).c_str()), 0);
  expect_refused({"run", "plate.obj", "--probe", "p=orbit", "--record", "pipe", "--force", "--out", "b"}, 1, "pipe");
  expect_refused({"run", "plate.obj", "--replay", "pipe", "--out", "b"}, 1, "pipe");
}

TEST_F(Results, ARecordingIsReplacedByForceOnlyAndOnlyIfItIsOne) {
  ASSERT_EQ(run({"--record", "p.rec", "--out", "a"}).status, 0);
  const std::string first = read_text(folder / "p.rec");
  expect_refused({"run", "plate.obj", "--probe", "p=orbit", "--record", "p.rec", "--out", "b"}, 1, "p.rec");
  EXPECT_EQ(read_text(folder / "p.rec"), first);
  ASSERT_EQ(run({"--record", "p.rec", "--out", "b", "--force", "--rate", "500"}).status, 0);
  EXPECT_NE(read_text(folder / "p.rec"), first);
  expect_refused({"run", "plate.obj", "--probe", "p=orbit", "--record", "plate.obj", "--out", "c", "--force"}, 1,
                 "plate.obj");
  EXPECT_EQ(read_text(folder / "plate.obj"), plate_obj());
}

TEST_F(Results, ConvertReplacesByForceOnly) {
  const std::string sky = std::string(PLIANT_SOURCE_DIR) + "/content/environments/sky.exr";
  for (const auto& [in, out] :
       std::vector<std::array<std::string, 2>>{{"plate.obj", "a.glb"}, {"plate.obj", "b.gltf"}, {sky, "d.png"}}) {
    const std::string& there = out;
    write_text(folder / there, "mine");
    expect_refused({"convert", in, out}, 1, there);
    EXPECT_EQ(read_text(folder / there), "mine");
    ASSERT_EQ(pliant({"convert", in, out, "--force"}).status, 0) << out;
    EXPECT_NE(read_text(folder / there), "mine") << out;
  }
  // A .bin belongs to its own .gltf only.
  write_text(folder / "c.bin", "mine");
  for (const bool force : {false, true}) {
    std::vector<std::string> convert{"convert", "plate.obj", "c.gltf"};
    if (force) convert.push_back("--force");
    expect_refused(convert, 1, "c.bin");
    EXPECT_EQ(read_text(folder / "c.bin"), "mine");
  }
  ASSERT_EQ(pliant({"convert", "plate.obj", "e.gltf"}).status, 0);
  write_text(folder / "e.bin", "damaged");
  ASSERT_EQ(pliant({"convert", "plate.obj", "e.gltf", "--force"}).status, 0);
  EXPECT_NE(read_text(folder / "e.bin"), "damaged");
}

}  // namespace
}  // namespace pliant::testing
