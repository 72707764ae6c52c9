// pliant sweep: what a plan stands for, that every run is done once whatever happens, and that what is merged is the
// same bytes however the runs were shared out.
#include <signal.h>

#include <cmath>
#include <set>

#include "player/sweep/lines.h"
#include "player/sweep/plan.h"
#include "player/sweep/run_id.h"
#include "player/sweep/shard.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

// What goes before a command so that it has no more memory [kB] and processor time [s]; a sanitizer's shadow needs more
// address space than any limit, so that there only time is limited.
std::string limited(int memory, int time) {
#ifdef PLIANT_SANITIZED
  memory = 0;
  time *= 10;
#endif
  return "bash -c 'ulimit " + (memory > 0 ? "-v " + std::to_string(memory) : "") + " -t " + std::to_string(time) +
         "; exec \"$@\"' -";
}

class Sweep : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_text(folder / "plate.obj", plate_obj(6));
    write_text(folder / "press.csv", "time_s,x,y,z\n0,0,0.002,0\n0.02,0,-0.004,0\n0.05,0.004,-0.004,0\n");
  }

  // A plan on the plate, 50 ticks a run, with this for its axes (and more, if need be).
  void write_plan(const std::string& rest, const std::string& name = "plan.json") const {
    write_text(
        folder / name,
        R"({"level": "plate.obj", "options": {"seconds": 0.05, "probe": ["tip=script:press.csv"]}, )" + rest + "}");
  }
  static constexpr const char* kTwelve =
      R"("axes": {"*.deformable.stiffness": [100, 200, 300, 400], "*.deformable.reach": {"from": 0.01, "to": 0.03, "steps": 3}})";

  ExpandedPlan expanded(const std::string& name = "plan.json") const {
    const auto plan = read_plan(folder / name);
    EXPECT_TRUE(plan) << (plan ? "" : plan.error().message());
    const auto all = expand_plan(*plan);
    EXPECT_TRUE(all) << (all ? "" : all.error().message());
    return *all;
  }
  std::set<std::string> ids(const std::string& name = "plan.json") const {
    std::set<std::string> out;
    for (const SweepRun& run : expanded(name).runs) out.insert(run.id);
    return out;
  }
  std::vector<std::string> texts(const std::string& rest) const {
    write_plan(rest);
    std::vector<std::string> out;
    for (const SweepRun& run : expanded().runs) out.push_back(text_of(run.values.front()));
    return out;
  }

  Said sweep(std::vector<std::string> more = {}, const std::string& before = {}) const {
    std::vector<std::string> words{"sweep", "plan.json", "--out", "out"};
    words.insert(words.end(), more.begin(), more.end());
    return pliant(words, kNoRank + before);
  }
  static inline const std::string kNoRank =
      "env -u SLURM_ARRAY_TASK_ID -u SLURM_STEP_ID -u OMPI_COMM_WORLD_RANK -u PMI_RANK -u PMIX_RANK ";

  // Every whole line of every shard.
  std::vector<Json> lines(const std::string& out = "out") const {
    std::vector<Json> all;
    for (const auto& entry : fs::directory_iterator(folder / out)) {
      if (entry.path().extension() != ".jsonl") continue;
      std::istringstream in(read_text(entry.path()));
      for (std::string line; std::getline(in, line);)
        if (Json json = Json::parse(line, nullptr, false); !json.is_discarded()) all.push_back(std::move(json));
    }
    return all;
  }

  // What is to be the same bytes however the runs were shared out.
  std::map<std::string, std::string> merged(const std::vector<std::string>& folders, const std::string& out) const {
    std::vector<std::string> words{"sweep", "merge"};
    words.insert(words.end(), folders.begin(), folders.end());
    for (const char* word : {"--out", out.c_str()}) words.emplace_back(word);
    const Said said = pliant(words);
    EXPECT_EQ(said.status, 0) << said.err;
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder / out))
      if (entry.path().filename() != "timings.csv") files[entry.path().filename()] = read_text(entry.path());
    return files;
  }
  void expect_no_work_left(const std::string& out = "out") const {
    for (const auto& entry : fs::directory_iterator(folder / out))
      EXPECT_FALSE(entry.path().filename().string().starts_with(".work")) << entry.path();
  }
};

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
  // A script that the level itself names.
  for (const char* name : {"minimal.gltf", "minimal.bin", "minimal.csv"})
    fs::copy(fs::path(PLIANT_SOURCE_DIR) / "content" / "levels" / name, folder / name);
  write_text(folder / "plan.json", R"({"level": "minimal.gltf", "axes": {"sheet.deformable.stiffness": [100]}})");
  expect_new("level");
  write_text(folder / "minimal.csv", "time_s,x,y,z\n0,0,0.01,0\n1,0,-0.01,0\n");
  expect_new("script of the level");
  // Its error budget, and which keys that leaves open because the level says nothing of them, be it the default.
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
  // A file that only the plan's settings name.
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
  // From elsewhere, and with what divides a hand's words in the folder's name.
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
  // Its script counts, and what the hand is.
  const auto id_of = [&] { return expanded(fs::relative(there / "plan.json", folder)).runs[0].id; };
  std::set<std::string> seen{id_of()};
  write_text(there / "press.csv", "time_s,x,y,z\n0,0,0.002,0\n0.02,0,-0.005,0\n");
  EXPECT_TRUE(seen.insert(id_of()).second);
  std::string other = plan;
  write_text(there / "plan.json", other.replace(other.find("hand:"), 5, "hand:hand=firm, "));
  const auto with_words = read_plan(there / "plan.json");
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
  // A value in the name would pass by what is refused.
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

