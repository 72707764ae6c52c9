#include "engine/run/recording.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "content/files/file_io.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr char kMagic[8] = {'p', 'l', 'i', 'a', 'n', 't', 'r', 'c'};
constexpr std::uint32_t kVersion = 4, kOfSettings = 2, kOfScene = 3, kOfEvents = 4;  // the first that has them
constexpr std::uint32_t kMaxProbes = 4096, kMaxName = 4096, kMaxSettings = 4096;
constexpr std::uint8_t kEnd = 0, kTick = 1, kEvent = 2;
constexpr std::size_t kPoseBytes = 7 * sizeof(double) + 1;

// Reads values from untrusted bytes; after a short read everything is zero and `ok` is false.
struct Reader {
  const std::string& bytes;
  std::size_t at = 0;
  bool ok = true;

  template <class T>
  T get() {
    T value{};
    if (!ok || bytes.size() - at < sizeof value) {
      ok = false;
      return value;
    }
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
  }
  std::string text() {
    const std::uint32_t size = get<std::uint32_t>();
    if (!ok || size > kMaxName || bytes.size() - at < size) {
      ok = false;
      return {};
    }
    at += size;
    return bytes.substr(at - size, size);
  }
};

// The writer hashed each value separately, so the reader hashes value by value too.
struct HashingReader : Reader {
  Hash hash{};
  template <class T>
  T get() {
    const T value = Reader::get<T>();
    if (ok) hash.add(value);
    return value;
  }
  std::string text() {
    const std::string text = Reader::text();
    if (ok) {
      hash.add(static_cast<std::uint32_t>(text.size()));
      hash.add_bytes(text.data(), text.size());
    }
    return text;
  }
};

constexpr int kGrips = 4;  // in the u8 of a pose

bool sound(const RecordedPose& pose) {
  const dquat& q = pose.rotation;
  const double norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return std::isfinite(pose.position.x) && std::isfinite(pose.position.y) && std::isfinite(pose.position.z) &&
         std::abs(norm - 1.0) < 1e-3 && pose.grip >= 0.0 && pose.grip <= 1.0;  // false for NaN
}

Error too_short(const std::string& name) {
  return {name, "ends too early or is damaged", "record it again"};
}

Status read_poses(const std::string& name, HashingReader& in, std::uint32_t probes, std::uint64_t index,
                  Recording& recording) {
  recording.ticks.push_back(index);
  for (std::uint32_t i = 0; i < probes; ++i) {
    RecordedPose pose;
    for (double* value : {&pose.position.x, &pose.position.y, &pose.position.z, &pose.rotation.w, &pose.rotation.x,
                          &pose.rotation.y, &pose.rotation.z})
      *value = in.get<double>();
    const auto byte = in.get<std::uint8_t>();
    const int state = byte & ~kGrips;
    if ((pose.grips = (byte & kGrips) != 0)) pose.grip = in.get<double>();
    pose.ready = state == 1 || state == 2;
    pose.felt = state != 2;
    if (!in.ok) return too_short(name);
    if (!sound(pose))
      return Error{name,
                   "has a pose at tick " + std::to_string(index) +
                       " that is not finite, not a unit quaternion, or "
                       "with a grip that is not 0 to 1",
                   "record it again"};
    recording.poses.push_back(pose);
  }
  return Done{};
}

Status read_event(const std::string& name, HashingReader& in, Recording& recording) {
  RecordedEvent event;
  event.tick = in.get<std::uint64_t>();
  const auto kind = in.get<std::uint8_t>();
  event.name = in.text();
  event.key = in.text();
  event.vertex = in.get<std::uint32_t>();
  bool finite = true;
  for (double& value : event.values) {
    value = in.get<double>();
    finite = finite && std::isfinite(value);
  }
  if (!in.ok) return too_short(name);
  const bool in_order = recording.events.empty() || recording.events.back().tick <= event.tick;
  if (kind < 1 || kind > static_cast<std::uint8_t>(kLastEvent) || !finite || !in_order)
    return Error{name,
                 "has an event before tick " + std::to_string(event.tick) +
                     " that is of no known kind, not finite or out of order",
                 "record it again"};
  event.kind = static_cast<EventKind>(kind);
  recording.events.push_back(std::move(event));
  return Done{};
}

