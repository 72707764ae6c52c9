// However a run ends, its results are reported and no incomplete file is left: signals, closed streams, a full disk, a
// picture that cannot be written.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <set>
#include <thread>

#include "engine/run/recording.h"
#include "lab/console/interrupt.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class Ends : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_text(folder / "plate.obj", plate_obj());
    std::signal(SIGINT, SIG_DFL);  // a script's background job may have started these tests
  }

  static std::string run_line(const std::string& more) {
    return "env -u DISPLAY -u WAYLAND_DISPLAY " + quoted(PLIANT_BINARY) + " run plate.obj --probe p=orbit " + more;
  }

  // Runs shell lines in this test's folder; output goes to .out and .err unless redirected.
  Said shell(const std::string& lines) const {
    write_text(folder / ".sh", "cd " + quoted(folder.string()) + "\n" + lines + "\n");
    const int status = std::system(("bash " + quoted((folder / ".sh").string()) + " >" +
                                    quoted((folder / ".out").string()) + " 2>" + quoted((folder / ".err").string()))
                                       .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(folder / ".out"),
            read_text(folder / ".err")};
  }
  // Starts a run of ten minutes, sends `signals` as soon as it has begun, and waits for it.
  Said signalled(const std::string& signals, const std::string& more = "--frames 0") const {
    return shell(
        "(trap - INT; exec " + run_line("--realtime --seconds 600 --out out " + more) +  // shells ignore it
        ") &\npid=$!\nuntil [ -e out/.partial-$pid/forces.csv ]; do kill -0 $pid || exit 99; sleep 0.02; done\n"
        "sleep 0.5\n" +
        signals + "\nwait $pid");
  }
  void expect_nothing_staged() const {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
      EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
  }
  // Expects all files of a run, and that they agree.
  void expect_results(const std::string& out, const std::string& ended) const {
    ASSERT_TRUE(fs::exists(folder / out / "report.json")) << out;
    const Json json = report(out);
    EXPECT_NE(json["ended"].get<std::string>().find(ended), std::string::npos) << json["ended"];
    EXPECT_GT(json["ticks"], 0);
    EXPECT_EQ(read_text(folder / out / "forces.png").substr(1, 3), "PNG");
    const std::string csv = read_text(folder / out / "forces.csv");
    EXPECT_TRUE(csv.starts_with("tick,time_s,probe,")) << csv.substr(0, 80);
    EXPECT_TRUE(csv.ends_with('\n')) << "the last row is not whole";
    const ForcesTable forces = read_forces(folder / out / "forces.csv");
    EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), forces.rows.size() + 1);
    EXPECT_GT(forces.rows.size(), 0u);
    EXPECT_LE(forces.rows.size(), json["ticks"].get<std::size_t>());
    expect_nothing_staged();
  }
};

TEST_F(Ends, EverySignalThatAsksForItEndsARunCleanly) {
  for (const char* signal : {"INT", "TERM", "HUP"}) {
    fs::remove_all(folder / "out");
    const Said said = signalled(std::string("kill -") + signal + " $pid", "--frames 0 --record " + std::string(signal));
    EXPECT_EQ(said.status, 0) << signal << said.err;
    expect_results("out", "interrupted");
    EXPECT_LT(report("out")["ticks"], 600000) << signal;
    EXPECT_TRUE(fs::exists(folder / signal)) << "the recording is lost";
  }
}

TEST_F(Ends, ASecondCtrlCDoesNotLoseTheReport) {
  const Said said = signalled("kill -INT $pid; sleep 0.02; kill -INT $pid; kill -TERM $pid; kill -INT $pid");
  EXPECT_EQ(said.status, 0) << said.err;
  expect_results("out", "interrupted");
}

// At any time, also after the report has been written and the process is about to end.
TEST_F(Ends, ASignalMoreDoesNotChangeHowARunEndsThatASignalHasEnded) {
  const auto run = [](int first, std::initializer_list<int> late, int presses = 0) {
    {
      const Interrupt interrupt;
      if (first > 0) std::raise(first);
    }
    for (const int signal : late) std::raise(signal);
    for (int i = 0; i < presses; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(400));
      std::raise(SIGINT);
    }
    std::_Exit(7);
  };
  for (const int first : {SIGINT, SIGTERM, SIGHUP})
    EXPECT_EXIT(run(first, {SIGTERM, SIGINT, SIGHUP, SIGTERM}), ::testing::ExitedWithCode(7), "^$") << first;
  EXPECT_EXIT(run(SIGINT, {}, 2), ::testing::ExitedWithCode(7), "^$");
  EXPECT_EXIT(run(SIGINT, {}, 3), ::testing::ExitedWithCode(130), "^$");
  // Without a requested end, signals have their previous effect.
  EXPECT_EXIT(run(0, {SIGTERM}), ::testing::KilledBySignal(SIGTERM), "^$");
}