// Plans are counted before anything is made of them.
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
  // What it prints is what a shell can run.
  const std::string first = dry.out.substr(0, dry.out.find('\n'));
  ASSERT_TRUE(first.starts_with("pliant run ")) << first;
  const std::string line =
      "cd " + quoted(folder.string()) + " && " + quoted(PLIANT_BINARY) + first.substr(6) + " >.o 2>&1";
  EXPECT_EQ(std::system(line.c_str()), 0) << read_text(folder / ".o");
  // Also from elsewhere, where the plan's files are not.
  fs::create_directories(folder / "far");
  const Said far = pliant({"sweep", "../plan.json", "--dry-run", "--shard", "1/12"}, kNoRank + "-C far");
  const std::string one = far.out.substr(0, far.out.find('\n')), begin = "cd " + folder.string() + " && pliant run ";
  ASSERT_TRUE(one.starts_with(begin)) << one;
  const std::string run = "cd " + quoted((folder / "far").string()) + " && cd " + quoted(folder.string()) + " && " +
                          quoted(PLIANT_BINARY) + " run " + one.substr(begin.size()) + " >.o 2>&1";
  EXPECT_EQ(std::system(run.c_str()), 0) << read_text(folder / ".o");
  EXPECT_TRUE(fs::exists(folder / "far" / "out")) << "results belong where the sweep was asked for";
}

TEST_F(Sweep, ALineHasTheFiguresThatTheRunItselfReports) {
  write_plan(R"("axes": {"*.deformable.stiffness": [250]})");
  ASSERT_EQ(sweep().status, 0);
  const auto all = lines();
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(pliant({"run", "plate.obj", "--probe", "tip=script:press.csv", "--seconds", "0.05", "--frames", "0",
                    "--set", "*.deformable.stiffness=250", "--out", "alone"})
                .status,
            0);
  const Json whole = report("alone"), &figures = all[0]["figures"];
  EXPECT_EQ(figures["hash"], whole["hash"]);
  EXPECT_EQ(figures["ticks"], 50);
  EXPECT_EQ(figures["tip.max_depth_m"], whole["probes"][0]["max_depth_m"]);
  EXPECT_GT(figures["tip.max_force_N"].get<double>(), 0.1);
  EXPECT_EQ(figures["tip.contact_ticks"], whole["probes"][0]["contact_ticks"]);
  double squares = 0.0;
  const ForcesTable table = read_forces(folder / "alone" / "forces.csv");
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    for (const char* axis : {"fx", "fy", "fz"}) squares += std::pow(table.number(row, axis), 2);
  EXPECT_NEAR(figures["tip.rms_force_N"].get<double>(), std::sqrt(squares / static_cast<double>(table.rows.size())),
              1e-8);
  EXPECT_GT(all[0]["timing"]["tick_us_p50"].get<double>(), 0.0);
  EXPECT_EQ(figures.dump().find("_us"), std::string::npos) << "nothing that a clock measured";
}

