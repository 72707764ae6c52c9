// What a Session holds (pliant/session.h), and which thread may touch it: the world belongs to the touch clock while
// one runs; what the owner's thread and the clock tell each other goes through exchanges.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "components/world.h"
#include "content/level/level.h"
#include "engine/recording.h"
#include "engine/session_view.h"
#include "engine/soft_clock.h"
#include "engine/touch_clock.h"
#include "pliant/session.h"
#include "runtime/exchange.h"
#include "runtime/recorder.h"
#include "runtime/schedule.h"

namespace pliant {

enum class HandSource : std::uint8_t { kNone, kLevel, kPose, kPath, kDriver };

// [s] A pose that was told in real time holds so long; the next one is reached in the time since the one before, at
// most kLongestWay: a program that draws 60 pictures a second tells 60 poses.
inline constexpr double kToldHolds = 0.25, kLongestWay = 0.1;

struct ToldPose {
  dvec3 position{0};
  dquat rotation{1, 0, 0, 0};
};

// One probe or tool.
struct SessionHand {
  std::string name;
  Entity entity, device;
  HandSource source = HandSource::kNone;
  Path path;                                     // of kPath, for restart()
  DeviceCapabilities can;                        // its, while it is connected
  std::unique_ptr<Driver> driver;                // of kDriver
  std::unique_ptr<TripleBuffer<ToldPose>> told;  // owner -> touch clock
  // Touch clock's: the way to the newest pose that was told.
  bool placed = false;
  double heard_at = 0.0, lasts = 1e-3;  // [s] when that came, and how long the way to it takes
  ToldPose from, now;
};

// A reading, and where on the collision mesh its contacts press.
struct HandRow {
  Reading reading;
  std::array<uvec3, Reading::kMostContacts> vertices{};
  std::array<vec3, Reading::kMostContacts> weights{};  // [1] barycentric
};

// One probe's or tool's pose of one tick, on its way into a recording.
struct PoseRow {
  std::uint64_t tick = 0;
  RecordedPose pose;
};

// A recording that is being written. Rows come from the clock; who owns the session, or a thread of its own in real
// time, writes them.
class SessionRecorder {
 public:
  SessionRecorder(RecordingWriter writer, std::size_t hands);
  void note(std::uint64_t tick, const HapticDevice& device);  // touch clock: every hand, in order
  void drain();
  std::size_t room() const { return room_; }  // [ticks] that may wait
  void start();                               // a thread drains from now on
  Status finish();

 private:
  RecordingWriter writer_;
  std::size_t hands_, room_;
  std::size_t written_ = 0;  // poses of the tick under way
  Recorder<PoseRow> rows_;
  std::vector<PoseRow> taken_;
  std::jthread thread_;
};

// A parameter that changes between ticks.
struct Edit {
  Entity entity;
  std::uint32_t key = 0;  // into live_keys()
  double value = 0.0;
};

struct Session::Parts {
  Scene scene;
  World world;
  std::vector<std::string> notes, objects;
  std::vector<Entity> object_entities;
  std::vector<SessionHand> hands;
  // As the owner has set them: by object, by probe or tool. The world's own are the touch clock's.
  std::map<std::string, Deformable> surfaces;
  std::map<std::string, DeviceParameters> devices;

  std::optional<Schedule<World>> schedule;
  std::unique_ptr<SoftClock> soft;
  std::unique_ptr<TouchClock> clock;  // null: lockstep
  std::uint64_t ticks = 0;            // done, in lockstep and in earlier real time
  std::uint64_t overruns = 0;
  bool lived = false;                               // it has run in real time: its devices are lost until restart()
  double time = 0.0;                                // [s] where the next lockstep tick begins
  std::unique_ptr<Ring<Edit>> edits;                // owner -> touch clock
  mutable TripleBuffer<std::vector<HandRow>> rows;  // touch clock -> owner
  SessionView view;                                 // owner's
  std::unique_ptr<SessionRecorder> recorder;        // null: nothing is recorded
  std::optional<Recording> replayed;

  explicit Parts(const Scene& from) : scene(from) {}
  ~Parts();

  Status prepare();  // scene -> world, all sized
  SessionHand* find_hand(const std::string& name);
  const SessionHand* find_hand(const std::string& name) const;
  Result<Entity> find_object(const std::string& name) const;
  Error unknown_hand(const std::string& name) const;
  Status stand_still(const char* what) const;  // an error while the clocks run

  Status give(SessionHand& hand, HandSource source);  // once; release() first
  void close_driver(SessionHand& hand) noexcept;
  void zero_drivers() noexcept;
  DeviceParameters limits_of(const SessionHand& hand) const;  // the level's or the driver's, whichever are smaller

  void look();  // the newest that the clocks show

  // On the touch clock, or the caller's thread in lockstep.
  void before(Tick tick);
  Tick replayed_tick();  // its poses are the devices' then
  void read_told(SessionHand& hand, Tick tick);
  void read_driver(SessionHand& hand, Tick tick);
  void after(Tick tick);
  void idle();
};

// The keys that set() changes: of objects and of the devices of probes and tools.
struct LiveKey {
  const char* key;
  double DeformableParameters::*surface = nullptr;
  double DeviceParameters::*device = nullptr;
};
const std::vector<LiveKey>& live_keys();
// Whether a surface of this mesh can take it.
Status check_edit(const std::string& name, const Deformable& surface, const Mesh& mesh, const LiveKey& key,
                  double value);
// Does not allocate.
void apply_edit(World& world, const Edit& edit);

}  // namespace pliant