// A run that does not end on request.
TEST_F(Ends, TheThirdCtrlCEndsAtOnceAndLeavesNothingStagedAndTheSecondSaysSo) {
  const fs::path staged = folder / "out" / ".partial-1";
  fs::create_directories(staged);
  write_text(staged / "forces.csv", "tick\n");
  const auto hang = [&](int presses) {
    const Interrupt interrupt;
    interrupt.remove_if_forced(staged);
    for (int i = 0; i < presses; ++i) {
      std::raise(SIGINT);
      std::raise(SIGINT);  // forwarded by a program: counts as the same Ctrl-C
      std::this_thread::sleep_for(std::chrono::milliseconds(600));
      if (!interrupt.requested()) std::_Exit(98);
    }
    std::_Exit(99);
  };
  EXPECT_EXIT(hang(1), ::testing::ExitedWithCode(99), "^$");
  EXPECT_EXIT(hang(2), ::testing::ExitedWithCode(99), "press Ctrl-C again to quit at once");
  EXPECT_TRUE(fs::exists(staged));
  EXPECT_EXIT(hang(3), ::testing::ExitedWithCode(130), "quit at once; results of this run were not written");
  expect_nothing_staged();
}

TEST_F(Ends, WhatNohupProtectsIgnoresTheEndOfTheTerminal) {
  const Said said = shell("nohup " + run_line("--realtime --seconds 2 --frames 0 --out out") +
                          " >nohup 2>&1 &\npid=$!\nsleep 1\nkill -HUP $pid\nwait $pid");
  EXPECT_EQ(said.status, 0) << read_text(folder / "nohup");
  expect_results("out", "done");
}

TEST_F(Ends, ACtrlCThatIsMeantForTheForegroundLeavesARunInTheBackgroundAlone) {
  const Said said =
      shell(run_line("--realtime --seconds 2 --frames 0 --out out") + " &\npid=$!\nsleep 1\nkill -INT $pid\nwait $pid");
  EXPECT_EQ(said.status, 0) << said.err;
  expect_results("out", "done");
}

TEST_F(Ends, TheNextRunRemovesWhatAKilledOneLeftAndNothingElse) {
  fs::create_directories(folder / "out" / ".partial-1");  // of another process
  write_text(folder / "out" / ".partial-1" / "notes.txt", "mine");
  write_text(folder / "out" / ".partial-2", "mine");
  write_text(folder / "out.rec.partial-1", "mine");
  const Said killed = signalled("kill -KILL $pid", "--frames 0 --record out.rec");
  EXPECT_EQ(killed.status, 128 + SIGKILL);
  const auto staged = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().filename().string().find(".partial") != std::string::npos)
        names.insert(fs::relative(entry.path(), folder).string());
    return names;
  };
  EXPECT_EQ(staged().size(), 5u) << "the kill came too late for this test to prove anything";
  const Said said = shell(run_line("--seconds 0.1 --frames 0 --out out --record out.rec"));
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(staged(), (std::set<std::string>{"out.rec.partial-1", "out/.partial-1", "out/.partial-2"}));
  EXPECT_EQ(read_text(folder / "out" / ".partial-1" / "notes.txt"), "mine");
  EXPECT_TRUE(fs::exists(folder / "out" / "report.json"));
}

TEST_F(Ends, ClosedStreamsDoNotLandInTheFiles) {
  for (const std::string closed : {">&-", "2>&-", "<&-", "<&- >&- 2>&-"}) {
    fs::remove_all(folder / "out");
    // If stderr is closed, the run is long enough for progress to be shown.
    const std::string seconds = closed.ends_with("2>&-") ? "6" : "0.2";
    const Said said =
        shell(run_line("--realtime --seconds " + seconds + " --frames 0 --out out --record out.rec --force ") + closed);
    EXPECT_EQ(said.status, 0) << closed << said.err;
    expect_results("out", "done");
    for (const ForcesTable forces = read_forces(folder / "out" / "forces.csv"); const auto& row : forces.rows)
      ASSERT_EQ(row.at("probe"), "p") << closed;
    std::istringstream list(read_text(folder / "out" / ".pliant-run"));
    std::string line;
    for (std::getline(list, line); std::getline(list, line);)
      EXPECT_TRUE(fs::exists(folder / "out" / line)) << closed << ": something is in the list: " << line;
    EXPECT_EQ(pliant({"run", "plate.obj", "--replay", "out.rec", "--frames", "0", "--out", "again", "--force"}).status,
              0)
        << closed << ": something is in the recording";
  }
}