TEST_F(Sweep, OneProcessAndFourShardsMergeToTheSameBytes) {
  write_plan(kTwelve);
  ASSERT_EQ(sweep().status, 0);
  for (const char* shard : {"1/4", "2/4"})
    ASSERT_EQ(pliant({"sweep", "plan.json", "--out", "four", "--shard", shard}).status, 0);
  for (const char* shard : {"4/4", "3/4"})  // in a folder of their own, as on another machine; two runs at a time
    ASSERT_EQ(pliant({"sweep", "plan.json", "--out", "other", "--shard", shard, "--jobs", "2"}).status, 0);
  EXPECT_EQ(lines("four").size(), 6u);
  EXPECT_EQ(lines("other").size(), 6u);
  const auto one = merged({"out"}, "m1"), four = merged({"other", "four"}, "m4");
  ASSERT_TRUE(one.count("results.csv") && one.count("report.json"));
  for (const char* plot : {"curves-all.deformable.stiffness", "curves-all.deformable.reach",
                           "map-all.deformable.stiffness-all.deformable.reach"}) {
    EXPECT_EQ(one.at(std::string(plot) + ".png").substr(1, 3), "PNG") << plot;
    EXPECT_NE(one.at(std::string(plot) + ".svg").find("<svg"), std::string::npos) << plot;
  }
  EXPECT_EQ(one.size(), four.size());
  for (const auto& [name, bytes] : one) EXPECT_TRUE(four.count(name) && four.at(name) == bytes) << name;
  const Json report = Json::parse(one.at("report.json"));
  EXPECT_EQ(report["runs"], 12);
  EXPECT_EQ(report["done"], 12);
  EXPECT_EQ(report["missing"], 0);
  std::istringstream rows(one.at("results.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_TRUE(row.starts_with("id,*.deformable.stiffness,*.deformable.reach,status,hash,ticks,")) << row;
  for (const SweepRun& run : expanded().runs) {
    ASSERT_TRUE(std::getline(rows, row));
    EXPECT_TRUE(row.starts_with(run.id + "," + text_of(run.values[0]) + "," + text_of(run.values[1]) + ",done,"))
        << row;
  }
  // A stiffer plate pushes harder: the table has what was measured where it belongs.
  EXPECT_LT(report["figures"]["tip.max_force_N"]["min"].get<double>(),
            report["figures"]["tip.max_force_N"]["max"].get<double>() / 2);
  // Merging anew replaces nothing.
  EXPECT_EQ(merged({"out"}, "m1").at("results.csv"), one.at("results.csv"));
  EXPECT_TRUE(fs::exists(folder / "m1-2" / "results.csv"));
  expect_no_work_left();
}

TEST_F(Sweep, ATornLastLineIsLeftBehindAndItsRunDoneAgain) {
  write_plan(kTwelve);
  ASSERT_EQ(sweep().status, 0);
  const auto whole = merged({"out"}, "before");
  const fs::path file = folder / "out" / "runs-1-of-1.jsonl";
  const std::string text = read_text(file);
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
  for (const std::size_t cut : {last + 1, last + 40, text.size() - 1}) {
    write_text(file, text.substr(0, cut));
    const Said said = sweep();
    EXPECT_EQ(said.status, 0) << said.err;
    EXPECT_NE(said.err.find("middle of a line"), std::string::npos) << said.err;
    EXPECT_EQ(lines().size(), 12u) << cut;
    // Without its newline alone a line is whole.
    EXPECT_NE(said.out.find(cut == text.size() - 1 ? "0 done now, 12 before" : "1 done now, 11 before"),
              std::string::npos)
        << said.out;
  }
  const auto after = merged({"out"}, "after");
  for (const auto& [name, bytes] : whole) EXPECT_TRUE(after.at(name) == bytes) << name;
}

TEST_F(Sweep, KilledTwiceItGoesOnAndMergesToTheSameBytes) {
  write_plan(R"("axes": {"*.deformable.stiffness": {"from": 100, "to": 500, "steps": 20}})");
  ASSERT_EQ(pliant({"sweep", "plan.json", "--out", "whole"}).status, 0);
  for (int kill = 1; kill <= 2; ++kill) {  // once it has added some lines
    const std::string wanted = std::to_string(5 * kill);
    write_text(folder / "kill.sh", "cd " + quoted(folder.string()) + "\n" + kNoRank + quoted(PLIANT_BINARY) +
                                       " sweep plan.json --out out >/dev/null 2>&1 &\npid=$!\n"
                                       "until [ \"$(cat out/runs-*.jsonl 2>/dev/null | wc -l)\" -ge " +
                                       wanted +
                                       " ]; do kill -0 $pid 2>/dev/null || break; sleep 0.01; done\n"
                                       "kill -9 $pid; wait $pid 2>/dev/null; true\n");
    ASSERT_EQ(std::system(("bash " + quoted((folder / "kill.sh").string()) + " 2>/dev/null").c_str()), 0);
    EXPECT_GE(lines().size(), 5u * static_cast<std::size_t>(kill));
  }
  ASSERT_EQ(sweep().status, 0);
  EXPECT_EQ(lines().size(), 20u) << "a run that had a line was done again";
  expect_no_work_left();
  const auto whole = merged({"whole"}, "m1"), killed = merged({"out"}, "m2");
  EXPECT_EQ(whole.size(), killed.size());
  for (const auto& [name, bytes] : whole) EXPECT_TRUE(killed.count(name) && killed.at(name) == bytes) << name;
}

TEST_F(Sweep, CtrlCEndsItWithASentenceAndTheSameCommandGoesOn) {
  write_plan(R"("axes": {"*.deformable.stiffness": {"from": 100, "to": 500, "steps": 60}})");
  write_text(folder / "int.sh", "cd " + quoted(folder.string()) + "\n(trap - INT; exec " + kNoRank +
                                    quoted(PLIANT_BINARY) +
                                    " sweep plan.json --out out >/dev/null 2>.said) &\npid=$!\n"
                                    "until [ -s out/runs-1-of-1.jsonl ]; do kill -0 $pid || exit 99; sleep 0.01; done\n"
                                    "kill -INT $pid; wait $pid\n");
  const int status = std::system(("bash " + quoted((folder / "int.sh").string())).c_str());
  const std::size_t begun = lines().size();
  ASSERT_LT(begun, 60u) << "it was too fast to be interrupted";
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_NE(read_text(folder / ".said").find("interrupted; the same command goes on"), std::string::npos);
  expect_no_work_left();
  for (const Json& line : lines()) EXPECT_EQ(line["status"], "done");
  EXPECT_EQ(sweep().status, 0);
  EXPECT_EQ(lines().size(), 60u);
}

TEST_F(Sweep, AFailureIsALineWithItsSentenceAndIsDoneAgainOnlyWhenAsked) {
  // Half of the runs may hold next to nothing in memory; no plan says that beforehand.
  write_plan(R"("axes": {"--limits": [1e-6, 1], "*.deformable.stiffness": [100, 200]})");
  const Said said = sweep();
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.out.find("2 failed now"), std::string::npos) << said.out;
  std::size_t failed = 0;
  for (const Json& line : lines()) {
    if (line["status"] == "done") continue;
    ++failed;
    EXPECT_EQ(line["status"], "failed");
    EXPECT_EQ(line["exit"], 1);
    EXPECT_NE(line["error"].get<std::string>().find("--limits"), std::string::npos) << line["error"];
  }
  EXPECT_EQ(failed, 2u);
  ASSERT_EQ(sweep().status, 0);
  EXPECT_EQ(lines().size(), 4u);
  const Json report = Json::parse(merged({"out"}, "m").at("report.json"));
  EXPECT_EQ(report["done"], 2);
  EXPECT_EQ(report["failed"], 2);
  ASSERT_EQ(report["failures"].size(), 2u);
  EXPECT_NE(report["failures"][0]["error"].get<std::string>().find("--limits"), std::string::npos);
  ASSERT_EQ(sweep({"--retry-failed"}).status, 0);
  EXPECT_EQ(lines().size(), 6u);
}

// Of several failures of one run the latest is told, whatever file it stands in and whatever its words.
TEST_F(Sweep, TheLatestFailureIsTheOneThatIsTold) {
  write_plan(R"("axes": {"--limits": [1e-6], "*.deformable.stiffness": [100]})");
  ASSERT_EQ(sweep().status, 0);
  Json line = lines().at(0);
  EXPECT_FALSE(line.contains("attempt"));
  const fs::path file = folder / "out" / "runs-1-of-1.jsonl";
  line["error"] = "0: an old sentence";  // before all others as text
  write_text(file, line.dump() + "\n");
  ASSERT_EQ(sweep({"--retry-failed", "--shard", "1/2"}).status, 0);
  for (const Json& each : lines())
    if (each != line) EXPECT_EQ(each["attempt"], 2) << each;
  const auto merged_now = merged({"out"}, "m1");
  EXPECT_NE(Json::parse(merged_now.at("report.json"))["failures"][0]["error"].get<std::string>().find("--limits"),
            std::string::npos);
  // In whatever folder and order.
  fs::create_directories(folder / "other");
  fs::rename(file, folder / "other" / "runs-1-of-1.jsonl");
  fs::copy(folder / "out" / "sweep.json", folder / "other" / "sweep.json");
  for (const std::vector<std::string>& folders : {std::vector<std::string>{"out", "other"}, {"other", "out"}})
    EXPECT_EQ(merged(folders, "m" + folders[0]), merged_now);
  // A run that is done goes before any failure.
  Lines all;
  line["status"] = "done";
  line["figures"] = Json::object();
  write_text(folder / "other" / "runs-2-of-2.jsonl", line.dump() + "\n");
  for (const char* each : {"out", "other"}) ASSERT_TRUE(read_lines(folder / each, all));
  EXPECT_TRUE(is_done(all.runs.at(line["id"].get<std::string>())));
}

// Values that differ may mean the same run: which of them stands in a line says nothing.
TEST_F(Sweep, RunsThatAreOneMergeToTheSameBytesWhateverShardDidThem) {
  write_text(folder / "again.csv", read_text(folder / "press.csv"));
  write_text(folder / "plan.json", R"({"level": "plate.obj", "options": {"seconds": 0.05}, "axes": {"--probe":
      ["tip=script:press.csv", "tip=script:again.csv"]}})");
  ASSERT_EQ(ids().size(), 1u);
  for (const char* shard : {"1/2", "2/2"})
    ASSERT_EQ(pliant({"sweep", "plan.json", "--out", shard[0] == '1' ? "one" : "two", "--shard", shard}).status, 0);
  ASSERT_NE(lines("one").at(0)["axes"], lines("two").at(0)["axes"]);
  const auto first = merged({"one"}, "m1"), both = merged({"one", "two"}, "m2"), turned = merged({"two", "one"}, "m3");
  EXPECT_EQ(first, both);
  EXPECT_EQ(first, turned);
  EXPECT_EQ(Json::parse(both.at("report.json"))["disagree"], Json::array());
}