Status read_records(const std::string& name, HashingReader& in, std::uint32_t probes, Recording& recording) {
  for (;;) {
    const auto what = static_cast<Reader&>(in).get<std::uint8_t>();
    if (!in.ok || what > kEvent) return too_short(name);
    if (what == kEnd) break;
    in.hash.add(what);
    if (what == kEvent) {
      if (const Status read = read_event(name, in, recording); !read) return read;
      continue;
    }
    const auto index = in.get<std::uint64_t>();
    if (!in.ok) return too_short(name);
    if (!recording.ticks.empty() && index <= recording.ticks.back())
      return Error{name, "has ticks out of order", "record it again"};
    if (const Status read = read_poses(name, in, probes, index, recording); !read) return read;
  }
  const std::uint64_t expected = in.hash.value();
  if (static_cast<Reader&>(in).get<std::uint64_t>() != expected || in.at != in.bytes.size()) return too_short(name);
  if (recording.ticks.empty()) return Error{name, "holds no tick", "record it again"};
  return Done{};
}

}  // namespace

Result<Recording> parse_recording(const std::string& name, const std::string& bytes) {
  if (bytes.size() < sizeof kMagic || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
    return Error{name, "is not a recording", "give a file that --record wrote"};
  HashingReader in{{bytes, sizeof kMagic}};
  const std::uint32_t version = in.get<std::uint32_t>();
  if (version < 1 || version > kVersion)
    return Error{name, "has format version " + std::to_string(version) + ", this is " + std::to_string(kVersion),
                 "record it again"};

  const Error short_file = too_short(name);
  Recording recording;
  const std::uint32_t probes = in.get<std::uint32_t>();
  recording.header.rate = in.get<double>();
  if (!in.ok || probes > kMaxProbes || !(recording.header.rate >= 1.0 && recording.header.rate <= 1e6))
    return short_file;
  recording.header.level = in.text();
  for (std::uint32_t i = 0; i < probes && in.ok; ++i) recording.header.probes.push_back(in.text());
  if (version >= kOfSettings) {
    const std::uint64_t scene = in.get<std::uint64_t>();
    if (version >= kOfScene) recording.header.scene = scene;
    const std::uint32_t settings = in.get<std::uint32_t>();
    if (settings > kMaxSettings) return short_file;
    for (std::uint32_t i = 0; i < settings && in.ok; ++i) recording.header.settings.push_back(in.text());
  }
  if (!in.ok || bytes.size() - in.at < sizeof(std::uint64_t)) return short_file;

  if (version >= kOfEvents) {
    if (const Status read = read_records(name, in, probes, recording); !read) return read.error();
    return recording;
  }
  // The remainder must be whole ticks and the hash.
  const std::size_t tick_bytes = sizeof(std::uint64_t) + probes * kPoseBytes;
  const std::size_t body = bytes.size() - in.at - sizeof(std::uint64_t);
  if (body % tick_bytes != 0) return short_file;
  const std::size_t ticks = body / tick_bytes;
  if (ticks == 0) return Error{name, "holds no tick", "record it again"};
  recording.ticks.reserve(ticks);
  recording.poses.reserve(ticks * probes);
  for (std::size_t t = 0; t < ticks; ++t) {
    const std::uint64_t index = in.get<std::uint64_t>();
    if (!recording.ticks.empty() && index <= recording.ticks.back())
      return Error{name, "has ticks out of order", "record it again"};
    if (const Status read = read_poses(name, in, probes, index, recording); !read) return read.error();
  }
  const std::uint64_t expected = in.hash.value();
  if (static_cast<Reader&>(in).get<std::uint64_t>() != expected) return short_file;
  return recording;
}

Result<Recording> read_recording(const fs::path& file) {
  const Result<Bytes> bytes = read_file(file, limits::kRecordingFile);
  if (!bytes) return bytes.error();
  return parse_recording(file.string(), {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
}

Result<RecordingWriter> RecordingWriter::create(const fs::path& file, const RecordingHeader& header, bool replace) {
  for (const std::string& setting : header.settings)
    if (setting.size() > kMaxName || header.settings.size() > kMaxSettings)
      return Error{file.string(), "has no room for the settings", "write them into the level instead"};
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return Error{file.string(), "is a folder", "name a file in it"};
  if (fs::exists(file, ignored)) {
    if (!replace) return Error{file.string(), "is there already", "name another, or replace it with --force"};
    if (!fs::is_regular_file(file, ignored))
      return Error{file.string(), "is not a regular file", "name another"};  // opening a pipe would block
    char magic[sizeof kMagic] = {};
    std::ifstream(file, std::ios::binary).read(magic, sizeof magic);
    if (std::memcmp(magic, kMagic, sizeof kMagic) != 0)
      return Error{file.string(), "is no recording, so it is not replaced", "name another, or move it away"};
  }
  const FolderLock lock(file.parent_path());  // until our file starts with a recording's header
  if (remove_abandoned(file, std::string_view(kMagic, sizeof kMagic)))
    return Error{file.string(), "is being recorded into by another run", "give each its own file"};
  RecordingWriter writer;
  writer.file_ = file;
  writer.replace_ = replace;
  writer.probes_ = header.probes.size();
  static std::atomic<int> writers{0};
  do {
    writer.aside_ = file;
    writer.aside_ += ".partial-" + std::to_string(::getpid()) + "-" + std::to_string(writers++);
  } while (fs::symlink_status(writer.aside_, ignored).type() != fs::file_type::not_found);
  auto out = GrowingFile::create(writer.aside_);
  if (!out) return out.error().at(file.string());
  writer.out_.emplace(std::move(out).value());
  writer.record_.assign(kMagic, sizeof kMagic);
  writer.put(kVersion);
  writer.put(static_cast<std::uint32_t>(header.probes.size()));
  writer.put(header.rate);
  writer.put_text(header.level.substr(0, kMaxName));
  for (const std::string& name : header.probes) writer.put_text(name.substr(0, kMaxName));
  writer.put(header.scene);
  writer.put(static_cast<std::uint32_t>(header.settings.size()));
  for (const std::string& setting : header.settings) writer.put_text(setting);
  writer.add_record();
  writer.out_->flush();
  writer.hashes_ = {writer.hash_.value()};
  if (const auto& failure = writer.failure()) return failure->at(file.string());
  return writer;
}

RecordingWriter::~RecordingWriter() {
  if (!out_ || !out_->is_open()) return;  // finished, or moved from
  std::error_code ignored;
  fs::remove(aside_, ignored);
}

template <class T>
void RecordingWriter::put(T value) {
  hash_.add(value);
  record_.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void RecordingWriter::put_text(const std::string& text) {
  put(static_cast<std::uint32_t>(text.size()));
  hash_.add_bytes(text.data(), text.size());
  record_ += text;
}

void RecordingWriter::add_record() {
  out_->add(record_);
  record_.clear();
  poses_ = 0;
  if (failure()) return;
  if (out_->waiting() == 0) hashes_.clear();
  hashes_.push_back(hash_.value());
}

void RecordingWriter::tick(std::uint64_t index) {
  ++ticks_;
  put(kTick);
  put(index);
  if (probes_ == 0) add_record();
}

void RecordingWriter::pose(const RecordedPose& pose) {
  for (double value : {pose.position.x, pose.position.y, pose.position.z, pose.rotation.w, pose.rotation.x,
                       pose.rotation.y, pose.rotation.z})
    put(value);
  put(static_cast<std::uint8_t>((!pose.ready ? 0 : pose.felt ? 1 : 2) + (pose.grips ? kGrips : 0)));
  if (pose.grips) put(pose.grip);
  if (++poses_ == probes_) add_record();
}

void RecordingWriter::event(const RecordedEvent& event) {
  put(kEvent);
  put(event.tick);
  put(static_cast<std::uint8_t>(event.kind));
  put_text(event.name.substr(0, kMaxName));
  put_text(event.key.substr(0, kMaxName));
  put(event.vertex);
  for (const double value : event.values) put(value);
  add_record();
}

Status RecordingWriter::finish() {
  if (ticks_ == 0) {
    std::error_code ignored;
    fs::remove(aside_, ignored);
    if (const Status closed = out_->close(); !closed) return closed;
    return Error{file_.string(), "is not written, because no tick was recorded", "run for longer"};
  }
  const auto bytes_of = [](const std::uint64_t& hash) {
    std::string bytes(1, static_cast<char>(kEnd));
    return bytes.append(reinterpret_cast<const char*>(&hash), sizeof hash);
  };
  if (!failure()) {
    const std::uint64_t hash = hash_.value();
    out_->add(bytes_of(hash));
    out_->flush();
  }
  std::optional<Error> failure = out_->failure();
  bool whole = true;
  if (failure) {
    // The space of one record is used for the end marker.
    const std::size_t kept = std::min(out_->kept_since_flush(), hashes_.size() - 1), dropped = kept > 0 ? 1 : 0;
    whole = out_->end_instead(out_->kept_since_flush() - kept + dropped, bytes_of(hashes_[kept - dropped]));
    failure = failure->at(file_.string());
    if (whole) failure->what += " (it has what was recorded until then)";
  }
  if (const Status closed = out_->close(); !closed && !failure) failure = closed.error();
  std::error_code ignored;
  if (!whole) {
    fs::remove(aside_, ignored);
    return *failure;
  }
  fs::path place = file_;
  int error = move_file(aside_, place, replace_);
  for (int n = 2; error == EEXIST; ++n) error = move_file(aside_, place = numbered(file_, n), false);
  if (error != 0) {
    fs::remove(aside_, ignored);
    return not_written(file_.string(), "cannot be put in place", error);
  }
  if (failure) return *failure;
  if (place != file_)
    return Error{file_.string(), "was created by another program during the run",
                 "the recording was saved as " + place.string()};
  return Done{};
}

}  // namespace pliant
