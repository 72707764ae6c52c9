// What a Session holds (pliant/session.h), and which thread may touch it: the world belongs to the touch clock while
// one runs; what the owner's thread and the clock exchange goes through exchanges.
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

#include "components/world.h"
#include "content/level/level.h"
#include "engine/run/driver_link.h"
#include "engine/run/pose_recorder.h"
#include "engine/run/recording.h"
#include "engine/run/replay.h"
#include "engine/run/runner.h"
#include "engine/session/object_shape.h"
#include "engine/session/session_history.h"
#include "engine/session/session_view.h"
#include "engine/session/source_place.h"
#include "pliant/session.h"
#include "runtime/exchange.h"
#include "runtime/recorder.h"
#include "systems/soft/body/tool_body.h"
#include "systems/touch/contact_energy.h"
#include "systems/touch/local_model.h"

namespace pliant {

enum class EffectorSource : std::uint8_t { kNone, kReleased, kLevel, kPose, kPath, kDriver };

// [s] A pose that was was set in real time holds so long; the next one is reached in the time since the one before, at
// most kLongestWay: a program that draws 60 pictures a second sets 60 poses.
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
  Path path;                                                 // of kPath, for restart()
  DriverLink link;                                           // of kDriver
  GuardParameters guard;                                     // its device's, when it is connected
  dvec3 placed_position{0};                                  // [m] world: where the scene put it
  dquat placed_rotation{1, 0, 0, 0};                         // where its driver senses none
  ProbeHold hold;                                            // owner's: goes with the poses from now on
  std::unique_ptr<TripleBuffer<PrescribedPose>> prescribed;  // owner -> touch clock
  bool renewed = false;  // touch clock's: the next tick is its source's first, and has it lost
  // Touch clock's: the way to the newest pose that was set.
  bool placed = false;
  double heard_at = 0.0, lasts = 1e-3;  // [s] when that came, and how long the way to it takes
  PrescribedPose from, now;
  PrescribedPose set;  // owner's: the last that was given
};

// A reading, and where on the collision mesh its contacts press.
struct EffectorRow {
  Reading reading;
  std::array<uvec3, Reading::kMostContacts> vertices{};
  std::array<vec3, Reading::kMostContacts> weights{};  // [1] barycentric
};

// Parameters that change between ticks, all of their kind: what the touch clock takes of them.
struct SurfaceSetting {
  DeformableParameters now;
  Motion motion;
  ShareKernel kernel;
};
struct ProbeSetting {
  double radius = 0.0;  // [m]
};
struct WeightSetting {
  dvec3 weight{0};  // [N] of a tool that nothing carries
};
// What the owner does to hands and objects, beside parameters.
struct EventEdit {
  EventKind kind = EventKind::kSet;  // kSet, and the soft clock's: only stamped here
  double value = 0.0;
  dvec3 force{0}, torque{0};  // of kHandForce; of kPlace, force is the position [m]
  dquat rotation{1, 0, 0, 0};
};
// On its way to the touch clock, which says in which tick it took it.
struct Edit {
  Entity entity;
  std::variant<EventEdit, SurfaceSetting, DeviceParameters, ProbeSetting, CouplingSetting, WeightSetting> now;
  std::uint32_t number = 0;  // of its event in the recording under way; 0: none
};

Error work_stopped();

struct Session::Parts {
  Scene scene;
  bool chosen = false;  // the models of objects with an error budget: once, in `scene`
  World world;
  std::vector<std::string> notes, objects;
  std::vector<Entity> object_entities;
  std::vector<SessionEffector> effectors;
  // As the owner has set them: by object, by probe or tool. The world's own are the touch clock's.
  std::map<std::string, Deformable> surfaces;
  std::map<std::string, DeviceParameters> devices;
  std::map<std::string, LevelNode> bodies;  // soft and rigid bodies, probes and tools: those extensions alone

  std::unique_ptr<Runner> runner;  // of this world; null after a restart that failed
  std::uint64_t ticks = 0;         // done, in lockstep and in earlier real time
  std::uint64_t overruns = 0;
  const char* ended = nullptr;                          // why no tick may run until restart()
  double time = 0.0;                                    // [s] where the next lockstep tick begins
  std::unique_ptr<Ring<Edit>> edits;                    // owner -> touch clock
  mutable TripleBuffer<std::vector<EffectorRow>> rows;  // touch clock -> owner
  SessionView view;                                     // owner's
  std::shared_ptr<int> run;                             // of this world: whoever looks at it knows when it has gone
  std::unique_ptr<PoseRecorder> recorder;               // null: nothing is recorded
  std::optional<Recording> replayed;
  std::optional<Replay> replay;                 // of `replayed`
  std::map<std::string, std::string> settings;  // NODE.EXT.KEY -> value: what set() changed
  bool after_pause = false;                     // touch clock's: the next tick is the first after a pause
  Tick last;                                    // touch clock's: the tick under way, or the last
  bool shown = true;                            // touch clock's: its readings are published
  std::function<void(Tick)> noted;              // touch clock's: last of every tick; must not allocate, wait or throw
  std::map<std::string, std::map<std::uint32_t, SourcePlace>> places;  // by object, of vertices that were pressed

