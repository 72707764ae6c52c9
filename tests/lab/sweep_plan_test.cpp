// pliant sweep: expansion of a plan, rejected plans, and the inputs of a run's id.
#include <cmath>
#include <set>

#include "lab/sweep/plan.h"
#include "lab/sweep/run_id.h"
#include "player/verbs/command_line.h"
#include "tests/lab/sweep_command.h"

namespace pliant::testing {
namespace {

TEST_F(Sweep, ListsRangesAndLogRangesAreExpandedWithBothEnds) {
  EXPECT_EQ(texts(R"("axes": {"*.deformable.stiffness": [300.0, 100, 2.5e2]})"),
            (std::vector<std::string>{"300", "100", "250"}));
  EXPECT_EQ(texts(R"("axes": {"*.deformable.reach": {"from": 0.01, "to": 0.03, "steps": 5}})"),
            (std::vector<std::string>{"0.01", "0.015", "0.02", "0.025", "0.03"}));
  EXPECT_EQ(texts(R"("axes": {"*.deformable.stiffness": {"from": 1, "to": 10000, "steps": 5, "log": true}})"),
            (std::vector<std::string>{"1", "10", "100", "1000", "10000"}));
  EXPECT_EQ(texts(R"("axes": {"--rate": [500, 1000]})"), (std::vector<std::string>{"500", "1000"}));
}

TEST_F(Sweep, TheFirstAxisChangesSlowestAndTheSampleFastest) {
  write_plan(R"("axes": {"*.deformable.stiffness": [1, 2], "--rate": [500, 1000]},
                "latin_hypercube": {"runs": 3, "seed": 1, "axes": {"*.deformable.reach": {"from": 0.01, "to": 0.02}}})");
  const ExpandedPlan all = expanded();
  ASSERT_EQ(all.runs.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(text_of(all.runs[i].values[0]), i < 6 ? "1" : "2") << i;
    EXPECT_EQ(text_of(all.runs[i].values[1]), i / 3 % 2 == 0 ? "500" : "1000") << i;
    EXPECT_EQ(all.runs[i].values[2], all.runs[i % 3].values[2]) << i;
  }
}

TEST_F(Sweep, EverySampledAxisHasOneValueInEachEqualPartOfItsRange) {
  constexpr std::size_t kRuns = 40;
  const std::string cube =
      R"("latin_hypercube": {"runs": 40, "seed": SEED, "axes": {"*.deformable.stiffness": {"from": 10, "to": 1000, "log": true}, "*.deformable.reach": {"from": 0.01, "to": 0.03}}})";
  const auto seeded = [&](const std::string& seed) {
    std::string text = cube;
    return text.replace(text.find("SEED"), 4, seed);
  };
  write_plan(seeded("7"));
  const ExpandedPlan all = expanded();
  ASSERT_EQ(all.runs.size(), kRuns);
  std::set<long> stiffness, reach;
  double together = 0.0;
  for (const SweepRun& run : all.runs) {
    const double a = std::log10(run.values[0].get<double>() / 10.0) / 2.0,
                 b = (run.values[1].get<double>() - 0.01) / 0.02;
    stiffness.insert(std::lround(std::floor(a * kRuns)));
    reach.insert(std::lround(std::floor(b * kRuns)));
    together += (a - 0.5) * (b - 0.5);
  }
  EXPECT_EQ(stiffness.size(), kRuns);
  EXPECT_EQ(reach.size(), kRuns);
  EXPECT_EQ(*stiffness.begin(), 0);
  EXPECT_EQ(*stiffness.rbegin(), long{kRuns} - 1);
  EXPECT_LT(std::abs(together / kRuns), 0.5 / 12.0) << "the axes rise and fall together";
  const auto before = ids();
  write_plan(seeded("7"));
  EXPECT_EQ(ids(), before) << "the same seed";
  write_plan(seeded("8"));
  std::size_t shared = 0;
  for (const std::string& id : ids()) shared += before.count(id);
  EXPECT_EQ(shared, 0u) << "another seed";
}

TEST_F(Sweep, AnIdDoesNotDependOnTheOrderOfKeysNorOnTheNameOfThePlan) {
  write_text(folder / "a.json", R"({"level": "plate.obj", "options": {"seconds": 0.05, "rate": 500},
      "axes": {"*.deformable.stiffness": [100, 200], "*.deformable.reach": [0.01, 0.02]},
      "latin_hypercube": {"seed": 3, "runs": 2, "axes": {"*.deformable.damping_ratio": {"from": 1, "to": 2}, "--max-force": {"from": 1, "to": 2}}}})");
  write_text(
      folder / "b.json",
      R"({"latin_hypercube": {"axes": {"--max-force": {"to": 2, "from": 1.0}, "*.deformable.damping_ratio": {"from": 1, "to": 2}}, "runs": 2, "seed": 3},
      "axes": {"*.deformable.reach": [0.02, 0.01], "*.deformable.stiffness": [200.0, 1e2]},
      "options": {"rate": 5e2, "seconds": 0.05, "threads": 3}, "timeout_s": 100, "about": "the same runs", "level": "plate.obj"})");
  EXPECT_EQ(ids("a.json"), ids("b.json"));
  EXPECT_EQ(ids("a.json").size(), 8u);
}

