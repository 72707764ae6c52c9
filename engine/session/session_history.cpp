// The bytes of a saved state, little-endian: 8 bytes "pliantst", u32 version, f64 rate, u64 scene_hash(), texts (u32
// length and bytes each) and numbers in the order of SavedState, lists preceded by a u32 count. Poses are run-length
// encoded: u32 number of ticks in which all effectors stand still, then a pose for each. Last a u64 hash of everything
// before.
#include "engine/session/session_history.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "content/files/limits.h"
#include "runtime/hash.h"

namespace pliant {
namespace {

constexpr char kStateMagic[8] = {'p', 'l', 'i', 'a', 'n', 't', 's', 't'};
constexpr std::uint32_t kStateVersion = 2;
constexpr std::uint32_t kMostTexts = 65536, kMostText = 65536;

class Packer {
 public:
  template <class T>
  void put(T value) {
    const auto* p = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), p, p + sizeof value);
  }
  void put_text(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes.insert(bytes.end(), text.begin(), text.end());
  }
  void put_pose(const HistoryPose& pose) {
    for (const double v : {pose.position.x, pose.position.y, pose.position.z, pose.rotation.w, pose.rotation.x,
                           pose.rotation.y, pose.rotation.z, pose.sensed_at})
      put(v);
    put(static_cast<std::uint8_t>((pose.ready ? 1 : 0) | (pose.felt ? 2 : 0) | (pose.grips ? 4 : 0)));
    if (pose.grips) put(pose.grip);
  }
  std::vector<std::uint8_t> bytes;
};

// After a short read everything is zero and `ok` is false.
class Unpacker {
 public:
  explicit Unpacker(const std::vector<std::uint8_t>& from, std::size_t begin, std::size_t end)
      : bytes_(from), at_(begin), end_(end) {}
  template <class T>
  T get() {
    T value{};
    if (!take(sizeof value)) return value;
    std::memcpy(&value, bytes_.data() + at_ - sizeof value, sizeof value);
    return value;
  }
  std::string get_text() {
    const auto size = get<std::uint32_t>();
    if (size > kMostText || !take(size)) return ok = false, std::string();
    return {bytes_.begin() + static_cast<std::ptrdiff_t>(at_ - size),
            bytes_.begin() + static_cast<std::ptrdiff_t>(at_)};
  }
  std::uint32_t get_count(std::uint32_t most) {
    const auto count = get<std::uint32_t>();
    return count <= most ? count : (ok = false, 0u);
  }
  double get_number() {
    const auto value = get<double>();
    ok = ok && std::isfinite(value);
    return value;
  }
  HistoryPose get_pose() {
    HistoryPose pose;
    for (double* v : {&pose.position.x, &pose.position.y, &pose.position.z, &pose.rotation.w, &pose.rotation.x,
                      &pose.rotation.y, &pose.rotation.z, &pose.sensed_at})
      *v = get_number();
    const auto bits = get<std::uint8_t>();
    pose.ready = (bits & 1) != 0;
    pose.felt = (bits & 2) != 0;
    if ((pose.grips = (bits & 4) != 0)) pose.grip = get_number();
    ok = ok && bits < 8 && pose.grip >= 0.0 && pose.grip <= 1.0;
    return pose;
  }
  bool at_end() const { return at_ == end_; }
  bool ok = true;

 private:
  bool take(std::size_t size) {
    if (!ok || end_ - at_ < size) return ok = false;
    at_ += size;
    return true;
  }
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_, end_;
};

void put_event(Packer& out, const RecordedEvent& event) {
  out.put(event.tick);
  out.put(static_cast<std::uint8_t>(event.kind));
  out.put_text(event.name);
  out.put_text(event.key);
  out.put(event.vertex);
  for (const double value : event.values) out.put(value);
}

RecordedEvent get_event(Unpacker& in) {
  RecordedEvent event;
  event.tick = in.get<std::uint64_t>();
  const auto kind = in.get<std::uint8_t>();
  in.ok = in.ok && kind >= 1 && kind <= static_cast<std::uint8_t>(kLastEvent);
  event.kind = in.ok ? static_cast<EventKind>(kind) : EventKind::kSet;
  event.name = in.get_text();
  event.key = in.get_text();
  event.vertex = in.get<std::uint32_t>();
  for (double& value : event.values) value = in.get_number();
  return event;
}

void put_source(Packer& out, const SavedSource& source) {
  out.put(source.kind);
  out.put(source.path);
  out.put(static_cast<std::uint8_t>((source.placed ? 1 : 0) | (source.waits ? 2 : 0)));
  out.put(source.heard_at);
  out.put(source.lasts);
  for (const HistoryPose* pose : {&source.from, &source.now, &source.to}) out.put_pose(*pose);
}

SavedSource get_source(Unpacker& in) {
  SavedSource source;
  source.kind = in.get<std::uint8_t>();
  source.path = in.get<std::uint64_t>();
  const auto bits = in.get<std::uint8_t>();
  source.placed = (bits & 1) != 0;
  source.waits = (bits & 2) != 0;
  source.heard_at = in.get_number();
  source.lasts = in.get_number();
  in.ok = in.ok && source.lasts > 0.0;
  for (HistoryPose* pose : {&source.from, &source.now, &source.to}) *pose = in.get_pose();
  return source;
}

