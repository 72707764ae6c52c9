// Runs of a sweep share their soft bodies: each is made once, and every run equals the run alone, to the bit.
#include <algorithm>

#include "tests/lab/sweep_command.h"

namespace pliant::testing {
namespace {

class SweepTissue : public Sweep {
 protected:
  static constexpr const char* kPlan =
      R"({"level": "hand", "options": {"seconds": 0.1}, "axes": {"organ.soft_body.young": [4000, 8000],
          "organ.soft_body.cell": [0.021, 0.03], "--rate": [500, 1000]}})";
  std::string alone(const SweepRun& run, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"run", "hand",  "--lockstep", "--headless", "--frames",
                                   "0",   "--out", "one",        "--force"};
    words.insert(words.end(), run.arguments.begin(), run.arguments.end());
    words.insert(words.end(), more.begin(), more.end());
    const Said said = pliant(words);
    EXPECT_EQ(said.status, 0) << said.err;
    return report("one")["hash"].get<std::string>();
  }
};

TEST_F(SweepTissue, RunsThatShareBodiesAreThoseOfSingleRunsWhateverTheThreads) {
  write_text(folder / "plan.json", kPlan);
  const ExpandedPlan plan = expanded();
  ASSERT_EQ(plan.runs.size(), 8u);
  std::map<std::string, std::string> hashes;
  for (const SweepRun& run : plan.runs) hashes[run.id] = alone(run, {"--threads", "1"});
  ASSERT_EQ(sweep().status, 0);
  ASSERT_EQ(pliant({"sweep", "plan.json", "--out", "two", "--jobs", "2"}, kNoRank).status, 0);
  for (const char* out : {"out", "two"}) {
    const auto all = lines(out);
    ASSERT_EQ(all.size(), hashes.size());
    for (const Json& line : all)
      EXPECT_EQ(line["figures"]["hash"], hashes.at(line["id"].get<std::string>())) << out << ' ' << line.dump();
    expect_no_work_left(out);
  }
}

TEST_F(SweepTissue, ABodyIsMadeOnceForAllRunsThatDoNotChangeIt) {
  write_text(folder / "plan.json", kPlan);
  fs::create_directory(folder / "bodies");
  const auto names = [&] {
    std::set<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder / "bodies")) out.insert(entry.path().filename());
    return out;
  };
  const std::vector<std::string> store{"--soft-store", (folder / "bodies").string()};
  const ExpandedPlan plan = expanded();
  std::vector<std::size_t> kept;
  for (const SweepRun& run : plan.runs) {
    const std::string without = alone(run);
    EXPECT_EQ(alone(run, store), without) << run.id;
    kept.push_back(names().size());
  }
  // The hand's tissue and the organ's; another organ for the other cell size.
  EXPECT_EQ(kept, (std::vector<std::size_t>{2, 2, 3, 3, 3, 3, 3, 3}));
  // A truncated body file is created again.
  for (const std::string& name : names()) fs::resize_file(folder / "bodies" / name, 1000);
  EXPECT_EQ(alone(plan.runs[0], store), alone(plan.runs[0]));
}

TEST_F(SweepTissue, ThePlaceOfTheBodiesIsTheSweepsOwn) {
  write_text(folder / "plan.json",
             R"({"level": "hand", "options": {"soft-store": "there"}, "axes": {"--rate": [500]}})");
  const Said said = sweep();
  EXPECT_EQ(said.status, 1);
  EXPECT_NE(said.err.find("--soft-store is the sweep's own"), std::string::npos) << said.err;
}

}  // namespace
}  // namespace pliant::testing