TEST_F(Sweep, ARunThatTakesTooLongIsALineAndIsMendedByARetry) {
  write_plan(R"("timeout_s": 0.001, "axes": {"*.deformable.stiffness": [100, 200]})");  // no process starts so fast
  ASSERT_EQ(sweep().status, 0);
  for (const Json& line : lines()) {
    EXPECT_EQ(line["status"], "timed out");
    EXPECT_NE(line["error"].get<std::string>().find("timeout_s"), std::string::npos);
  }
  EXPECT_EQ(Json::parse(merged({"out"}, "m1").at("report.json"))["timed_out"], 2);
  write_plan(R"("timeout_s": 250, "axes": {"*.deformable.stiffness": [100, 200]})");
  ASSERT_EQ(sweep().status, 0);
  EXPECT_EQ(lines().size(), 2u);
  ASSERT_EQ(sweep({"--retry-failed"}).status, 0);
  const Json report = Json::parse(merged({"out"}, "m2").at("report.json"));
  EXPECT_EQ(report["done"], 2);
  EXPECT_EQ(report["failures"].size(), 0u);
}

TEST_F(Sweep, WhatIsMissingIsNamed) {
  write_plan(kTwelve);
  ASSERT_EQ(sweep({"--shard", "2/3"}).status, 0);
  const Json report = Json::parse(merged({"out"}, "m").at("report.json"));
  EXPECT_EQ(report["done"], 4);
  EXPECT_EQ(report["missing"], 8);
  EXPECT_EQ(report["missing_runs"][0]["axes"]["*.deformable.stiffness"], 100);
}