// Compares bits, so that -0 is restored as -0.
bool same_bits(const HistoryPose& a, const HistoryPose& b) {
  const auto same = [](double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  for (int k = 0; k < 3; ++k)
    if (!same(a.position[k], b.position[k])) return false;
  for (int k = 0; k < 4; ++k)
    if (!same(a.rotation[k], b.rotation[k])) return false;
  return same(a.sensed_at, b.sensed_at) && a.ready == b.ready && a.felt == b.felt && a.grips == b.grips &&
         same(a.grip, b.grip);
}

bool stands_still(const std::vector<HistoryPose>& poses, std::size_t effectors, std::size_t a, std::size_t b) {
  for (std::size_t i = 0; i < effectors; ++i)
    if (!same_bits(poses[a * effectors + i], poses[b * effectors + i])) return false;
  return true;
}

void put_poses(Packer& out, const SavedState& state) {
  const std::size_t n = state.effectors.size();
  for (std::uint64_t tick = 0; tick < state.ticks && n > 0;) {
    std::uint64_t end = tick + 1;
    while (end < state.ticks && end - tick < 0xffffffffu && stands_still(state.history.poses, n, tick, end)) ++end;
    out.put(static_cast<std::uint32_t>(end - tick));
    for (std::size_t i = 0; i < n; ++i) out.put_pose(state.history.poses[tick * n + i]);
    tick = end;
  }
}

void get_poses(Unpacker& in, SavedState& state) {
  const std::size_t n = state.effectors.size();
  if (state.ticks > most(limits::kJournal) / (sizeof(HistoryPose) * std::max<std::size_t>(1, n))) in.ok = false;
  if (n == 0) return;
  std::vector<HistoryPose> row(n);
  for (std::uint64_t tick = 0; tick < state.ticks && in.ok;) {
    const auto run = in.get<std::uint32_t>();
    if (run == 0 || run > state.ticks - tick) in.ok = false;
    for (HistoryPose& pose : row) pose = in.get_pose();
    for (std::uint32_t k = 0; k < run && in.ok; ++k)
      state.history.poses.insert(state.history.poses.end(), row.begin(), row.end());
    tick += run;
  }
}

std::uint64_t hash_of(const std::vector<std::uint8_t>& bytes, std::size_t size) {
  Hash hash;
  hash.add_bytes(bytes.data(), size);
  return hash.value();
}

}  // namespace

std::vector<std::uint8_t> pack_state(const SavedState& state) {
  Packer out;
  out.bytes.insert(out.bytes.end(), std::begin(kStateMagic), std::end(kStateMagic));
  out.put(kStateVersion);
  out.put(state.rate);
  out.put(state.scene);
  out.put(static_cast<std::uint32_t>(state.effectors.size()));
  for (const std::string& name : state.effectors) out.put_text(name);
  out.put(state.ticks);
  for (const SavedSource& source : state.sources) put_source(out, source);
  out.put(static_cast<std::uint32_t>(state.history.begun.size()));
  for (const auto& [key, value] : state.history.begun) out.put_text(key), out.put_text(value);
  out.put(static_cast<std::uint64_t>(state.history.events.size()));
  for (const RecordedEvent& event : state.history.events) put_event(out, event);
  put_poses(out, state);
  out.put(hash_of(out.bytes, out.bytes.size()));
  return std::move(out.bytes);
}

Result<SavedState> unpack_state(const std::vector<std::uint8_t>& bytes) {
  const char* const kWhere = "Session::restore_state";
  constexpr std::size_t kEnd = sizeof(std::uint64_t), kLeast = sizeof kStateMagic + sizeof(std::uint32_t) + kEnd;
  if (bytes.size() < kLeast || std::memcmp(bytes.data(), kStateMagic, sizeof kStateMagic) != 0)
    return Error{kWhere, "these bytes are no state", "give what Session::save_state() returned"};
  Unpacker in(bytes, sizeof kStateMagic, bytes.size() - kEnd);
  if (const auto version = in.get<std::uint32_t>(); version != kStateVersion)
    return Error{kWhere,
                 "the state has version " + std::to_string(version) + ", this is " + std::to_string(kStateVersion),
                 "save it again"};
  const Error damaged{kWhere, "the state ends too early or is damaged", "save it again"};
  std::uint64_t expected = 0;
  std::memcpy(&expected, bytes.data() + bytes.size() - kEnd, kEnd);
  if (expected != hash_of(bytes, bytes.size() - kEnd)) return damaged;
  SavedState state;
  state.rate = in.get_number();
  state.scene = in.get<std::uint64_t>();
  for (std::uint32_t n = in.get_count(kMostTexts); n > 0 && in.ok; --n) state.effectors.push_back(in.get_text());
  state.ticks = in.get<std::uint64_t>();
  for (std::size_t i = 0; i < state.effectors.size() && in.ok; ++i) state.sources.push_back(get_source(in));
  for (std::uint32_t n = in.get_count(kMostTexts); n > 0 && in.ok; --n) {
    std::string key = in.get_text();
    state.history.begun[std::move(key)] = in.get_text();
  }
  std::uint64_t last = 0;
  for (auto n = in.get<std::uint64_t>(); n > 0 && in.ok; --n) {
    state.history.events.push_back(get_event(in));
    in.ok = in.ok && state.history.events.back().tick >= last && state.history.events.back().tick <= state.ticks;
    last = state.history.events.back().tick;
  }
  if (in.ok) get_poses(in, state);
  if (!in.ok || !in.at_end()) return damaged;
  return state;
}

}  // namespace pliant
