// Play in place: successive runs of the edited level, and their results. On the interface's thread.
//
// A run is a PlayRun. Going back starts another run that repeats the past up to the chosen time; the previous picture
// is shown until then.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "content/device_answers.h"
#include "content/level/device_request.h"
#include "editor/core/editor.h"
#include "editor/play/play_run.h"
#include "editor/viewport/stage.h"

namespace pliant {

// The samples of one probe or tool: the last kKept seconds.
struct PlayTrace {
  static constexpr double kKept = 60.0;  // [s]
  std::string name;
  double radius = 0.0;  // [m]
  std::deque<PlaySample> samples;
  std::uint64_t touched = 0, gated = 0;  // [ticks] of the whole run: in contact; with force withheld by the gate
};

class Play {
 public:
  explicit Play(Editor& editor) : editor_(editor) {}
  ~Play();
  Play(const Play&) = delete;
  Play& operator=(const Play&) = delete;

  // Shows a scenery on the stage (Stage::show); empty: no pictures.
  std::function<void(std::function<std::unique_ptr<Scenery>()>)> show;
  std::map<std::string, PlaySource> sources;  // by probe or tool; others use the level's
  bool mouse_probe = true;                    // adds a probe for the mouse if the mouse moves nothing else
  bool realtime = false;
  double speed = 1.0;

  DeviceAnswers answers;  // devices that the user allows, per level
  // Requests of the level that need the user's consent and have no answer yet.
  std::vector<LevelRequest> asks() const;

  bool on() const { return run_ != nullptr; }
  // Running, or starting.
  bool paused() const { return on() && paused_; }
  bool ready() const;  // neither opening nor repeating the past
  bool may_step() const { return on() && paused_ && !status_.realtime; }
  void start();
  void pause(bool paused);
  void toggle();  // play, pause, resume
  void step(std::uint64_t ticks);
  void stop();
  void restart();
  void set_speed(double to);
  void set_source(const std::string& effector, const PlaySource& source);
  void order(const DeviceOrders& orders);  // of devices

  // --- Going back
  double oldest() const;  // [s] earliest time to go back to
  double latest() const;  // [s] latest time so far
  bool back() const { return status_.again || next_ != nullptr; }
  void go_to(double time);                       // [s]
  double going_to() const { return going_to_; }  // [s]
  double progress() const;                       // [1] of the repeated past

  // The past of the current run, or of the last one; null: none. `status().effectors` are its probes and tools.
  std::shared_ptr<const PlayPast> past();
  bool has_past() const { return ready() || (!on() && kept_ != nullptr); }

  // Once per frame.
  void update();
  // Called when the document has changed.
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
  std::shared_ptr<const PlayPast> past_;  // while going back
  std::shared_ptr<PlayKept> kept_;        // of the last run
  PlayStatus status_;
  std::vector<PlayTrace> traces_, before_;
  std::vector<std::vector<PlaySample>> taken_;
  bool paused_ = false, on_stage_ = false, said_later_ = false;
  double going_to_ = 0.0;
  std::size_t said_ = 0, said_next_ = 0;
};

}  // namespace pliant
