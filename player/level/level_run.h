// One run of a prepared level: its devices and files are opened, its ticks run, and what came of it is written.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "engine/run/body_journal.h"
#include "engine/run/device_links.h"
#include "engine/run/journal.h"
#include "engine/run/replay.h"
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

// What a run was like, whichever clock it ran on, and however it ended.
struct Ran {
  std::string mode;
  std::uint64_t overruns = 0;
  std::optional<FrameFigures> drawn;
  std::size_t pictures = 0;
  bool opened = false;    // another level takes its place
  Status ended = Done{};  // what ended it early
  bool hung = false;      // in a picture (window_session.h)
  std::future<std::optional<Error>> opening;
};

class LevelRun {
 public:
  // `shown`: its window, or null. All outlive it.
  LevelRun(Prepared& run, Shown* shown, const Interrupt& interrupt);

  // Devices, results and pictures, in that order. Where one fails, what is staged goes and replaces nothing.
  Outcome open();
  // Its ticks. `next`: the level that its window opened after it.
  void go(std::optional<Prepared>& next);
  // Whatever ended the ticks: what ran is written, and then the first error is said.
  Outcome close();

 private:
  Outcome plan_ticks();
  Outcome open_devices();
  Outcome open_results();
  Outcome open_recording();
  Outcome open_frames();
  void attach();
  void take(const Status& status);  // the first error stays
  RunFigures figures(std::uint64_t hash);
  void add_findings(RunFigures& figures);
  [[noreturn]] void leave_hung();
  bool realtime() const { return options_.realtime || shown_; }

  Prepared& run_;
  RunOptions options_;
  Shown* shown_;
  const Interrupt& interrupt_;
  World& world_;
  std::uint64_t ticks_ = 0;  // at most
  DeviceLinks devices_;
  std::optional<OutputFolder> out_;
  std::optional<BodyJournal> bodies_;
  std::optional<Journal> journal_;
  std::optional<Keeper> keeper_;
  PoseRecorder* recorder_ = nullptr;  // the keeper's; null: nothing is recorded
  std::unique_ptr<Frames> frames_;
  std::optional<Replay> replay_;
  std::optional<Runner> runner_;
  std::vector<std::uint64_t> frame_ticks_;
  Ran ran_;
  std::optional<Error> wrong_;
};

}  // namespace pliant