  // Questions about geometry (session_queries.cpp). Owner's.
  std::vector<std::unique_ptr<ObjectShape>> shapes;  // of each object; made when it is first asked about
  std::uint64_t looked = 0;                          // [ticks] + 1 of the state that look() has taken, in lockstep
  // Every tick's rows, of each effector (session_readings.cpp).
  std::size_t keeps = 0;  // [ticks]
  std::vector<std::unique_ptr<Recorder<EffectorRow>>> kept;
  std::vector<std::uint64_t> lost_told;  // of each: rows that the owner knows to be lost

  // What the program does beside moving its probes (session_events.cpp). Owner's.
  std::vector<RecordedEvent> standing;  // forces that are constant until they change, what is taken out
  std::vector<std::uint8_t> taken_out;  // of each object
  std::size_t replayed_events = 0;      // of the recording: done
  SessionHistory history;               // since time 0 (session_state.cpp)
  bool restoring = false;               // the history runs again: no driver is written

  explicit Parts(const Scene& from) : scene(from) {}
  ~Parts();

  Status prepare();  // scene -> world, all sized
  Status remake(std::vector<SessionEffector>& before);
  void keep_bodies();     // of a world that is prepared
  void restore_bodies();  // before a restart, into the world to come
  SessionEffector* find_effector(const std::string& name);
  const SessionEffector* find_effector(const std::string& name) const;
  Result<Entity> find_object(const std::string& name) const;
  Result<DriverLink*> find_link(const std::string& name, const char* what);
  Error unknown_effector(const std::string& name) const;
  TouchClock* clock() const { return runner ? runner->clock() : nullptr; }  // null: lockstep
  Status stand_still(const char* what) const;                               // an error while the clocks run

  Status may_give(const SessionEffector& effector) const;  // not if it has a source, or replays
  Status give(SessionEffector& effector, EffectorSource source);
  Status connect(const std::string& name, std::unique_ptr<Driver> driver, const std::string& id,
                 const std::string& claimed);
  void take_away(SessionEffector& effector, EffectorSource source);  // nobody moves it
  void zero_drivers() noexcept;
  void end(const char* why) noexcept;      // every device is lost, and written zero
  void show_let_go() noexcept;             // readings without force
  void clock_ended() noexcept;             // last of all on the touch clock
  void begin(SessionEffector& effector);   // another source: its driver's limits, and a hand that is new
  void forget(SessionEffector& effector);  // its pose, until its source says another

  // A force on a vertex of a refined mesh, shared by the source vertices around it.
  void share_out(const std::string& object, const Mesh& mesh, std::uint32_t vertex, vec3 force, std::vector<vec3>& out);
  void look();  // the newest that the clocks show
  void see();   // the same, once a state
  ObjectShape& shape(std::size_t object);
  const LevelMesh* given_mesh(const std::string& object) const;  // null: its surface was not given as triangles
  Geometry body_geometry(Entity entity, const std::string& object);
  ContactSide side(const ContactPlace& place);
  void name_contacts(EffectorRow& row);                                         // their triangles and vertices
  void place_vertices(Entity object, bool rest, std::vector<vec3>& out) const;  // of the view
  void size_kept();
  // Checks, sends to the clocks, and notes for whatever is recorded.
  Status send(RecordedEvent event, const char* what);
  Status send_to_hand(const RecordedEvent& event, const char* what);
  Status send_to_body(const RecordedEvent& event, const char* what);
  std::uint32_t note_event(const RecordedEvent& event);  // its number in the recording
  void keep_standing(const RecordedEvent& event);
  Status send_standing();  // to a new world

  // On the touch clock, or the caller's thread in lockstep.
  void before(Tick tick);
  void begin_replay(Recording recording);
  Status send_to_object(const RecordedEvent& event, const char* what);  // kPlace, kPresent
  Status check_place(Entity object, const RecordedEvent& event) const;
  Status go_back(SavedState state);
  Status perform(const RecordedEvent& event);
  // NODE.EXT.KEY=VALUE, of the keys that a session can change. kKeep: for the next world to begin with.
  enum class Setting : std::uint8_t { kSend, kKeep };
  Status apply_setting(const std::string& setting, Setting how);
  // In an order in which they hold: a coefficient of sliding friction is below that of static friction. Those refused.
  std::vector<Error> apply_settings(std::vector<std::string> waiting, Setting how);
  void note_history(Tick tick);
  SavedState saved_state() const;
  Status run_again(SavedState state);  // from time 0, in a new world
  void go_on(const SavedState& state, std::vector<EffectorSource>& sources, std::vector<DriverLink>& links,
             std::vector<HapticDevice>& devices_before);
  void replay_events(std::uint64_t tick);  // those that take effect before it
  void read_prescribed(SessionEffector& effector, Tick tick);
  Status start_drivers();  // of real time; those that did are halted where one does not
  void halt_drivers() noexcept;
  void after(Tick tick);
  void idle();
};

// Keys that set() changes and that are one number: of surfaces, and of the devices of probes and tools.
struct LiveKey {
  const char* key;
  double DeformableParameters::*surface = nullptr;
  double DeviceParameters::*device = nullptr;
};
const std::vector<LiveKey>& live_keys();
// Does not allocate.
void apply_edit(World& world, const Edit& edit);

}  // namespace pliant