TEST_F(Sweep, APlanThatGrowsKeepsWhatItHasDone) {
  write_plan(R"("axes": {"*.deformable.stiffness": [100, 200]})");
  ASSERT_EQ(sweep().status, 0);
  write_plan(R"("axes": {"*.deformable.stiffness": [200, 300]})");
  const Said said = sweep();
  EXPECT_NE(said.out.find("1 done now, 1 before"), std::string::npos) << said.out;
  EXPECT_NE(said.err.find("was of another plan"), std::string::npos) << said.err;
  const Json report = Json::parse(merged({"out"}, "m").at("report.json"));
  EXPECT_EQ(report["runs"], 2);
  EXPECT_EQ(report["done"], 2);
  // A file of the user's with that name stays.
  fs::create_directories(folder / "mine");
  write_text(folder / "mine" / "sweep.json", "{\"notes\": 1}");
  expect_refused({"sweep", "plan.json", "--out", "mine"}, 1, "was not written by a sweep");
  EXPECT_EQ(read_text(folder / "mine" / "sweep.json"), "{\"notes\": 1}");
}

TEST_F(Sweep, FoldersOfTwoPlansAreNotMerged) {
  write_plan(R"("axes": {"*.deformable.stiffness": [100]})");
  ASSERT_EQ(sweep().status, 0);
  write_plan(R"("axes": {"*.deformable.stiffness": [200]})");
  ASSERT_EQ(pliant({"sweep", "plan.json", "--out", "other"}).status, 0);
  expect_refused({"sweep", "merge", "out", "other", "--out", "m"}, 1, "another plan");
}

