// Internal state of a Session (pliant/session.h), and the thread that may access each part. The touch clock owns the
// world while it runs; the owner's thread and the clock communicate through exchanges.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "components/touch_event.h"
#include "components/world.h"
#include "content/level/level.h"
#include "engine/run/driver_link.h"
#include "engine/run/pose_recorder.h"
#include "engine/run/pose_replay.h"
#include "engine/run/recording.h"
#include "engine/run/runner.h"
#include "engine/session/live_edit.h"
#include "engine/session/object_shape.h"
#include "engine/session/session_history.h"
#include "engine/session/session_view.h"
#include "engine/session/session_world.h"
#include "engine/session/source_place.h"
#include "pliant/session.h"
#include "runtime/exchange.h"
#include "runtime/recorder.h"
#include "systems/soft/body/tool_body.h"
#include "systems/touch/model/contact_energy.h"
#include "systems/touch/model/local_model.h"

namespace pliant {

enum class EffectorSource : std::uint8_t { kNone, kReleased, kLevel, kPose, kPath, kDriver };

// [s] In real time a pose that was set is valid for kPrescribedHolds. The next pose is reached in the time since the
// previous one, at most kLongestWay: a program that draws 60 pictures a second sets 60 poses.
inline constexpr double kPrescribedHolds = 0.25, kLongestWay = 0.1;

struct PrescribedPose {
  dvec3 position{0};
  dquat rotation{1, 0, 0, 0};
  ProbeHold hold;  // of a probe that a mouse moves
};

// One probe or tool.
struct SessionEffector {
  std::string name;
  Entity entity, device;
  EffectorSource source = EffectorSource::kNone;
  Path path;                                                 // for kPath, for restart()
  DriverLink link;                                           // for kDriver
  GuardParameters guard;                                     // its device's, on connection
  dvec3 placed_position{0};                                  // [m] world: initial place in the scene
  dquat placed_rotation{1, 0, 0, 0};                         // for a driver that senses no rotation
  ProbeHold hold;                                            // owner's: sent with the following poses
  std::unique_ptr<TripleBuffer<PrescribedPose>> prescribed;  // owner -> touch clock
  bool renewed = false;  // touch clock's: the next tick is its source's first, and treats the device as lost
  // Touch clock's: interpolation to the newest pose that was set.
  bool placed = false;
  double heard_at = 0.0, lasts = 1e-3;  // [s] arrival time, and duration of the interpolation
  PrescribedPose from, now;
  PrescribedPose set;  // owner's: the last pose given
};

// A reading, and the places of its contacts on the collision mesh.
struct EffectorRow {
  Reading reading;
  std::array<uvec3, Reading::kMostContacts> vertices{};
  std::array<vec3, Reading::kMostContacts> weights{};  // [1] barycentric
};

Error work_stopped();

struct SessionRun {
  Scene scene;
  bool chosen = false;  // the models of objects with an error budget are chosen, once, in `scene`
  World world;
  std::vector<std::string> notes, objects;
  std::vector<Slider> sliders;
  std::vector<Entity> object_entities;
  std::vector<SessionEffector> effectors;
  // Values set by the owner, by object, by probe or tool. The world's copies belong to the touch clock.
  std::map<std::string, Deformable> surfaces;
  std::map<std::string, DeviceParameters> devices;
  std::map<std::string, LevelNode> bodies;  // soft and rigid bodies, probes, tools, effects: those extensions alone
  std::map<std::string, Entity> effects;    // kNoEntity: several have this name

  std::unique_ptr<Runner> runner;  // of this world; null after a failed restart
  std::uint64_t ticks = 0;         // done, in lockstep and in earlier real time
  std::uint64_t overruns = 0;
  const char* ended = nullptr;                          // reason why no tick may run until restart(); null: none
  double time = 0.0;                                    // [s] start of the next lockstep tick
  std::unique_ptr<Ring<Edit>> edits;                    // owner -> touch clock
  mutable TripleBuffer<std::vector<EffectorRow>> rows;  // touch clock -> owner
  SessionView view;                                     // owner's
  std::shared_ptr<int> alive;                           // lifetime token of this world for its observers
  std::unique_ptr<PoseRecorder> recorder;               // null: not recording
  std::optional<Recording> replayed;
  std::optional<PoseReplay> replay;             // of `replayed`
  std::map<std::string, std::string> settings;  // NODE.EXT.KEY -> value: changed by set()
  bool after_pause = false;                     // touch clock's: the next tick is the first after a pause
  Tick last;                                    // touch clock's: the current tick, or the last
  bool shown = true;                            // touch clock's: its readings are published
  std::function<void(Tick)> noted;              // touch clock's: last in every tick; must not allocate, wait or throw
  std::map<std::string, std::map<std::uint32_t, SourcePlace>> places;  // per object, places of pressed vertices

  // Geometry queries (session_queries.cpp). Owner's.
  std::vector<std::unique_ptr<ObjectShape>> shapes;  // per object; created on first use
  std::uint64_t looked = 0;                          // [ticks] + 1 of the state taken by look(), in lockstep
  // Readings of every tick, per effector (session_readings.cpp).
  std::size_t keeps = 0;  // [ticks]
  std::vector<std::unique_ptr<Recorder<EffectorRow>>> kept;
  std::unique_ptr<Recorder<TouchEvent>> events = std::make_unique<Recorder<TouchEvent>>(kMostEventsWaiting);
  std::uint64_t events_lost = 0;             // number of lost events reported to the owner
  std::vector<std::uint64_t> lost_reported;  // per effector: number of lost rows reported to the owner