TEST_F(Sweep, AnIdChangesWithAValueAnOptionTheLevelAndTheFilesItNames) {
  write_plan(R"("axes": {"*.deformable.stiffness": [100]})");
  std::set<std::string> seen = ids();
  const auto expect_new = [&](const char* what) { EXPECT_TRUE(seen.insert(*ids().begin()).second) << what; };
  write_plan(R"("axes": {"*.deformable.stiffness": [101]})");
  expect_new("value");
  write_plan(R"("axes": {"*.deformable.settling_time": [100]})");
  expect_new("key");
  write_text(folder / "plan.json",
             R"({"level": "plate.obj", "options": {"seconds": 0.06}, "axes": {"*.deformable.stiffness": [100]}})");
  expect_new("option");
  write_plan(R"("axes": {"*.deformable.stiffness": [100]})");
  write_text(folder / "press.csv", "time_s,x,y,z\n0,0,0.002,0\n0.02,0,-0.005,0\n");
  expect_new("script of a probe");
  write_text(folder / "plate.obj", plate_obj(7));
  expect_new("mesh");
  // A script named by the level itself.
  for (const char* name : {"minimal.gltf", "minimal.bin", "minimal.csv"})
    fs::copy(fs::path(PLIANT_SOURCE_DIR) / "content" / "levels" / name, folder / name);
  write_text(folder / "plan.json", R"({"level": "minimal.gltf", "axes": {"sheet.deformable.stiffness": [100]}})");
  expect_new("level");
  write_text(folder / "minimal.csv", "time_s,x,y,z\n0,0,0.01,0\n1,0,-0.01,0\n");
  expect_new("script of the level");
  // Its error budget, and the keys open to it. A key that the level sets is not open, even at its default value.
  std::string level = read_text(folder / "minimal.gltf");
  const std::string key = "\"PLIANT_deformable\": {";
  const auto add_key = [&](const std::string& text) {
    ASSERT_NE(level.find(key), std::string::npos);
    level.insert(level.find(key) + key.size(), text);
    write_text(folder / "minimal.gltf", level);
  };
  add_key("\"error\": 0.5, ");
  expect_new("error budget of the level");
  add_key("\"distance\": \"chord\", ");
  expect_new("a key that is said at its default");
  // A file named only by the plan's settings.
  write_text(folder / "other.csv", "time_s,x,y,z\n0,0,0.01,0\n");
  const std::string set = R"({"level": "minimal.gltf", "options": {"set": ["tip.haptic_device.file=other.csv"]},
                              "axes": {"sheet.deformable.stiffness": [100]}})";
  write_text(folder / "plan.json", set);
  expect_new("setting");
  write_text(folder / "other.csv", "time_s,x,y,z\n0,0,0.02,0\n");
  expect_new("file that a setting names");
  write_text(folder / "plan.json", R"({"level": "minimal.gltf", "axes": {"tip.haptic_device.file": ["other.csv"]}})");
  expect_new("file that an axis names");
  write_text(folder / "other.csv", "time_s,x,y,z\n0,0,0.03,0\n");
  expect_new("what is in it");
}

TEST_F(Sweep, AnIdGoesByWhatIsInAFileAndNotByWhereItLies) {
  write_plan(R"("axes": {"*.deformable.stiffness": [100]})");
  const auto before = ids();
  fs::create_directories(folder / "far");
  fs::rename(folder / "press.csv", folder / "far" / "p.csv");
  for (const std::string& path : {std::string("far/p.csv"), (folder / "far" / "p.csv").string()}) {
    write_text(folder / "plan.json", R"({"level": "plate.obj", "options": {"seconds": 0.05, "probe": ["tip=script:)" +
                                         path + R"("]}, "axes": {"*.deformable.stiffness": [100]}})");
    EXPECT_EQ(ids(), before) << path;
  }
}