TEST_F(Sweep, ARunWithOtherFiguresThanBeforeIsSaid) {
  write_plan(R"("axes": {"*.deformable.stiffness": [100]})");
  ASSERT_EQ(sweep().status, 0);
  Json line = lines().at(0);
  line["figures"]["hash"] = "0000000000000000";
  write_text(folder / "out" / "runs-1-of-2.jsonl", line.dump() + "\n");
  const Said said = pliant({"sweep", "merge", "out", "--out", "m"});
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("with other figures"), std::string::npos) << said.err;
  EXPECT_EQ(report("m")["disagree"], Json::array({line["id"]}));
}

// What runs said differently by one rounding does not vary, and has no plot whose axis would never end.
TEST_F(Sweep, FiguresThatDifferByRoundingAreConstant) {
  write_plan(R"("axes": {"*.deformable.stiffness": [100, 200, 300]})");
  ASSERT_EQ(sweep().status, 0);
  std::string text;
  double value = 0.1 + 0.2, step = 0.0;
  for (Json line : lines()) {
    line["figures"] = {{"a", value}, {"b", step += 1.0}};
    value = std::nextafter(value, 1.0);
    text += line.dump() + "\n";
  }
  write_text(folder / "out" / "runs-1-of-1.jsonl", text);
  const Said said = pliant({"sweep", "merge", "out", "--out", "m"}, limited(1000000, 20));
  ASSERT_EQ(said.status, 0) << said.err;
  const std::string svg = read_text(folder / "m" / "curves-all.deformable.stiffness.svg");
  EXPECT_LT(svg.size(), 200000u);
  EXPECT_EQ(report("m")["figures"]["a"]["min"], 0.1 + 0.2);
}

TEST_F(Sweep, PlotsOfManySamplesAndAxesAreBoundedAndSaid) {
  std::string axes;
  for (int i = 0; i < 12; ++i)
    axes +=
        std::string(i ? ", " : "") + "\"*.deformable." +
        std::vector<std::string>{
            "stiffness",      "cubic",           "stiffening",      "settling_time",
            "damping_ratio",  "reach",           "friction.static", "friction.sliding",
            "contact_radius", "contact_damping", "relaxation.time", "relaxation.stiffness"}[static_cast<std::size_t>(
            i)] +
        R"(": {"from": 1, "to": 1.5})";
  write_plan(R"("latin_hypercube": {"runs": 6000, "seed": 1, "axes": {)" + axes + "}}");
  const auto plan = read_plan(folder / "plan.json");
  ASSERT_TRUE(plan) << plan.error().message();
  ExpandedPlan all;
  std::string text;
  for (std::size_t i = 0; i < plan->count(); ++i) {
    all.runs.push_back({std::to_string(i), plan->values_of(i), {}});
    const double a = plan->axes[0].values[i].get<double>(), b = plan->axes[1].values[i].get<double>();
    text += Json{{"id", all.runs.back().id},
                 {"status", "done"},
                 {"axes", Json::object()},
                 {"timing", Json::object()},
                 {"figures", {{"sum", a + b}, {"product", a * b}}}}
                .dump() +
            "\n";
  }
  fs::create_directories(folder / "out");
  write_text(folder / "out" / "sweep.json", sweep_json(*plan, all));
  write_text(folder / "out" / "runs-1-of-1.jsonl", text);
  const Said said = pliant({"sweep", "merge", "out", "--out", "m"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("curves are along the first 10 of 12 axes; maps are of the first 10 of 66 pairs of axes; at "
                          "most 2000 of 6000 runs are dots; results.csv has them all"),
            std::string::npos)
      << said.err;
  std::size_t pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder / "m")) {
    if (entry.path().extension() != ".svg") continue;
    ++pictures;
    EXPECT_LT(entry.file_size(), 1000000u) << entry.path();
  }
  EXPECT_EQ(pictures, 20u);
}

TEST_F(Sweep, ASweepWhoseParentIgnoresItsChildrenEnds) {
  write_plan(kTwelve);
  const Said said = sweep({}, "timeout 100 env --ignore-signal=CHLD ");
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.out.find("12 done now"), std::string::npos) << said.out;
}