TEST_F(Ends, ABrokenPipeIsSaidAndLosesNoFile) {
  const Said cut = shell(run_line("--seconds 0.2 --frames 0 --out cut") + " | head -1; exit ${PIPESTATUS[0]}");
  EXPECT_LE(cut.status, 1) << cut.err;
  expect_results("cut", "done");
  const Said said = shell(run_line("--seconds 0.2 --frames 0 --out out") + " | true; exit ${PIPESTATUS[0]}");
  EXPECT_EQ(said.status, 1) << said.err;
  EXPECT_NE(said.err.find("pliant: error: stdout: "), std::string::npos) << said.err;
  expect_results("out", "done");
  for (const char* verb : {"inspect", "validate"}) {
    const Said full = shell(quoted(PLIANT_BINARY) + " " + verb + " plate.obj >/dev/full");
    EXPECT_EQ(full.status, 1) << verb;
    EXPECT_NE(full.err.find("stdout"), std::string::npos) << full.err;
  }
}

// To the writer, a limit on the file size is like a full disk.
TEST_F(Ends, AFullDiskEndsTheRunWhenItHappensAndKeepsWhatWasWritten) {
  const Said said = shell("ulimit -f 100\n" + run_line("--seconds 20000 --frames 0 --out out"));
  EXPECT_EQ(said.status, 3);
  EXPECT_NE(said.err.find("pliant: error: out/forces.csv: could not be written to its end"), std::string::npos)
      << said.err;
  expect_results("out", "forces.csv");
  EXPECT_LT(report("out")["ticks"], 20000) << "it was noticed at the end only";
  EXPECT_GT(fs::file_size(folder / "out" / "forces.csv"), 90u * 1024) << "rows were lost";
}

TEST_F(Ends, ARecordingThatDoesNotFitIsKeptAsFarAsItWent) {
  for (const rlim_t limit : {40000u, 65536u, 99999u}) {
    const fs::path file = folder / ("p" + std::to_string(limit) + ".rec");
    auto writer = RecordingWriter::create(file, {"plate", 1000.0, {"p", "q"}});
    ASSERT_TRUE(writer.ok());
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{limit, before.rlim_max};
    std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    std::uint64_t tick = 0;
    for (; tick < 10000 && !writer->failure(); ++tick) {
      writer->tick(tick);
      for (int i = 0; i < 2; ++i) writer->pose({{static_cast<double>(tick), i, 0}, {1, 0, 0, 0}, true});
    }
    const Status finished = writer->finish();
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_FALSE(finished.ok());
    EXPECT_LT(tick, 10000u) << "noticed at the end only";
    const auto recording = read_recording(file);
    ASSERT_TRUE(recording.ok()) << recording.error().message();
    EXPECT_GT(recording->ticks.size(), (limit - 300) / 123) << "ticks that were written are lost";
    for (std::size_t i = 0; i < recording->ticks.size(); ++i) {
      ASSERT_EQ(recording->ticks[i], i);
      ASSERT_EQ(recording->poses[2 * i + 1].position.x, static_cast<double>(i));
    }
  }
}

// The rows of a few ticks are within the limit, a picture exceeds it.
TEST_F(Ends, APictureThatCannotBeWrittenEndsTheRunWithAReport) {
  for (const std::string clock : {"--lockstep", "--realtime"}) {
    fs::remove_all(folder / "out");
    const Said said =
        shell("ulimit -f 60\n" + run_line("--rate 10 --seconds 60 --frames 100 --size 1920x1080 --out out " + clock));
    if (said.err.find("EGL") != std::string::npos) GTEST_SKIP() << "no graphics here: " << said.err;
    EXPECT_EQ(said.status, 3) << clock;
    EXPECT_NE(said.err.find("pliant: error: out/frame-0000.png: could not be written"), std::string::npos) << said.err;
    expect_results("out", "frame-0000.png");
    EXPECT_LT(report("out")["ticks"], 600) << clock;
    EXPECT_FALSE(fs::exists(folder / "out" / "frame-0000.png"));
  }
}

// The driver is missing.
TEST_F(Ends, AFieldOnTheGpuWithoutOneIsRefused) {
  const Said said = pliant({"run", "plate.obj", "--probe", "p=orbit", "--seconds", "0.1", "--field", "gpu"},
                           "__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere EGL_PLATFORM=bogus");
  EXPECT_EQ(said.status, 1) << said.err;
  EXPECT_NE(said.err.find("--field cpu"), std::string::npos) << said.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

}  // namespace
}  // namespace pliant::testing
