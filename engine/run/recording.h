// A recording: the pose of every probe at every tick, so that a run can be repeated to the bit on the same level.
//
// The file, little-endian: 8 bytes "pliantrc", u32 version, u32 probes, f64 rate [Hz], level name, a name per probe
// (u32 length and bytes each), u64 scene_hash() of the scene it was made with, u32 settings and a text for each; then
// records, each with a u8 in front. 1, a tick: u64 index and per probe 7 f64 (x y z [m, world], qw qx qy qz) and a u8
// (1: the device was ready; 2: it was, and its guard let nothing leave). 2, an event of the tick that follows: u64
// index, u8 kind, name, key (u32 length and bytes each), u32 vertex, 7 f64. 0, the end: a u64 hash of all before it.
// Older formats are read as well: 3 has ticks alone, without the u8, 1 neither scene nor settings; the hash of 2 saw
// less of a scene and is passed over.
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
  bool felt = true;  // false: its guard let nothing leave
};

// What a program does to a session between two ticks, beside moving its probes (Session::set, set_hand_force...).
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
  kNewSource    // another source moves the probe; key: limits of its driver, a line each (engine/run/driver_limits.h)
};
inline constexpr EventKind kLastEvent = EventKind::kNewSource;

struct RecordedEvent {
  std::uint64_t tick = 0;  // takes effect before it
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
  std::uint64_t scene = 0;  // scene_hash() (engine/scene_hash.h); 0: not known, of an older format
  // NODE.EXT.KEY=VALUE that were set on top of the level; --unit=METRES; --error=BUDGET; limits of drivers
  // (engine/run/driver_limits.h).
  std::vector<std::string> settings;
};

// Behind the name of a recording whose `scene` is 0.
inline constexpr const char* kUnknownScene =
    " has an older format, which does not say whether the level is as it was: forces may differ; record it anew";

struct Recording {
  RecordingHeader header;
  std::vector<std::uint64_t> ticks;   // indices, ascending
  std::vector<RecordedPose> poses;    // [tick][probe]
  std::vector<RecordedEvent> events;  // by tick, in the order in which they happened
};

// Untrusted bytes. The error's `where` is `name`.
Result<Recording> parse_recording(const std::string& name, const std::string& bytes);
Result<Recording> read_recording(const std::filesystem::path& file);

// Writes aside; the file appears with finish(). A write that fails ends it: what was recorded until then is kept.
class RecordingWriter {
 public:
  // A file that is there is refused; with `replace`, one that is no recording.
  static Result<RecordingWriter> create(const std::filesystem::path& file, const RecordingHeader& header,
                                        bool replace = false);
  RecordingWriter(RecordingWriter&&) = default;
  ~RecordingWriter();
  void tick(std::uint64_t index);  // then one pose for each probe, in order
  void pose(const RecordedPose& pose);
  void event(const RecordedEvent& event);  // before the tick that it takes effect in
  const std::optional<Error>& failure() const { return out_->failure(); }
  std::uint64_t ticks() const { return ticks_; }                 // so far
  const std::filesystem::path& aside() const { return aside_; }  // where it is until finish()
  // Into place. A recording without a tick is an error, and replaces nothing.
  Status finish();

 private:
  RecordingWriter() = default;
  template <class T>
  void put(T value);
  void put_text(const std::string& text);
  void add_record();
  std::filesystem::path file_, aside_;
  bool replace_ = false;
  std::size_t probes_ = 0, poses_ = 0;  // of a tick; in the record so far
  std::uint64_t ticks_ = 0;
  std::optional<GrowingFile> out_;
  std::string record_;
  Hash hash_;
  std::vector<std::uint64_t> hashes_;  // of all before each record that waits to be written, and behind the last
};

}  // namespace pliant
