// Runs a sweep over a small plate by the command and reads its output.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "lab/sweep/plan.h"
#include "lab/sweep/run_id.h"
#include "player/verbs/command_line.h"
#include "tests/player/command.h"

namespace pliant::testing {

// Shell prefix that limits a command's memory [kB] and CPU time [s]. A sanitizer's shadow memory exceeds any limit, so
// only time is limited there.
inline std::string limited(int memory, int time) {
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

  // A plan on the plate with 50 ticks per run and these axes (and other members, if given).
  void write_plan(const std::string& rest, const std::string& name = "plan.json") const {
    write_text(
        folder / name,
        R"({"level": "plate.obj", "options": {"seconds": 0.05, "probe": ["tip=script:press.csv"]}, )" + rest + "}");
  }
  static constexpr const char* kTwelve =
      R"("axes": {"*.deformable.stiffness": [100, 200, 300, 400], "*.deformable.reach": {"from": 0.01, "to": 0.03, "steps": 3}})";

  ExpandedPlan expanded(const std::string& name = "plan.json") const {
    const auto plan = read_plan(folder / name, check_run_arguments);
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

  // Every complete line of every shard.
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

  // The files that must be identical however the runs were distributed.
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

}  // namespace pliant::testing
