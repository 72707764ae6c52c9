// One run of a level that is played: a Session and the thread that owns it. Everything else talks to it by values under
// a mutex. Pictures of it are drawn by the stage meanwhile, from the world's snapshots (scene_view.h).
//
// Lockstep: ticks come at the pace of the wall clock times `speed`, or one by one; the same level and the same past
// have the same bits. Real time: the engine's own clocks.
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

namespace pliant {

// What moves a probe or tool.
struct PlaySource {
  enum class Kind : std::uint8_t { kLevel, kMouse, kScript, kOrbit, kNone, kDriver };
  Kind kind = Kind::kLevel;
  std::string what;                  // file of a script, which device (devices/choose.h)
  std::shared_ptr<const Path> path;  // of a script that is in no file yet
  double from = 0.0;                 // [s] of the run: where a script begins
  bool operator==(const PlaySource&) const = default;
};
struct PlayOptions {
  std::function<Result<Level>()> level;                     // called on the run's thread
  std::vector<std::pair<std::string, PlaySource>> sources;  // by name; others have the level's
  std::set<std::string> allowed;          // ids of the level that the user allows (content/level/device_request.h)
  bool mouse_probe = false;               // a probe `mouse` is added where nothing is moved by the mouse
  bool realtime = false, paused = false;  // where the level itself asks for a device, it is felt in real time
  bool repeats = false;                   // scripts start over when they have ended, as in the window of a run
  double speed = 1.0;                     // [1] of the wall clock, in lockstep
  bool shown = false;                     // ticks wait until a picture has been made of it
  Viewpoint view;                         // that it is looked at from at first
  std::shared_ptr<const PlayPast> past;   // is had again, as far as `until`, before anything else
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

// Everything that is shown of a run.
struct PlayStatus {
  PlayPhase phase = PlayPhase::kOpening;
  std::string error;               // why it ended, or could not begin
  std::vector<std::string> notes;  // each is said once
  bool realtime = false;
  std::uint64_t tick = 0;            // done
  double time = 0.0, rate = 1000.0;  // [s], [Hz]
  double pace = 0.0;                 // [1] of the wall clock, as reached
  double speed = 1.0;
  bool again = false;  // it has a past again: `tick` of `until` ticks
  std::uint64_t until = 0;
  SessionFigures figures;
  bool soft = false;
  double soft_ms = 0.0, soft_step_ms = 0.0;  // [ms] of the last soft step, and the time it has
  std::vector<PlayEffector> effectors;
  std::vector<std::string> objects;
  std::map<std::string, Deformable> surfaces;  // as they are set now
  std::string hash;  // of forces and state, in lockstep while it stands still: as `pliant run` says it
  std::vector<std::string> findings;
  DevicesView devices;
};

class PlayRun {
 public:
  explicit PlayRun(PlayOptions options);
  ~PlayRun();  // ends it and waits
  PlayRun(const PlayRun&) = delete;
  PlayRun& operator=(const PlayRun&) = delete;

  PlayStatus status() const;
  // Samples of each effector since the last call, oldest first.
  void take_samples(std::vector<std::vector<PlaySample>>& out);

  // --- Commands; they come into force between ticks
  void pause(bool paused);
  void step(std::uint64_t ticks);  // in lockstep, while it stands still
  void set_speed(double speed);
  void set(const std::string& object, const std::string& key, double value);
  void set_source(const std::string& effector, const PlaySource& source);  // lockstep
  void order(const DeviceOrders& orders);                                  // of devices
  void go_to(std::uint64_t tick);                                          // forward, in a past that is being had again
  void go_on();  // from there: the past ends here, sources move again
  void end();    // devices are let go at once; does not wait
  // What has been so far. Of a run that stands still.
  std::shared_ptr<const PlayPast> past();
  // Until nothing that was asked for is under way. Of tests and scripts.
  void wait();

  PlayHand hand;
  const std::shared_ptr<PlayKept> kept = std::make_shared<PlayKept>();

  // --- The stage's
  bool opened() const;     // a picture may be made
  World* claim_picture();  // waits until it stands still, until picture_made(); null: it has ended
  bool pictured() const;
  bool moving() const { return moving_; }
  void picture_made();  // from now on its snapshots are the stage's alone
  void picture_gone();  // and now the world may go

 private:
  struct Inside;  // the run's thread's own
  using Command = std::function<void(Inside&)>;
  void run();
  Status open(Inside& in);
  void turn(Inside& in);
  void show(Inside& in);
  void close(Inside& in);
  void post(Command command);

  PlayOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  PlayStatus status_;
  std::vector<std::vector<PlaySample>> samples_;
  std::vector<Command> commands_;
  World* world_ = nullptr;
  // A picture may be made, is being made or is there, is there; the run's thread stands still for it.
  bool may_picture_ = false, has_picture_ = false, ready_picture_ = false, parked_ = false;
  bool busy_ = true, opening_ = true;
  std::atomic<bool> end_{false}, moving_{false};
  std::thread thread_;  // last
};

}  // namespace pliant
