// One run of a played level: a Session and the thread that owns it. Commands go to it through a queue, its state comes
// back through a TripleBuffer, its picture through those of the world (scene_view.h). Only while a picture is prepared
// does the run stand still.
//
// Lockstep: ticks follow the wall clock times `speed`, or single steps; the same level and past give the same bits.
// Real time: the engine's own clocks.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "content/level/level.h"
#include "editor/play/play_hand.h"
#include "editor/play/play_past.h"
#include "engine/run/device_view.h"
#include "engine/run/soft_clock.h"
#include "pliant/session.h"
#include "runtime/exchange.h"

namespace pliant {

// The source of a probe or tool.
struct PlaySource {
  enum class Kind : std::uint8_t { kLevel, kMouse, kScript, kOrbit, kNone, kDriver };
  Kind kind = Kind::kLevel;
  std::string what;                  // script file, or device (devices/choose.h)
  std::shared_ptr<const Path> path;  // of a script that is not saved yet
  double from = 0.0;                 // [s] of the run: start of a script
  bool operator==(const PlaySource&) const = default;
};
struct PlayOptions {
  std::function<Result<Level>()> level;                     // called on the run's thread
  std::vector<std::pair<std::string, PlaySource>> sources;  // by name; others use the level's
  std::set<std::string> allowed;          // ids of the level that the user allows (content/level/device_request.h)
  bool mouse_probe = false;               // adds a probe `mouse` if the mouse moves nothing else
  bool realtime = false, paused = false;  // real time is used if the level itself requests a device
  bool repeats = false;                   // scripts restart when they have ended, as in the window of a run
  double speed = 1.0;                     // [1] relative to the wall clock, in lockstep
  bool shown = false;                     // ticks wait until a picture exists
  Viewpoint view;                         // the initial view
  std::shared_ptr<const PlayPast> past;   // repeated up to `until` before anything else
  std::uint64_t until = 0;                // [ticks]
};

enum class PlayPhase : std::uint8_t { kOpening, kReplaying, kPaused, kPlaying, kEnded };

struct PlayEffector {
  std::string name, source;  // "orbit", "script press.csv"
  bool tool = false;
  double radius = 0.0;                     // [m] of a probe
  Reading reading;                         // the newest
  std::array<std::uint64_t, 4> limited{};  // [ticks] by SafetyLimit
};

// The displayed state of a run.
struct PlayStatus {
  PlayPhase phase = PlayPhase::kOpening;
  std::string error;               // why it ended, or could not start
  std::vector<std::string> notes;  // each is reported once
  bool realtime = false;
  std::uint64_t tick = 0;            // completed
  double time = 0.0, rate = 1000.0;  // [s], [Hz]
  double pace = 0.0;                 // [1] achieved speed relative to the wall clock
  double speed = 1.0;
  bool again = false;  // repeating a past: `tick` of `until` ticks
  std::uint64_t until = 0;
  SessionFigures figures;
  bool soft = false;
  double soft_ms = 0.0, soft_step_ms = 0.0;  // [ms] of the last soft step, and its budget
  std::vector<PlayEffector> effectors;
  std::vector<std::string> objects;
  std::map<std::string, Deformable> surfaces;  // with their current parameters
  std::string hash;                            // of forces and state, in lockstep while paused: as in `pliant run`
  std::vector<std::string> findings;
  DevicesView devices;
};

class PlayRun {
 public:
  explicit PlayRun(PlayOptions options);
  ~PlayRun();  // ends it and waits
  PlayRun(const PlayRun&) = delete;
  PlayRun& operator=(const PlayRun&) = delete;

  // The newest; valid until the next call. On the interface's thread.
  const PlayStatus& status();
  // Samples of each effector since the last call, oldest first.
  void take_samples(std::vector<std::vector<PlaySample>>& out);

  // --- Commands; they take effect between ticks
  void pause(bool paused);
  void step(std::uint64_t ticks);  // in lockstep, while paused
  void set_speed(double speed);
  void set(const std::string& object, const std::string& key, double value);
  void set_source(const std::string& effector, const PlaySource& source);  // lockstep
  void order(const DeviceOrders& orders);                                  // of devices
  void go_to(std::uint64_t tick);                                          // forward, in a repeated past
  void go_on();  // from there: the past ends here, and sources move again
  void end();    // releases devices at once; does not wait
  // The past so far. Only while paused.
  std::shared_ptr<const PlayPast> past();
  // Waits until all requests are done. For tests and scripts.
  void wait();

  PlayHand hand;
  const std::shared_ptr<PlayKept> kept = std::make_shared<PlayKept>();

  // --- For the stage. The world lives as long as this run.
  bool opened() const { return opened_ && !end_; }  // a picture may be made
  // Calls `make` between two ticks, on this thread; it may read the whole world. From then on only the stage acquires
  // the world's snapshots. False: the run has ended, or its clocks run.
  bool make_picture(const std::function<void(World&)>& make);
  bool pictured() const { return pictured_; }
  bool moving() const { return moving_; }

 private:
  struct Inside;  // belongs to the run's thread
  using Command = std::function<void(Inside&)>;
  void run();
  Status open(Inside& in);
  Status begin(Inside& in);
  void turn(Inside& in);
  void show(Inside& in);
  void close(Inside& in);
  void post(Command command);

  PlayOptions options_;
  TripleBuffer<PlayStatus> reported_;  // the run's thread -> the interface
  std::mutex stands_still_;            // held by the run's thread while it works, by the stage while it makes a picture
  mutable std::mutex mutex_;           // guards the four members below
  std::condition_variable changed_;
  std::vector<std::vector<PlaySample>> samples_;
  std::vector<Command> commands_;
  bool busy_ = true, ended_ = false;
  std::atomic<bool> end_{false}, opened_{false}, pictured_{false}, moving_{false};
  std::unique_ptr<Inside> inside_;
  std::thread thread_;  // last
};

}  // namespace pliant
