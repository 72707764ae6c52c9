// Recording and replaying a Session (pliant/session.h).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <span>

#include "content/files/file_io.h"
#include "engine/run/driver_limits.h"
#include "engine/run/scene_hash.h"
#include "engine/session/session_run.h"
#include "runtime/printable.h"
#include "systems/device/softening.h"
#include "systems/safety/safety.h"

namespace pliant {

Status Session::record(const std::filesystem::path& file, bool replace) {
  SessionRun& p = *run_;
  if (Status s = p.stand_still("Session::record"); !s) return s;
  if (p.recorder) return Error{"Session::record", "a recording is under way", "call Session::end_recording() first"};
  if (p.effectors.empty())
    return Error{"Session::record", "the scene has no probe and no tool", "there is nothing to record"};
  RecordingHeader header{p.world.name, p.world.simulation.touch_rate, effectors(), scene_hash(p.scene.level()), {}};
  for (const auto& [key, value] : p.settings) header.settings.push_back(key + "=" + value);
  for (const SessionEffector& effector : p.effectors)  // a driver's limits affect forces too
    for (std::string& setting : driver_settings(effector.name, p.world.registry.get<HapticDevice>(effector.device)))
      header.settings.push_back(std::move(setting));
  auto writer = RecordingWriter::create(file, header, replace);
  if (!writer) return writer.error();
  p.recorder =
      std::make_unique<PoseRecorder>(std::make_unique<RecordingWriter>(std::move(writer).value()), p.effectors.size());
  // Events already in effect. Parameters and drivers are in the header.
  std::vector<RecordedEvent> holds = p.ticks == 0 && !p.history.lacking ? p.history.events : p.standing;
  if (p.ticks > 0)
    for (const RecordedEvent& event : p.history.events)  // sent, but not yet applied
      if (event.tick == p.ticks &&
          (event.kind == EventKind::kPush || event.kind == EventKind::kPointPush || event.kind == EventKind::kPlace))
        holds.push_back(event);
  for (RecordedEvent event : holds) {
    if (event.kind == EventKind::kSet || event.kind == EventKind::kNewSource) continue;
    event.tick = p.ticks;
    p.recorder->write_now(event);
  }
  return Done{};
}

Status Session::end_recording() {
  SessionRun& p = *run_;
  if (Status s = p.stand_still("Session::end_recording"); !s) return s;
  if (!p.recorder) return Error{"Session::end_recording", "nothing is recorded", "call Session::record() first"};
  const Status ended = p.recorder->finish();
  p.recorder.reset();
  return ended;
}

Status Session::replay(const std::filesystem::path& file) {
  SessionRun& p = *run_;
  if (Status s = p.stand_still("Session::replay"); !s) return s;
  if (p.ticks > 0) return Error{"Session::replay", "ticks have run already", "call Session::restart() first"};
  auto recording = read_recording(file);
  if (!recording) return recording.error();
  const RecordingHeader& header = recording->header;
  if (header.rate != p.world.simulation.touch_rate)
    return Error{file.string(),
                 fmt::format("was made at {} Hz, the scene runs at {} Hz", header.rate, p.world.simulation.touch_rate),
                 "set Scene::simulation()"};
  if (header.probes != effectors())
    return Error{file.string(), "was made with other probes and tools, or in another order", "use its own scene"};
  if (header.scene == 0)
    p.notes.push_back(file.string() + kUnknownScene);
  else if (header.scene != scene_hash(p.scene.level()))
    p.notes.push_back(file.string() + " was recorded in another scene: forces will differ");
  if (!recording->ticks.empty() && recording->ticks.front() != 0)
    p.notes.push_back(fmt::format("{} begins at tick {}: what was felt before is not in it", file.string(),
                                  recording->ticks.front()));
  std::vector<std::string> own = header.settings;
  std::erase_if(own, is_driver_setting);
  for (const Error& refused : p.apply_settings(own, SessionRun::Setting::kSend))
    p.notes.push_back(file.string() + ": its setting " + refused.message());
  const std::vector<std::string> settings = header.settings;
  p.begin_replay(std::move(recording).value());
  if (Status applied = apply_driver_settings(p.world, settings); !applied)
    p.notes.push_back(file.string() + ": its setting " + applied.error().message());
  return Done{};
}

void SessionRun::begin_replay(Recording recording) {
  for (SessionEffector& effector : effectors) {
    take_away(effector, EffectorSource::kNone);
    world.registry.get<HapticDevice>(effector.device).driver = DriverKind::kExternal;
  }
  replayed = std::move(recording);
  replay.emplace(world, *replayed);
  replayed_events = 0;
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
