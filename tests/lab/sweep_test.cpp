// pliant sweep: every run is done exactly once in every case, and merged files are identical however the runs were
// distributed.
#include <cmath>

#include "lab/sweep/lines.h"
#include "player/verbs/command_line.h"
#include "tests/lab/sweep_command.h"

namespace pliant::testing {
namespace {

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
  for (const char* shard : {"4/4", "3/4"})  // in a separate folder, as on another machine; two runs at a time
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
  // A stiffer plate gives a larger force: the table has the measured values in the right rows.
  EXPECT_LT(report["figures"]["tip.max_force_N"]["min"].get<double>(),
            report["figures"]["tip.max_force_N"]["max"].get<double>() / 2);
  // A second merge replaces nothing.
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
    // A line that lacks only its newline is complete.
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
  for (int kill = 1; kill <= 2; ++kill) {  // after it has appended some lines
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
  // Half of the runs have almost no memory allowance; the plan alone does not reveal it.
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

// Of several failures of one run the latest counts, in any file and with any message.
TEST_F(Sweep, TheLatestFailureIsTheOneThatIsReported) {
  write_plan(R"("axes": {"--limits": [1e-6], "*.deformable.stiffness": [100]})");
  ASSERT_EQ(sweep().status, 0);
  Json line = lines().at(0);
  EXPECT_FALSE(line.contains("attempt"));
  const fs::path file = folder / "out" / "runs-1-of-1.jsonl";
  line["error"] = "0: an old sentence";  // first in text order
  write_text(file, line.dump() + "\n");
  ASSERT_EQ(sweep({"--retry-failed", "--shard", "1/2"}).status, 0);
  for (const Json& each : lines())
    if (each != line) EXPECT_EQ(each["attempt"], 2) << each;
  const auto merged_now = merged({"out"}, "m1");
  EXPECT_NE(Json::parse(merged_now.at("report.json"))["failures"][0]["error"].get<std::string>().find("--limits"),
            std::string::npos);
  // In any folder and order.
  fs::create_directories(folder / "other");
  fs::rename(file, folder / "other" / "runs-1-of-1.jsonl");
  fs::copy(folder / "out" / "sweep.json", folder / "other" / "sweep.json");
  for (const std::vector<std::string>& folders : {std::vector<std::string>{"out", "other"}, {"other", "out"}})
    EXPECT_EQ(merged(folders, "m" + folders[0]), merged_now);
  // A completed run takes precedence over any failure.
  Lines all;
  line["status"] = "done";
  line["figures"] = Json::object();
  write_text(folder / "other" / "runs-2-of-2.jsonl", line.dump() + "\n");
  for (const char* each : {"out", "other"}) ASSERT_TRUE(read_lines(folder / each, all));
  EXPECT_TRUE(is_done(all.runs.at(line["id"].get<std::string>())));
}

// Different values may denote the same run; the value in a line does not matter.
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
  // A user's file of that name is kept.
  fs::create_directories(folder / "mine");
  write_text(folder / "mine" / "sweep.json", "{\"notes\": 1}");
  expect_refused({"sweep", "plan.json", "--out", "mine"}, 1, "was not written by a sweep");
  EXPECT_EQ(read_text(folder / "mine" / "sweep.json"), "{\"notes\": 1}");
}

TEST_F(Sweep, RunsThatTouchNothingAndFiguresThatAreTheSameAreSaid) {
  write_text(folder / "press.csv", "time_s,x,y,z\n0,0,0.02,0\n0.05,0,0.01,0\n");
  write_plan(R"("axes": {"*.deformable.stiffness": [100, 200]})");
  ASSERT_EQ(sweep().status, 0);
  const Said said = pliant({"sweep", "merge", "out", "--out", "m"});
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("in 2 of 2 runs no probe touched anything"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("nothing is drawn: no figure differs between the runs"), std::string::npos) << said.err;
  EXPECT_EQ(report("m")["untouched"], 2);
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

// Figures that differ between runs by one rounding are constant, and get no plot, whose axis would never end.
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
  const auto plan = read_plan(folder / "plan.json", check_run_arguments);
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

}  // namespace
}  // namespace pliant::testing