TEST_F(Sweep, ASimulatedHandOfAPlanIsHeldByAHandAndItsScriptIsFoundFromThePlan) {
  // From another folder, whose name contains the separators of a hand's words.
  const fs::path there = folder / "k=300, soft|stiff";
  fs::create_directories(there);
  for (const char* name : {"plate.obj", "press.csv"}) fs::rename(folder / name, there / name);
  const std::string plan = R"({"level": "plate.obj", "options": {"seconds": 0.05, "probe": ["tip=hand:press.csv"]},
                               "axes": {"*.deformable.stiffness": [250]}})";
  write_text(there / "plan.json", plan);
  const Said said = pliant({"sweep", (there / "plan.json").string(), "--out", "out"}, kNoRank);
  ASSERT_EQ(said.status, 0) << said.err;
  ASSERT_EQ(lines().size(), 1u);
  ASSERT_EQ(lines()[0]["status"], "done") << lines()[0];
  const Said alone = pliant({"run", "plate.obj", "--probe", "tip=hand:press.csv", "--seconds", "0.05", "--frames", "0",
                             "--set", "*.deformable.stiffness=250", "--out", (folder / "alone").string()},
                            "-C " + quoted(there.string()));
  ASSERT_EQ(alone.status, 0) << alone.err;
  EXPECT_EQ(report("alone")["probes"][0]["source"].get<std::string>().substr(0, 5), "hand:");
  EXPECT_EQ(lines()[0]["figures"]["hash"], report("alone")["hash"]);
  // Its script and its hand options count.
  const auto id_of = [&] { return expanded(fs::relative(there / "plan.json", folder)).runs[0].id; };
  std::set<std::string> seen{id_of()};
  write_text(there / "press.csv", "time_s,x,y,z\n0,0,0.002,0\n0.02,0,-0.005,0\n");
  EXPECT_TRUE(seen.insert(id_of()).second);
  std::string other = plan;
  write_text(there / "plan.json", other.replace(other.find("hand:"), 5, "hand:hand=firm, "));
  const auto with_words = read_plan(there / "plan.json", check_run_arguments);
  ASSERT_TRUE(with_words);
  const ArgumentFile file = file_in(*with_words, "--probe=tip=hand:hand=firm, press.csv|delay=5ms");
  EXPECT_EQ(file.path, there / "press.csv");
  EXPECT_EQ(file.size, std::string("press.csv").size());
}

