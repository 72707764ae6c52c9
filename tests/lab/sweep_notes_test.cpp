// Notes at the end of a sweep: limits that acted, notes of runs, axes without effect. Also the curves that it keeps,
// and a full disk, which is not a failure of a run.
#include "tests/lab/sweep_command.h"

namespace pliant::testing {
namespace {

// The first of two plates is soft; the second requires more force than the device's limit.
constexpr const char* kSoftAndStiff = R"("axes": {"*.deformable.stiffness": [100, 100000]})";

TEST_F(Sweep, ForcesThatWereClippedAreSaidByTheSweepAndByMerge) {
  write_plan(kSoftAndStiff);
  const Said swept = sweep();
  ASSERT_EQ(swept.status, 0) << swept.err;
  const Said said = pliant({"sweep", "merge", "out", "--out", "m"});
  ASSERT_EQ(said.status, 0) << said.err;
  for (const std::string& err : {swept.err, said.err}) {
    EXPECT_NE(err.find("in 1 of 2 runs a force was clipped (at most 9"), std::string::npos) << err;
    EXPECT_NE(err.find("*.deformable.stiffness = 100000); raise max_force"), std::string::npos) << err;
  }
  const Json limits = report("m")["limits"];
  EXPECT_EQ(limits["clipped"]["runs"], 1);
  EXPECT_EQ(report("m")["clipped"], 1);
  EXPECT_GT(limits["clipped"]["worst"].get<double>(), 0.9);
  for (const Json& line : lines())
    if (line["axes"]["*.deformable.stiffness"] == 100000) {
      EXPECT_EQ(limits["clipped"]["id"], line["id"]);
      EXPECT_NE(line["notes"].dump().find("was clipped at"), std::string::npos) << line["notes"];
    }
  const std::string table = read_text(folder / "m" / "results.csv");
  EXPECT_NE(table.substr(0, table.find('\n')).find(",notes"), std::string::npos);
  EXPECT_NE(table.find("was clipped at"), std::string::npos);
}

TEST_F(Sweep, NotesThatRunsShareAreSaidOnceWithHowManySaidThem) {
  // The path is cut short in every run.
  write_text(folder / "press.csv", "time_s,x,y,z\n0,0,0.002,0\n0.02,0,-0.004,0\n9,0.004,-0.004,0\n");
  write_plan(R"("axes": {"*.deformable.stiffness": [100, 200, 300]})");
  const Said said = sweep();
  const std::string sentence = "in 3 of 3 runs: the script of `tip` lasts 9 s";
  const std::size_t at = said.err.find(sentence);
  ASSERT_NE(at, std::string::npos) << said.err;
  EXPECT_EQ(said.err.find(sentence, at + 1), std::string::npos);
  ASSERT_EQ(pliant({"sweep", "merge", "out", "--out", "m"}).status, 0);
  EXPECT_EQ(report("m")["notes"][0]["runs"], 3);
}

// Two notes of one code about one key, of different nodes or with different words.
TEST_F(Sweep, EveryDistinctNoteIsSeen) {
  write_plan(R"("axes": {"tip.haptic_device.scale": [1, 2], "*.deformable.spring": ["linear", "cubic"],
"*.deformable.stiffening": [100, 200]})");
  ASSERT_EQ(sweep().status, 0);
  ASSERT_EQ(pliant({"sweep", "merge", "out", "--out", "m"}).status, 0);
  std::set<std::string> said, seen;
  const auto words = [](std::string sentence) {
    std::erase_if(sentence, [](char c) { return c >= '0' && c <= '9'; });
    return sentence;
  };
  for (const Json& line : lines())
    for (const Json& note : line["notes"]) said.insert(words(note["what"].get<std::string>()));
  const Json merged = report("m");
  for (const Json& note : merged["notes"]) seen.insert(words(note["sentence"].get<std::string>()));
  EXPECT_GE(said.size(), 2u);
  for (const std::string& each : said)
    EXPECT_TRUE(std::any_of(seen.begin(), seen.end(), [&](const std::string& it) { return it.starts_with(each); }))
        << each;
}

TEST_F(Sweep, AxesAlongWhichNothingChangesAreNamed) {
  // `cubic` belongs to another spring law than the plate's.
  write_plan(R"("axes": {"*.deformable.stiffness": [100, 200], "*.deformable.cubic": [0, 1000]})");
  const Said swept = sweep();
  ASSERT_EQ(swept.status, 0) << swept.err;
  const Said said = pliant({"sweep", "merge", "out", "--out", "m"});
  for (const std::string& err : {swept.err, said.err})
    EXPECT_NE(err.find("nothing changes along *.deformable.cubic: no figure"), std::string::npos) << err;
  EXPECT_EQ(report("m")["idle_axes"], Json::array({"*.deformable.cubic"}));
}

TEST_F(Sweep, CurvesAreKeptWhereThePlanAsksForThem) {
  write_plan(kSoftAndStiff);
  ASSERT_EQ(sweep().status, 0);
  EXPECT_FALSE(fs::exists(folder / "out" / "curves"));
  write_plan(std::string(R"("keep": "curves", )") + kSoftAndStiff);
  const Said said = sweep();
  EXPECT_NE(said.err.find("2 runs were done without keeping their curves"), std::string::npos) << said.err;
  EXPECT_NE(sweep().out.find("0 done now, 2 before"), std::string::npos);
  for (const std::string& id : ids()) {
    const ForcesTable curve = read_forces(folder / "out" / "curves" / (id + ".csv"));
    EXPECT_EQ(curve.rows.size(), 50u) << id;
  }
  std::vector<std::string> words{"plot", "--out", "plot"};
  for (const std::string& id : ids()) words.push_back("out/curves/" + id + ".csv");
  EXPECT_EQ(pliant(words).status, 0);
  const Json merged_report = Json::parse(merged({"out"}, "m").at("report.json"));
  EXPECT_EQ(merged_report["disagree"].size(), 0u) << "the runs that were done again are the same";
  write_plan(std::string(R"("keep": "pictures", )") + kSoftAndStiff);
  expect_refused({"sweep", "plan.json", "--out", "other"}, 1, "/keep");
}

TEST_F(Sweep, AFullDiskIsNoFailureOfARun) {
  write_text(folder / "plan.json",
             R"({"level": "plate.obj", "options": {"seconds": 0.3, "probe": ["tip=script:press.csv"]}, )" +
                 std::string(kSoftAndStiff) + "}");
  const Said full = sweep({}, "bash -c 'ulimit -f 16; exec \"$@\"' -");  // 300 rows take some 50 kB
  EXPECT_EQ(full.status, 1);
  EXPECT_NE(full.err.find("with more room the same command goes on with it"), std::string::npos) << full.err;
  EXPECT_TRUE(lines().empty());
  expect_no_work_left();
  const Said again = sweep();
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.out.find("2 done now, 0 before"), std::string::npos) << again.out;
  // A line that an older sweep recorded as a failure.
  std::string text;
  for (const Json& line : lines())
    text += Json{{"id", line["id"]},
                 {"status", "failed"},
                 {"axes", line["axes"]},
                 {"timing", line["timing"]},
                 {"exit", 3},
                 {"code", "disk.full"},
                 {"error", "out/forces.csv: No space left on device; free some space"}}
                .dump() +
            "\n";
  write_text(folder / "out" / "runs-1-of-1.jsonl", text);
  EXPECT_NE(sweep().out.find("2 done now"), std::string::npos);
}

}  // namespace
}  // namespace pliant::testing