TEST_F(Sweep, ASweepThatIsKilledTakesItsRunsWithIt) {
  write_text(folder / "plan.json", R"({"level": "plate.obj", "options": {"seconds": 80000, "probe": ["tip=orbit"]},
                                       "axes": {"*.deformable.stiffness": [100, 200]}})");
  write_text(folder / "kill.sh",
             "cd " + quoted(folder.string()) + "\n" + kNoRank + quoted(PLIANT_BINARY) +
                 " sweep plan.json --out out --jobs 2 >/dev/null 2>&1 &\npid=$!\n"
                 "runs() { grep -l -- \"$PWD/out/[.]work\" /proc/[0-9]*/cmdline 2>/dev/null | wc -l; }\n"
                 // The sweep's own children: a run's importer has the command line of its run.
                 "own() { grep -l \"^PPid:.$pid$\" /proc/[0-9]*/status 2>/dev/null | sed s/status$/cmdline/ |\n"
                 "  xargs -r grep -l -- \"$PWD/out/[.]work\" 2>/dev/null | wc -l; }\n"
                 "for i in $(seq 500); do [ $(own) = 2 ] && break; sleep 0.01; done\n"
                 "own >before\nkill -9 $pid\nwait $pid 2>/dev/null\n"
                 "for i in $(seq 500); do [ $(runs) = 0 ] && break; sleep 0.01; done\nruns >after\n");
  ASSERT_EQ(std::system(("bash " + quoted((folder / "kill.sh").string()) + " 2>/dev/null").c_str()), 0);
  EXPECT_EQ(read_text(folder / "before"), "2\n");
  EXPECT_EQ(read_text(folder / "after"), "0\n");
}

TEST_F(Sweep, TheShardIsTakenFromSlurmsArrayOrMpisRankAndSaid) {
  write_plan(kTwelve);
  const Said slurm = sweep({"--list"}, "SLURM_ARRAY_TASK_ID=7 SLURM_ARRAY_TASK_MIN=5 SLURM_ARRAY_TASK_COUNT=4 ");
  EXPECT_NE(slurm.err.find("shard 3 of 4, by SLURM_ARRAY_TASK_ID"), std::string::npos) << slurm.err;
  EXPECT_EQ(slurm.out, sweep({"--list", "--shard", "3/4"}).out);
  EXPECT_NE(slurm.out.find("3 runs in shard 3 of 4"), std::string::npos) << slurm.out;
  const std::string rank = "OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=4 ";
  EXPECT_EQ(sweep({"--list"}, rank).out, sweep({"--list", "--shard", "2/4"}).out);
  const Said said = sweep({"--list", "--shard", "1/1"}, rank);
  EXPECT_EQ(said.out, sweep({"--list"}).out) << "an argument stands above the environment";
  EXPECT_EQ(said.err, "");
}

