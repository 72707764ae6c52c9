// Recording and replaying a Session (pliant/session.h).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <span>

#include "content/files/file_io.h"
#include "engine/session_parts.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

constexpr std::size_t kRoom = 8192;  // ticks that may wait to be written
constexpr auto kDrainEvery = std::chrono::milliseconds(20);

std::size_t room_for(std::size_t hands) {
  return std::clamp<std::size_t>(most(limits::kJournal) / (sizeof(PoseRow) * hands), 2, kRoom);
}

}  // namespace

SessionRecorder::SessionRecorder(RecordingWriter writer, std::size_t hands)
    : writer_(std::move(writer)), hands_(hands), room_(room_for(hands)), rows_(room_ * hands) {}

void SessionRecorder::note(std::uint64_t tick, const HapticDevice& device) {
  rows_.record({tick, {device.position, device.rotation, device.status == DeviceStatus::kReady}});
}

void SessionRecorder::drain() {
  taken_.clear();
  rows_.drain(taken_);
  for (const PoseRow& row : taken_) {
    if (written_ == 0) writer_.tick(row.tick);
    writer_.pose(row.pose);
    written_ = (written_ + 1) % hands_;
  }
}

void SessionRecorder::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      drain();
      std::this_thread::sleep_for(kDrainEvery);
    }
  });
}

Status SessionRecorder::finish() {
  if (thread_.joinable()) thread_.request_stop(), thread_.join();
  drain();
  if (Status written = writer_.finish(); !written) return written;
  if (rows_.lost() > 0)
    return Error{"recording",
                 fmt::format("{} poses were lost because writing fell behind; use a faster disk", rows_.lost())};
  return Done{};
}

Status Session::record(const std::filesystem::path& file, bool replace) {
  Parts& p = *parts_;
  if (Status s = p.stand_still("Session::record"); !s) return s;
  if (p.recorder) return Error{"Session::record", "a recording is under way; call Session::end_recording() first"};
  if (p.hands.empty())
    return Error{"Session::record", "the scene has no probe and no tool; there is nothing to record"};
  RecordingHeader header{p.world.name, p.world.simulation.touch_rate, {}};
  for (const SessionHand& hand : p.hands) header.probes.push_back(hand.name);
  auto writer = RecordingWriter::create(file, header, replace);
  if (!writer) return writer.error();
  p.recorder = std::make_unique<SessionRecorder>(std::move(writer).value(), p.hands.size());
  return Done{};
}

Status Session::end_recording() {
  Parts& p = *parts_;
  if (Status s = p.stand_still("Session::end_recording"); !s) return s;
  if (!p.recorder) return Error{"Session::end_recording", "nothing is recorded; call Session::record() first"};
  const Status ended = p.recorder->finish();
  p.recorder.reset();
  return ended;
}

Status Session::replay(const std::filesystem::path& file) {
  Parts& p = *parts_;
  if (Status s = p.stand_still("Session::replay"); !s) return s;
  if (p.ticks > 0) return Error{"Session::replay", "ticks have run already; call Session::restart() first"};
  auto recording = read_recording(file);
  if (!recording) return recording.error();
  const RecordingHeader& header = recording->header;
  if (header.rate != p.world.simulation.touch_rate)
    return Error{file.string(), fmt::format("was made at {} Hz, the scene runs at {} Hz; set Scene::simulation()",
                                            header.rate, p.world.simulation.touch_rate)};
  if (header.probes != hands())
    return Error{file.string(), "was made with other probes and tools, or in another order; use its own scene"};
  for (SessionHand& hand : p.hands) {
    p.close_driver(hand);
    hand.source = HandSource::kNone;
    HapticDevice& device = p.world.registry.get<HapticDevice>(hand.device);
    device.driver = DriverKind::kExternal;
    device.path = {};  // nothing but the recording moves it
  }
  p.replayed = std::move(recording).value();
  return Done{};
}

Tick Session::Parts::replayed_tick() {
  const double dt = 1.0 / world.simulation.touch_rate;
  const std::size_t n = static_cast<std::size_t>(ticks);
  const Tick tick{replayed->ticks[n], dt, static_cast<double>(replayed->ticks[n]) * dt};
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const RecordedPose& pose = replayed->poses[n * hands.size() + i];
    HapticDevice& device = world.registry.get<HapticDevice>(hands[i].device);
    device.position = pose.position;
    device.rotation = pose.rotation;
    device.status = pose.ready ? DeviceStatus::kReady : DeviceStatus::kLost;
    device.sensed_at = tick.time;
  }
  return tick;
}

Status export_recording(const std::filesystem::path& file, const std::filesystem::path& csv) {
  const auto recording = read_recording(file);
  if (!recording) return recording.error();
  const std::vector<std::string>& probes = recording->header.probes;
  std::string text = "tick,time_s,probe,x,y,z,qw,qx,qy,qz,ready\n";
  for (std::size_t n = 0; n < recording->ticks.size(); ++n)
    for (std::size_t i = 0; i < probes.size(); ++i) {
      const RecordedPose& pose = recording->poses[n * probes.size() + i];
      std::string name;
      for (const char c : printable(probes[i])) name += c == '"' ? std::string("\"\"") : std::string(1, c);
      text += fmt::format("{},{:.9g},\"{}\",{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", recording->ticks[n],
                          static_cast<double>(recording->ticks[n]) / recording->header.rate, name, pose.position.x,
                          pose.position.y, pose.position.z, pose.rotation.w, pose.rotation.x, pose.rotation.y,
                          pose.rotation.z, pose.ready ? 1 : 0);
    }
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  return write_file(csv, std::span(bytes, text.size()), Existing::kRefuse);
}

}  // namespace pliant
