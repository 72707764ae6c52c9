#include "engine/recording.h"

#include <unistd.h>

#include <cmath>
#include <cstring>

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr char kMagic[8] = {'p', 'l', 'i', 'a', 'n', 't', 'r', 'c'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMaxProbes = 4096, kMaxName = 4096;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;
constexpr std::size_t kPoseBytes = 7 * sizeof(double) + 1;

// Takes values off untrusted bytes; after a short read everything is zero and `ok` false.
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

// Each value was hashed on its own when it was written, so the whole is hashed value by value here as well.
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

bool sound(const RecordedPose& pose) {
  const dquat& q = pose.rotation;
  const double norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return std::isfinite(pose.position.x) && std::isfinite(pose.position.y) && std::isfinite(pose.position.z) &&
         std::abs(norm - 1.0) < 1e-3;  // false for NaN
}

}  // namespace

Result<Recording> parse_recording(const std::string& name, const std::string& bytes) {
  if (bytes.size() < sizeof kMagic || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
    return Error{name, "is not a recording; give a file that --record wrote"};
  HashingReader in{{bytes, sizeof kMagic}};
  if (const std::uint32_t version = in.get<std::uint32_t>(); version != kVersion)
    return Error{name, "has format version " + std::to_string(version) + ", this is " + std::to_string(kVersion) +
                           "; record it again"};

  const Error short_file{name, "ends too early or is damaged; record it again"};
  Recording recording;
  const std::uint32_t probes = in.get<std::uint32_t>();
  recording.header.rate = in.get<double>();
  if (!in.ok || probes > kMaxProbes || !(recording.header.rate >= 1.0 && recording.header.rate <= 1e6))
    return short_file;
  recording.header.level = in.text();
  for (std::uint32_t i = 0; i < probes && in.ok; ++i) recording.header.probes.push_back(in.text());
  if (!in.ok || bytes.size() - in.at < sizeof(std::uint64_t)) return short_file;

  // What is left must be whole ticks and the hash.
  const std::size_t tick_bytes = sizeof(std::uint64_t) + probes * kPoseBytes;
  const std::size_t body = bytes.size() - in.at - sizeof(std::uint64_t);
  if (body % tick_bytes != 0) return short_file;
  const std::size_t ticks = body / tick_bytes;
  recording.ticks.reserve(ticks);
  recording.poses.reserve(ticks * probes);
  for (std::size_t t = 0; t < ticks; ++t) {
    const std::uint64_t index = in.get<std::uint64_t>();
    if (!recording.ticks.empty() && index <= recording.ticks.back())
      return Error{name, "has ticks out of order; record it again"};
    recording.ticks.push_back(index);
    for (std::uint32_t i = 0; i < probes; ++i) {
      RecordedPose pose;
      for (double* value : {&pose.position.x, &pose.position.y, &pose.position.z, &pose.rotation.w, &pose.rotation.x,
                            &pose.rotation.y, &pose.rotation.z})
        *value = in.get<double>();
      pose.ready = in.get<std::uint8_t>() == 1;
      if (!sound(pose))
        return Error{name, "has a pose that is no pose at tick " + std::to_string(index) + "; record it again"};
      recording.poses.push_back(pose);
    }
  }
  const std::uint64_t expected = in.hash.value();
  if (static_cast<Reader&>(in).get<std::uint64_t>() != expected) return short_file;
  return recording;
}

Result<Recording> read_recording(const fs::path& file) {
  std::error_code error;
  const std::uint64_t size = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
  std::ifstream in(file, std::ios::binary);
  if (!in || error || !fs::is_regular_file(file, error)) return Error{file.string(), "cannot be read; check the path"};
  if (size > kMaxBytes) return Error{file.string(), "is larger than 1 GiB; record a shorter run"};
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in) return Error{file.string(), "cannot be read to its end; check the disk"};
  return parse_recording(file.string(), bytes);
}

Result<RecordingWriter> RecordingWriter::create(const fs::path& file, const RecordingHeader& header) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return Error{file.string(), "is a folder; name a file in it"};
  RecordingWriter writer;
  writer.file_ = file;
  writer.aside_ = file;
  writer.aside_ += ".partial-" + std::to_string(::getpid());
  writer.out_.open(writer.aside_, std::ios::binary);
  if (!writer.out_) return Error{file.string(), "cannot be written; check that its folder exists"};
  writer.out_.write(kMagic, sizeof kMagic);
  writer.put(kVersion);
  writer.put(static_cast<std::uint32_t>(header.probes.size()));
  writer.put(header.rate);
  writer.put_text(header.level.substr(0, kMaxName));
  for (const std::string& name : header.probes) writer.put_text(name.substr(0, kMaxName));
  return writer;
}

RecordingWriter::~RecordingWriter() {
  if (!out_.is_open()) return;  // finished, or moved from
  out_.close();
  std::error_code ignored;
  fs::remove(aside_, ignored);
}

template <class T>
void RecordingWriter::put(T value) {
  hash_.add(value);
  out_.write(reinterpret_cast<const char*>(&value), sizeof value);
}

void RecordingWriter::put_text(const std::string& text) {
  put(static_cast<std::uint32_t>(text.size()));
  hash_.add_bytes(text.data(), text.size());
  out_.write(text.data(), static_cast<std::streamsize>(text.size()));
}

void RecordingWriter::tick(std::uint64_t index) {
  put(index);
}

void RecordingWriter::pose(const RecordedPose& pose) {
  for (double value : {pose.position.x, pose.position.y, pose.position.z, pose.rotation.w, pose.rotation.x,
                       pose.rotation.y, pose.rotation.z})
    put(value);
  put(static_cast<std::uint8_t>(pose.ready ? 1 : 0));
}

Status RecordingWriter::finish() {
  const std::uint64_t hash = hash_.value();
  out_.write(reinterpret_cast<const char*>(&hash), sizeof hash);
  out_.close();
  std::error_code error;
  if (out_) fs::rename(aside_, file_, error);
  if (out_ && !error) return Done{};
  fs::remove(aside_, error);
  return Error{file_.string(), "cannot be written; check its folder and the space left"};
}

}  // namespace pliant