TEST(SweepShard, EveryRunHasOneShardWhateverTheEnvironment) {
  using Variables = std::map<std::string, std::string>;
  const auto choose = [](const Variables& variables) {
    return choose_shard("", [&](const char* name) {
      const auto at = variables.find(name);
      return at == variables.end() ? nullptr : at->second.c_str();
    });
  };
  EXPECT_EQ(choose({})->count, 1u);
  EXPECT_EQ(choose({{"PMI_RANK", "2"}, {"PMI_SIZE", "3"}})->number, 3u);
  EXPECT_EQ(choose({{"OMPI_COMM_WORLD_RANK", ""}})->count, 1u);
  const auto stepped = choose({{"SLURM_ARRAY_TASK_ID", "20"},
                               {"SLURM_ARRAY_TASK_MIN", "0"},
                               {"SLURM_ARRAY_TASK_COUNT", "3"},
                               {"SLURM_ARRAY_TASK_STEP", "10"}});
  EXPECT_EQ(stepped->number, 3u);
  for (const Variables& wrong :
       {Variables{{"SLURM_ARRAY_TASK_ID", "3"}},
        {{"SLURM_ARRAY_TASK_ID", "9"}, {"SLURM_ARRAY_TASK_MIN", "1"}, {"SLURM_ARRAY_TASK_COUNT", "3"}},
        {{"OMPI_COMM_WORLD_RANK", "x"}, {"OMPI_COMM_WORLD_SIZE", "3"}},
        {{"SLURM_STEP_ID", "0"}, {"SLURM_PROCID", "3"}, {"SLURM_NTASKS", "3"}},
        {{"SLURM_STEP_ID", "0"}, {"SLURM_PROCID", "3"}},
        {{"PMIX_RANK", "1"}},
        {{"PMI_RANK", "3"}, {"PMI_SIZE", "3"}}}) {
    const auto shard = choose(wrong);
    ASSERT_FALSE(shard);
    EXPECT_NE(shard.error().what.find("--shard I/N"), std::string::npos) << shard.error().message();
  }
  // srun without an MPI plugin: a step of four tasks in a job of eight.
  Variables step{{"SLURM_STEP_ID", "1"}, {"SLURM_PROCID", "2"}, {"SLURM_NTASKS", "8"}, {"SLURM_STEP_NUM_TASKS", "4"}};
  EXPECT_EQ(choose(step)->number, 3u);
  EXPECT_EQ(choose(step)->count, 4u);
  EXPECT_EQ(choose(step)->from, "SLURM_PROCID and SLURM_STEP_NUM_TASKS");
  step.erase("SLURM_STEP_NUM_TASKS");
  EXPECT_EQ(choose(step)->count, 8u);
  step["PMIX_RANK"] = "2";
  EXPECT_EQ(choose(step)->number, 3u);
  step["OMPI_COMM_WORLD_RANK"] = "0";  // mpirun within it
  step["OMPI_COMM_WORLD_SIZE"] = "2";
  EXPECT_EQ(choose(step)->count, 2u);
  // The batch script itself has task 0 of eight, and nobody does the others; a shell within has a step of its own kind.
  EXPECT_EQ(choose({{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "8"}})->count, 1u);
  for (const char* special : {"4294967290", "4294967291", "-5"})
    EXPECT_EQ(choose({{"SLURM_STEP_ID", special}, {"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "8"}})->count, 1u);
  EXPECT_EQ(choose({{"SLURM_ARRAY_TASK_ID", "2"},
                    {"SLURM_ARRAY_TASK_MIN", "1"},
                    {"SLURM_ARRAY_TASK_COUNT", "3"},
                    {"SLURM_PROCID", "0"},
                    {"SLURM_NTASKS", "8"}})
                ->count,
            3u);
  // Tasks of an array that have ranks each.
  std::vector<int> owners(100, 0);
  std::set<std::string> files;
  for (int task = 1; task <= 3; ++task)
    for (int rank = 0; rank < 4; ++rank) {
      const auto shard = choose({{"SLURM_ARRAY_TASK_ID", std::to_string(task)},
                                 {"SLURM_ARRAY_TASK_MIN", "1"},
                                 {"SLURM_ARRAY_TASK_COUNT", "3"},
                                 {"OMPI_COMM_WORLD_RANK", std::to_string(rank)},
                                 {"OMPI_COMM_WORLD_SIZE", "4"}});
      ASSERT_TRUE(shard);
      files.insert(shard->file());
      for (std::size_t run = 0; run < owners.size(); ++run) owners[run] += shard->has(run);
    }
  EXPECT_EQ(files.size(), 12u);
  for (const int owner : owners) EXPECT_EQ(owner, 1);
}

TEST_F(Sweep, TwoSweepsWithOneShardDoNotAddToOneFile) {
  write_plan(kTwelve);
  fs::create_directories(folder / "out" / ".work-1-of-1-4");
  bool torn = false;
  const auto held = LineFile::open(folder / "out" / "runs-1-of-1.jsonl", torn);
  ASSERT_TRUE(held);
  const Said said = sweep();
  EXPECT_EQ(said.status, 1);
  EXPECT_NE(said.err.find("another sweep adds to it"), std::string::npos) << said.err;
  EXPECT_TRUE(fs::exists(folder / "out" / ".work-1-of-1-4")) << "where the other's runs write";
}

TEST_F(Sweep, AFileSystemWithoutLocksIsRefusedAndNothingOfOthersIsRemoved) {
  write_plan(kTwelve);
  fs::create_directories(folder / "out" / ".work-1-of-1-4");
  // A library before the system's, as a mount without locks answers.
  write_text(folder / "no_locks.c", "#include <errno.h>\nint flock(int f, int o) { errno = ENOLCK; return -1; }\n");
  if (std::system(("cd " + quoted(folder.string()) + " && cc -shared -fPIC -o no_locks.so no_locks.c").c_str()) != 0)
    GTEST_SKIP() << "no C compiler";
  const Said said = sweep({}, "LD_PRELOAD=" + quoted((folder / "no_locks.so").string()) + " ");
  EXPECT_EQ(said.status, 1);
  EXPECT_NE(said.err.find("runs-1-of-1.jsonl: cannot be locked: No locks available; choose an --out"),
            std::string::npos)
      << said.err;
  EXPECT_TRUE(lines().empty());
  EXPECT_TRUE(fs::exists(folder / "out" / ".work-1-of-1-4"));
}

TEST_F(Sweep, AFolderThatCannotBeLookedIntoIsNoEmptyOne) {
  Lines none;
  EXPECT_TRUE(read_lines(folder / "nowhere", none));
  write_text(folder / "file", "");
  const Status wrong = read_lines(folder / "file", none);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().what.find("cannot be looked into"), std::string::npos);
}

}  // namespace
}  // namespace pliant::testing
