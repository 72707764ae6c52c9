// pliant sweep with other processes: shards, locks, parents and kills.
#include <set>

#include "lab/sweep/lines.h"
#include "lab/sweep/shard.h"
#include "tests/lab/sweep_command.h"

namespace pliant::testing {
namespace {

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
                 // The sweep's direct children only: a run's importer has the command line of its run.
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
    EXPECT_NE(shard.error().message().find("--shard I/N"), std::string::npos) << shard.error().message();
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
  // The batch script itself has task 0 of eight but must do all runs; a shell within has a step id of the reserved
  // range.
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
  // Array tasks with several ranks each.
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
  // A preloaded library that answers like a mount without locks.
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
