// State that belongs to a run's thread (play_run.h): the session, its past, and its sources.
#pragma once

#include <map>
#include <optional>

#include "editor/play/play_run.h"
#include "engine/run/journal.h"
#include "engine/run/kept_recording.h"
#include "engine/session/session_run.h"

namespace pliant {

struct PlayRun::Inside {
  explicit Inside(PlayRun& of) : run(of) {}

  PlayRun& run;
  std::optional<Session> session;
  SessionRun* inner = nullptr;
  std::optional<Journal> journal;  // touch clock -> this thread
  std::vector<TickRow> rows;
  KeptRecording* kept = nullptr;  // the session's recorder fills and owns it; null: no probe and no tool
  std::vector<PlayHold> holds;    // so far
  PlayStatus status;              // as reported last
  std::vector<std::array<std::uint64_t, 4>> limited;
  std::vector<std::string> notes;

  bool opening = true, realtime = false, paused = false;
  double speed = 1.0;
  std::uint64_t steps = 0;  // single steps still to run
  double due = 0.0;         // [ticks] due by the wall clock
  std::uint64_t turned_ns = 0, paced_ns = 0, paced_tick = 0;
  double pace = 0.0;
  std::uint64_t shown_ns = 0, hashed = ~std::uint64_t{0}, flushed = ~std::uint64_t{0};
  std::string hash;
  std::vector<std::string> findings;

  // While repeating a past.
  bool again = false;
  std::uint64_t until = 0;  // [ticks]
  std::size_t next_hold = 0;

  // Sources.
  struct Level {  // as in the level
    DriverKind driver = DriverKind::kNull;
    Handle<Path> path;
    EffectorSource source = EffectorSource::kNone;
    std::string id;  // which device
  };
  std::vector<Level> of_level, before_past;                              // of each effector
  std::vector<PlaySource> sources;                                       // of each effector
  std::map<std::string, std::pair<std::string, std::string>> connected;  // by effector: a device's id and name
  std::vector<DeviceInfo> there;                                         // devices, as last listed
  double period = 0.0;     // [s] after which all scripts restart, as in the window of a run
  std::string moved;       // the effector moved by the mouse
  std::string watched;     // a tool that the mouse may drag
  dquat held{1, 0, 0, 0};  // its rotation while dragged

  void say(const std::string& note) { notes.push_back(note); }
  void report();  // publishes `status`
  PlayPast past() const;
  Level remember(const SessionEffector& effector) const;
  void bring_back(SessionEffector& effector, const Level& level);
  void apply(const std::string& name, const PlaySource& source);
  std::pair<PlaySource::Kind, std::string> wanted(const std::string& name, const PlaySource& source,
                                                  const Level& level);
  Status follow(const std::string& name, const PlaySource& source);
  Status take(SessionEffector& effector, dquat rotation);
  // Connects a device, or the mouse if there is none.
  Status connect(const SessionEffector& effector, const std::string& id, bool& by_mouse);
  bool feels() const;  // a real device, or one that cannot be stepped
  void view(DevicesView& out) const;
  void apply_all();
  void begin_past(const PlayPast& of, std::uint64_t until);
  void end_past();
  Status tick();
  void take_rows();
  void watch();
  void move_hand(double dt);
  void hold_again();
  void flush();
  bool still() const { return !realtime && (again ? inner->ticks >= until : paused && steps == 0); }
};

}  // namespace pliant
