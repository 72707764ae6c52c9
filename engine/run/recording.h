// A recording: the pose of every probe in every tick, so that a run on the same level can be repeated to the bit.
//
// The file, little-endian: 8 bytes "pliantrc", u32 version, u32 probes, f64 rate [Hz], level name, a name per probe
// (u32 length and bytes each), u64 scene_hash() of the recorded scene, u32 settings and a text for each; then records,
// each preceded by a u8.
// 1, a tick: u64 index and per probe 7 f64 (x y z [m, world], qw qx qy qz) and a u8 (1: the device was ready; 2: it
// was, and its guard withheld the force; plus 4: an f64 follows, its grip).
// 2, an event of the following tick: u64 index, u8 kind, name, key (u32 length and bytes each), u32 vertex, 7 f64.
// 0, the end: a u64 hash of everything before.
// Older formats are read as well: 3 has ticks alone, without the u8; 1 has neither scene nor settings; the hash of 2
// covers less of a scene and is ignored.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "components/math.h"
#include "content/files/growing_file.h"
#include "runtime/hash.h"
#include "runtime/result.h"

namespace pliant {

struct RecordedPose {
  dvec3 position{0};  // [m] world
  dquat rotation{1, 0, 0, 0};
  bool ready = true;
  bool felt = true;    // false: its guard withheld the force
  bool grips = false;  // its device senses a grip
  double grip = 0.0;   // [1] 0 to 1
};

// Actions of a program on a session between two ticks, other than moving its probes (Session::set, set_hand_force...).
// World frame; `name`: of an object, a probe or a tool.
enum class EventKind : std::uint8_t {
  kSet = 1,     // key: EXT.KEY=VALUE
  kHandForce,   // force, torque
  kBodyForce,   // force, torque
  kPointForce,  // force, at `vertex`
  kPush,        // impulse, angular impulse
  kPointPush,   // impulse, at `vertex`
  kPlace,       // position, rotation w x y z
  kPresent,     // values[0]: 1 or 0
  kNewSource    // another source moves the probe; key: limits of its driver, one per line (engine/run/driver_limits.h)
};
inline constexpr EventKind kLastEvent = EventKind::kNewSource;

struct RecordedEvent {
  std::uint64_t tick = 0;  // takes effect before this tick
  EventKind kind = EventKind::kSet;
  std::string name, key;
  std::uint32_t vertex = 0;  // of the object's own vertices
  std::array<double, 7> values{};

  dvec3 first() const { return {values[0], values[1], values[2]}; }
  dvec3 second() const { return {values[3], values[4], values[5]}; }
};

struct RecordingHeader {
  std::string level;
  double rate = 1000.0;  // [Hz]
  std::vector<std::string> probes;
  std::uint64_t scene = 0;  // scene_hash() (engine/run/scene_hash.h); 0: unknown, in an older format
  // Settings on top of the level: NODE.EXT.KEY=VALUE; --unit=METRES; --error=BUDGET; limits of drivers
  // (engine/run/driver_limits.h).
  std::vector<std::string> settings;
};

// Follows the name of a recording whose `scene` is 0.
inline constexpr const char* kUnknownScene =
    " has an older format, which does not say whether the level is as it was: forces may differ; record it anew";

struct Recording {
  RecordingHeader header;
  std::vector<std::uint64_t> ticks;   // indices, ascending
  std::vector<RecordedPose> poses;    // [tick][probe]
  std::vector<RecordedEvent> events;  // by tick, in order of occurrence
};

// Bytes are untrusted. The error's `where` is `name`.
Result<Recording> parse_recording(const std::string& name, const std::string& bytes);
Result<Recording> read_recording(const std::filesystem::path& file);

// Where a recording goes: a file, or memory (kept_recording.h). Events come before the tick in which they take effect,
// a tick before its poses: one per probe, in order.
class RecordingSink {
 public:
  virtual ~RecordingSink() = default;
  virtual void tick(std::uint64_t index) = 0;
  virtual void pose(const RecordedPose& pose) = 0;
  virtual void event(const RecordedEvent& event) = 0;
  virtual const std::optional<Error>& failure() const = 0;
  virtual std::uint64_t ticks() const = 0;  // so far
  virtual Status finish() = 0;
};

// Writes to a temporary file that finish() moves into place. A failed write ends the recording: what was recorded
// before is kept.
class RecordingWriter final : public RecordingSink {
 public:
  // An existing file is an error; with `replace`, only one that is not a recording.
  static Result<RecordingWriter> create(const std::filesystem::path& file, const RecordingHeader& header,
                                        bool replace = false);
  RecordingWriter(RecordingWriter&&) = default;
  ~RecordingWriter() override;
  void tick(std::uint64_t index) override;
  void pose(const RecordedPose& pose) override;
  void event(const RecordedEvent& event) override;
  const std::optional<Error>& failure() const override { return out_->failure(); }
  std::uint64_t ticks() const override { return ticks_; }
  const std::filesystem::path& aside() const { return aside_; }  // path until finish()
  // Moves the file into place. A recording without a tick is an error and replaces nothing.
  Status finish() override;

 private:
  RecordingWriter() = default;
  template <class T>
  void put(T value);
  void put_text(const std::string& text);
  void add_record();
  std::filesystem::path file_, aside_;
  bool replace_ = false;
  std::size_t probes_ = 0, poses_ = 0;  // per tick; in the current record so far
  std::uint64_t ticks_ = 0;
  std::optional<GrowingFile> out_;
  std::string record_;
  Hash hash_;
  std::vector<std::uint64_t> hashes_;  // hash of everything before each pending record, and after the last
};

}  // namespace pliant