TEST_F(Sweep, APlanThatMakesNoSenseIsRefusedWithItsPlace) {
  const auto refused = [&](const std::string& text, const std::string& word) {
    write_text(folder / "plan.json", text);
    expect_refused({"sweep", "plan.json", "--out", "out"}, 1, word);
  };
  const auto bad = [&](const std::string& rest, const std::string& word) {
    refused(R"({"level": "plate.obj", )" + rest + "}", word);
  };
  refused("{\"level\": \"plate.obj\",\n \"axes\": {,}}", "is no JSON at line 2");
  refused("[]", "is no JSON object");
  refused("{}", "has no \"level\"");
  refused(R"({"level": 3, "axes": {}})", "/level: must be a text");
  refused(R"({"level": "nowhere.glb", "axes": {}})", "/level");
  bad(R"("axis": {})", "unknown key 'axis'");
  bad(R"("axes": {})", "varies nothing");
  bad(R"("axes": {"a.b.c": [1], "a.b.c": [2]})", "twice");
  bad(R"("axes": {"*.deformable.stiffness": []})", "/axes/*.deformable.stiffness: is an empty list");
  bad(R"("axes": {"*.deformable.stiffness": [1, 1.0]})", "/axes/*.deformable.stiffness/1: the value 1.0 stands twice");
  bad(R"("axes": {"*.deformable.stiffness": [null]})", "/axes/*.deformable.stiffness/0");
  bad(R"("axes": {"*.deformable.stiffness": 3})", "must be a list of values");
  bad(R"("axes": {"*.deformable.stiffness": [100, -3]})", "/axes/*.deformable.stiffness/1");
  bad(R"("axes": {"*.deformable.stifness": [100]})", "did you mean stiffness");
  bad(R"("axes": {"nobody.deformable.stiffness": [100]})", "nobody");
  bad(R"("axes": {"a/b~c.deformable.stiffness": [100]})", "/axes/a~1b~0c.deformable.stiffness/0");
  bad(R"("axes": {"*.deformable.reach": {"from": 1, "to": 2}})", "has no \"steps\"");
  bad(R"("axes": {"*.deformable.reach": {"from": 2, "to": 1, "steps": 3}})", "must be less");
  bad(R"("axes": {"*.deformable.reach": {"from": 0, "to": 1, "steps": 3, "log": true}})", "above 0");
  bad(R"("axes": {"*.deformable.reach": {"from": 0.01, "to": 1, "steps": 1}})", "/steps: must be a whole number");
  bad(R"("axes": {"*.deformable.reach": {"from": 0.01, "to": 1, "step": 3}})", "did you mean steps");
  bad(R"("axes": {"--seconds": [0.1, -1]})", "/axes/--seconds/1: --seconds");
  bad(R"("axes": {"--secnds": [0.1]})", "did you mean --seconds");
  bad(R"("axes": {"--out": ["a", "b"]})", "the option --out is the sweep's own");
  bad(R"("axes": {"--set": ["a"]})", "is no axis");
  bad(R"("axes": {"--threads": [1, 2]})", "/axes/--threads: is no axis: it changes no result");
  // A value in the name would bypass the list of refused options.
  for (const char* name : {"record=/tmp/x.pose", "out=here", "window=", "", "frames=3"}) {
    bad(std::string(R"("options": {")") + name + R"(": true}, "axes": {"*.deformable.stiffness": [1]})",
        std::string("/options/") + (*name == 'r' ? "record=~1tmp~1x.pose" : name) + ": '--" + name + "' is no name");
    bad(std::string(R"("axes": {"--)") + name + R"(": [true]})", name == std::string() ? "is no name" : "'='");
  }
  bad(R"("axes": {"*.deformable.stiffness=5": [1]})", "has '=' in its name");
  bad(R"("options": {"probe": ["p=device:falcon"]}, "axes": {"--rate": [500]})", "never the same twice");
  bad(R"("axes": {"--seconds": [1e400]})", "plan.json: has a number that no computer's number holds: '1e400'");
  bad(R"("timeout_s": -1e400, "axes": {"--seconds": [1]})", "'-1e400'");
  for (const char* option : {"window", "realtime", "record", "frames", "list", "force", "input", "size", "field"})
    bad(std::string(R"("options": {")") + option + R"(": true}, "axes": {"*.deformable.stiffness": [1]})",
        std::string("/options/") + option + ": the option --" + option);
  bad(R"("options": {"seconds": 1}, "axes": {"--seconds": [1, 2]})", "stands in /options too");
  bad(R"("options": {"set": "a.b.c=1"}, "axes": {"--rate": [500]})", "/options/set: must be a list");
  bad(R"("options": {"set": ["nobody.deformable.stiffness=1"]}, "axes": {"--rate": [500]})", "nobody");
  bad(R"("options": {"probe": ["p=mouse"]}, "axes": {"--rate": [500]})", "window");
  bad(R"("options": {"probe": ["p=script:nowhere.csv"]}, "axes": {"--rate": [500]})", "nowhere.csv");
  bad(R"("timeout_s": 0, "axes": {"--rate": [500]})", "/timeout_s");
  const std::string range = R"({"from": 0.01, "to": 0.02, "steps": 1000})";
  bad(R"("axes": {"*.deformable.reach": )" + range + R"(, "--seconds": )" + range + "}",
      "/axes/--seconds: makes more than 100000 runs");
  bad(R"("latin_hypercube": {"seed": 1, "axes": {}})", "/latin_hypercube: has no \"runs\"");
  bad(R"("latin_hypercube": {"runs": 4, "seed": 1, "axes": {"--rate": {"from": 1}}})",
      "/latin_hypercube/axes/--rate: has no \"to\"");
  expect_refused({"sweep"}, 2, "docs/sweep.md");
  expect_refused({"sweep", "nowhere.json"}, 1, "nowhere.json");
  write_plan(kTwelve);
  for (const char* shard : {"0/4", "5/4", "2", "a/b", "1/0"})
    expect_refused({"sweep", "plan.json", "--shard", shard}, 2, "--shard: must be I/N");
  expect_refused({"sweep", "merge", "nowhere", "--out", "m"}, 1, "sweep.json");
}

// Plans are counted before anything is created from them.
TEST_F(Sweep, AHostilePlanIsRefusedAtOnceAndInLittleMemory) {
  const auto bad = [&](const std::string& rest, const std::string& word) {
    write_text(folder / "plan.json", R"({"level": "plate.obj", )" + rest + "}");
    const Said said = pliant({"sweep", "plan.json", "--out", "out"}, limited(400000, 3));
    EXPECT_EQ(said.status, 1) << rest.substr(0, 100);
    EXPECT_NE(said.err.find(word), std::string::npos) << said.err.substr(0, 500);
    EXPECT_LT(said.err.size(), 1000u) << "a sentence, not the plan";
  };
  std::string ranges, ones, keys, list = "[";
  for (int i = 0; i < 400; ++i) {
    const std::string name = (i ? ", \"n" : "\"n") + std::to_string(i) + ".deformable.reach\": ";
    ranges += name + R"({"from": 0.01, "to": 0.02, "steps": 100000})";
    ones += name + R"({"from": 0.01, "to": 0.02})";
  }
  for (int i = 0; i < 300000; ++i) {
    keys += (i ? ", \"" : "\"") + std::to_string(i) + "\": 1";
    list += (i ? ", " : "") + std::to_string(i);
  }
  list += "]";
  bad("\"axes\": {" + ranges + "}", "/axes: makes 400 axes, and a plan has at most 64");
  bad(R"("axes": {"--rate": [500, 1000], "a.deformable.reach": {"from": 0.01, "to": 0.02, "steps": 60000}})",
      "/axes/a.deformable.reach: makes more than 100000 runs");
  bad("\"axes\": {\"--seconds\": " + list + "}", "/axes/--seconds: makes more than 100000 runs");
  bad(R"("latin_hypercube": {"runs": 100000, "seed": 1, "axes": {)" + ones + "}}", "makes 400 axes");
  std::string sixty = ones.substr(0, ones.find(", \"n60."));
  bad(R"("latin_hypercube": {"runs": 100000, "seed": 1, "axes": {)" + sixty + "}}",
      "/latin_hypercube: makes 100000 runs of 60 axes, more than 1000000 values");
  bad(R"("axes": {"--rate": [500, 1000]}, "latin_hypercube": {"runs": 60000, "seed": 1, "axes": {"--seconds": {"from": 1, "to": 2}}})",
      "/latin_hypercube: makes more than 100000 runs");
  bad("\"axes\": {" + keys + "}", "has an object with more than 1000 keys");
  bad("\"about\": {" + keys + "}", "has an object with more than 1000 keys");
  bad("\"level_\": " + list, "unknown key 'level_'");
  bad("\"axes\": " + list, "/axes: must be an object of axes; got a long list");
}

TEST_F(Sweep, DryRunAndListSayWhatWouldBeDoneAndWriteNothing) {
  write_plan(kTwelve);
  const std::size_t before = count_files();
  const Said list = sweep({"--list"}), dry = sweep({"--dry-run", "--shard", "2/4"});
  EXPECT_EQ(list.status, 0) << list.err;
  EXPECT_EQ(dry.status, 0) << dry.err;
  EXPECT_EQ(count_files(), before);
  for (const std::string& id : ids()) EXPECT_NE(list.out.find(id + "  to do"), std::string::npos) << id;
  EXPECT_EQ(std::count(dry.out.begin(), dry.out.end(), '\n'), 4) << dry.out;
  // The printed command can be run by a shell.
  const std::string first = dry.out.substr(0, dry.out.find('\n'));
  ASSERT_TRUE(first.starts_with("pliant run ")) << first;
  const std::string line =
      "cd " + quoted(folder.string()) + " && " + quoted(PLIANT_BINARY) + first.substr(6) + " >.o 2>&1";
  EXPECT_EQ(std::system(line.c_str()), 0) << read_text(folder / ".o");
  // Also from a folder without the plan's files.
  fs::create_directories(folder / "far");
  const Said far = pliant({"sweep", "../plan.json", "--dry-run", "--shard", "1/12"}, kNoRank + "-C far");
  const std::string one = far.out.substr(0, far.out.find('\n')), begin = "cd " + folder.string() + " && pliant run ";
  ASSERT_TRUE(one.starts_with(begin)) << one;
  const std::string run = "cd " + quoted((folder / "far").string()) + " && cd " + quoted(folder.string()) + " && " +
                          quoted(PLIANT_BINARY) + " run " + one.substr(begin.size()) + " >.o 2>&1";
  EXPECT_EQ(std::system(run.c_str()), 0) << read_text(folder / ".o");
  EXPECT_TRUE(fs::exists(folder / "far" / "out")) << "results belong where the sweep was asked for";
}

}  // namespace
}  // namespace pliant::testing