  // Actions of the program other than moving its probes (session_events.cpp). Owner's.
  std::vector<RecordedEvent> standing;  // forces that stay until changed, and removed objects
  std::vector<std::uint8_t> taken_out;  // per object
  std::size_t replayed_events = 0;      // replayed events of the recording so far
  SessionHistory history;               // since time 0 (session_state.cpp)
  bool restoring = false;               // the history is being replayed: no driver is written

  static SessionRun& of(Session& session) { return *session.run_; }
  static const SessionRun& of(const Session& session) { return *session.run_; }
  explicit SessionRun(const Scene& from) : scene(from) {}
  ~SessionRun();

  Status prepare();  // scene -> world, all buffers sized
  // The steps of prepare(); `before`: the effectors of the world before a restart.
  Status remake(std::vector<SessionEffector>& before);
  Status spawn_world();
  Status list_named();        // effectors and objects; a Session identifies them by name
  void restore_parameters();  // before a restart, into the next world
  Status prepare_spawned();
  void keep_parameters();  // of a prepared world
  void attach_runner();
  void size_views();
  Status give_back_sources(std::vector<SessionEffector>& before);
  void keep_bodies();     // of a prepared world
  void restore_bodies();  // before a restart, into the next world
  SessionEffector* find_effector(const std::string& name);
  const SessionEffector* find_effector(const std::string& name) const;
  Result<Entity> find_object(const std::string& name) const;
  Result<DriverLink*> find_link(const std::string& name, const char* what);
  Error unknown_effector(const std::string& name) const;
  TouchClock* clock() const { return runner ? runner->clock() : nullptr; }  // null: lockstep
  Status stand_still(const char* what) const;                               // an error while the clocks run

  Status may_give(const SessionEffector& effector) const;  // an error if it has a source, or during a replay
  Status give(SessionEffector& effector, EffectorSource source);
  Status connect(const std::string& name, std::unique_ptr<Driver> driver, const std::string& id,
                 const std::string& claimed);
  void take_away(SessionEffector& effector, EffectorSource source);  // leaves it without a source that moves it
  void zero_drivers() noexcept;
  void end(const char* why) noexcept;      // all devices are lost, and zero is written
  void show_let_go() noexcept;             // readings without force
  void clock_ended() noexcept;             // called last on the touch clock
  void begin(SessionEffector& effector);   // starts another source: its driver's limits, and a new hand
  void forget(SessionEffector& effector);  // discards its pose until its source gives another

  // Distributes a force on a refined-mesh vertex over the source vertices around it.
  void share_out(const std::string& object, const Mesh& mesh, std::uint32_t vertex, vec3 force, std::vector<vec3>& out);
  void look();  // takes the newest state shown by the clocks
  void see();   // the same, once per state
  ObjectShape& shape(std::size_t object);
  const LevelMesh* given_mesh(const std::string& object) const;  // null: the surface was not given as triangles
  Geometry body_geometry(Entity entity, const std::string& object);
  ContactSide side(const ContactPlace& place);
  void name_contacts(EffectorRow& row);                                         // sets their triangles and vertices
  void place_vertices(Entity object, bool rest, std::vector<vec3>& out) const;  // from the view
  void size_kept();
  // Checks the event, sends it to the clocks, and notes it for the recording.
  Status send(RecordedEvent event, const char* what);
  Status send_to_hand(const RecordedEvent& event, const char* what);
  Status send_to_body(const RecordedEvent& event, const char* what);
  std::uint32_t note_event(const RecordedEvent& event);  // its number in the recording
  void note_new_source(Entity effector, const RecordedEvent& event);
  void keep_standing(const RecordedEvent& event);
  Status send_standing();  // to a new world

  // On the touch clock, or on the caller's thread in lockstep.
  void before(Tick tick);
  void begin_replay(Recording recording);
  Status send_to_object(const RecordedEvent& event, const char* what);  // kPlace, kPresent
  Status check_place(Entity object, const RecordedEvent& event) const;
  Status go_back(SavedState state);
  Status perform(const RecordedEvent& event);
  // NODE.EXT.KEY=VALUE, for keys that a session can change. kKeep: kept for the start of the next world.
  enum class Setting : std::uint8_t { kSend, kKeep };
  Status apply_setting(const std::string& setting, Setting how);
  // Applies settings in an order that keeps them valid: sliding friction must stay below static friction. Returns the
  // errors of the rejected ones.
  std::vector<Error> apply_settings(std::vector<std::string> waiting, Setting how);
  void note_history(Tick tick);
  SavedState saved_state() const;
  Status run_again(SavedState state);  // from time 0, in a new world
  void go_on(const SavedState& state, std::vector<EffectorSource>& sources, std::vector<DriverLink>& links,
             std::vector<HapticDevice>& devices_before);
  void replay_events(std::uint64_t tick);  // events that take effect before this tick
  void read_prescribed(SessionEffector& effector, Tick tick);
  Status start_drivers();  // for real time; if one fails, those already started are halted
  void halt_drivers() noexcept;
  void after(Tick tick);
  void idle();
};

}  // namespace pliant
