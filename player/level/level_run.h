// One run of a prepared level: opens devices and files, runs the ticks, and writes the results.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "engine/run/body_journal.h"
#include "engine/run/device_links.h"
#include "engine/run/journal.h"
#include "engine/run/pose_replay.h"
#include "engine/run/runner.h"
#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"
#include "player/level/run_setup.h"
#include "player/record/keeper.h"
#include "player/run/frames.h"
#include "player/run/report.h"
#include "player/run/touch_loop.h"

namespace pliant {

struct Shown;

// Outcome of a run, for every clock and every kind of end.
struct Ran {
  std::string mode;
  std::uint64_t overruns = 0;
  std::optional<FrameFigures> drawn;
  std::size_t pictures = 0;
  bool opened = false;    // another level replaces it
  Status ended = Done{};  // the error that ended it early
  bool hung = false;      // stuck in a picture (window_session.h)
  std::future<std::optional<Error>> opening;
};

class LevelRun {
 public:
  // `shown`: its window, or null. All must outlive it.
  LevelRun(Prepared& run, Shown* shown, const Interrupt& interrupt);

  // Opens devices, results and pictures, in that order. If one fails, staged files are removed and nothing is replaced.
  Outcome open();
  // Runs the ticks. `next`: a level that the window opened meanwhile.
  void go(std::optional<Prepared>& next);
  // In every case: writes the results of the ticks that ran, then returns the first error.
  Outcome close();

 private:
  Outcome plan_ticks();
  Outcome open_devices();
  Outcome open_results();
  Outcome open_recording();
  Outcome open_frames();
  void attach();
  void take(const Status& status);  // keeps the first error
  RunFigures figures(std::uint64_t hash);
  void add_findings(RunFigures& figures);
  [[noreturn]] void leave_hung();
  bool realtime() const { return options_.realtime || shown_; }

  Prepared& run_;
  RunOptions options_;
  Shown* shown_;
  const Interrupt& interrupt_;
  World& world_;
  std::uint64_t ticks_ = 0;  // upper limit
  DeviceLinks devices_;
  std::optional<OutputFolder> out_;
  std::optional<BodyJournal> bodies_;
  std::optional<Journal> journal_;
  std::optional<Keeper> keeper_;
  PoseRecorder* recorder_ = nullptr;  // the keeper's; null: not recording
  std::unique_ptr<Frames> frames_;
  std::optional<PoseReplay> replay_;
  std::optional<Runner> runner_;
  std::optional<LiveWorld> live_;  // of a window, if the level has sliders
  std::vector<std::uint64_t> frame_ticks_;
  Ran ran_;
  std::optional<Error> wrong_;
};

}  // namespace pliant
