// Play in place: runs of the edited level, one after another, and what is seen of them. The interface's thread.
//
// A run is a PlayRun. Going back makes another that has the same past again, as far as the chosen moment; the picture
// before stays until it is there.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "content/device_answers.h"
#include "content/level/device_request.h"
#include "editor/app/editor.h"
#include "editor/play/play_run.h"
#include "editor/viewport/stage.h"

namespace pliant {

// What one probe or tool has felt: the last kKept seconds.
struct PlayTrace {
  static constexpr double kKept = 60.0;  // [s]
  std::string name;
  double radius = 0.0;  // [m]
  std::deque<PlaySample> samples;
  std::uint64_t touched = 0, gated = 0;  // [ticks] of the whole run: in contact; force withheld by the gate
};

class Play {
 public:
  explicit Play(Editor& editor) : editor_(editor) {}
  ~Play();
  Play(const Play&) = delete;
  Play& operator=(const Play&) = delete;

  // What the stage shows (Stage::show); empty: there are no pictures.
  std::function<void(std::function<std::unique_ptr<Scenery>()>)> show;
  std::map<std::string, PlaySource> sources;  // by probe or tool; others have the level's
  bool mouse_probe = true;                    // a probe for the mouse is added where nothing else is moved by it
  bool realtime = false;
  double speed = 1.0;

  DeviceAnswers answers;  // which devices of which levels the user allows
  // What the level asks for, may not have, and nobody has answered yet.
  std::vector<LevelRequest> asks() const;

  bool on() const { return run_ != nullptr; }
  // Runs, or is about to.
  bool paused() const { return on() && paused_; }
  bool ready() const;  // it is not being opened or had again
  bool may_step() const { return on() && paused_ && !status_.realtime; }
  void start();
  void pause(bool paused);
  void toggle();  // play, pause, go on
  void step(std::uint64_t ticks);
  void stop();
  void restart();
  void set_speed(double to);
  void set_source(const std::string& effector, const PlaySource& source);
  void order(const DeviceOrders& orders);  // of devices

  // --- Going back
  double oldest() const;  // [s] that can be gone back to
  double latest() const;  // [s] that has been
  bool back() const { return status_.again || next_ != nullptr; }
  void go_to(double time);                       // [s]
  double going_to() const { return going_to_; }  // [s]
  double progress() const;                       // [1] of what is had again

  // What the run that is on has been so far, or what the last one was; null: there was none. `status().effectors` are
  // its probes and tools.
  std::shared_ptr<const PlayPast> past();
  bool has_past() const { return ready() || (!on() && kept_ != nullptr); }

  // Once a frame.
  void update();
  // The document is another one.
  void changed(const State& before, const State& after);

  const PlayStatus& status() const { return status_; }
  PlayRun* run() { return run_.get(); }
  PlayHand* hand() { return run_ ? &run_->hand : nullptr; }
  const std::vector<PlayTrace>& traces() const { return traces_; }
  const std::vector<PlayTrace>& before() const { return before_; }  // of the last run
  void forget_before() { before_.clear(); }

 private:
  PlayOptions options();
  void put_on_stage();
  void end_past(std::vector<PlayTrace>& traces, double time);
  void take_samples();
  void note_findings();

  Editor& editor_;
  std::shared_ptr<PlayRun> run_, next_;
  std::shared_ptr<const PlayPast> past_;  // while it is gone back in
  std::shared_ptr<PlayKept> kept_;        // of the last run
  PlayStatus status_;
  std::vector<PlayTrace> traces_, before_;
  std::vector<std::vector<PlaySample>> taken_;
  bool paused_ = false, on_stage_ = false, said_later_ = false;
  double going_to_ = 0.0;
  std::size_t said_ = 0, said_next_ = 0;
};

}  // namespace pliant
