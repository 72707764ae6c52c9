// What ships and what people bring, touched by the built-in orbit: no tick in which the safety layer had to withhold a
// force. And what a tick may cost.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "content/level_file.h"
#include "engine/limits.h"
#include "engine/session_inside.h"
#include "engine/sources.h"
#include "player/study/hard/hard_case.h"
#include "player/study/study_collision.h"
#include "player/study/tick_cost.h"
#include "player/verbs/content_folder.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr double kOrbit = 4.2;  // [s] a turn of the orbit and a little

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code absent;
  for (fs::recursive_directory_iterator at(folder, absent), end; !absent && at != end; at.increment(absent))
    for (const char* kind : {".gltf", ".glb", ".obj"})
      if (at->path().extension() == kind) found.push_back(at->path());
  std::sort(found.begin(), found.end());
  return found;
}

// A file may name several objects alike, a session does not.
void tell_apart(Level& level) {
  std::set<std::string> names;
  for (LevelNode& node : level.nodes)
    for (int i = 2; !names.insert(node.name).second; ++i) node.name = fmt::format("{} ({})", node.name, i);
}

// Ticks in which a force of any probe or tool was withheld.
void orbit(HardFigure& worst, const fs::path& file, bool friction, bool bodies) {
  auto level = load_level(file);
  if (!level) return;  // not sound
  const std::string where = file.filename().string() + (friction ? "" : ", without friction");
  if (!level->has_pliant()) {
    make_touchable(*level);
    tell_apart(*level);
    if (!add_probes(*level, {{"orbiting probe", DriverKind::kOrbit, {}, {}, false, {}}})) return;
  }
  for (LevelNode& node : level->nodes) {
    if (node.soft_body && !bodies) return;
    if (node.device) node.device->driver = DriverKind::kOrbit;
    if (friction) continue;
    if (node.deformable) node.deformable->friction_static = node.deformable->friction_sliding = 0.0;
  }
  auto session = Session::open(Scene(*level));
  worst.need(session.ok(), where + (session ? "" : ": " + session.error().message()));
  if (!session) return;
  const World& world = SessionInside::of(*session).world;
  const auto ticks = static_cast<std::uint64_t>(kOrbit * world.simulation.touch_rate);
  worst.need(session->step(ticks).ok(), where + ": it did not run");
  double withheld = 0;
  for (const std::string& effector : session->effectors()) {
    const HandSafety safety = find_safety(world, SessionInside::of(*session).find_effector(effector)->entity);
    for (const SafetyState* state : {safety.force, safety.torque})
      if (state) withheld += static_cast<double>(state->tally.of(SafetyLimit::kWithheld).ticks);
  }
  worst.add(withheld, where);
}

HardFigure shipped(const HardSetting& setting) {
  HardFigure worst;
  for (const fs::path& file : shipped_levels())
    for (const bool friction : {true, false}) orbit(worst, file, friction, !setting.brief);
  return worst;
}

HardFigure corpus(const HardSetting& setting) {
  HardFigure worst;
  if (!fs::exists(setting.corpus)) {
    worst.absent("the corpus");
    return worst;
  }
  for (const char* folder : {"meshes-valid", "meshes-draco"})
    for (const fs::path& file : files_in(setting.corpus / folder)) {
      if (setting.brief && fs::file_size(file) > 400'000) continue;
      for (const bool friction : {true, false}) orbit(worst, file, friction, !setting.brief);
    }
  return worst;
}

// 2,000 vertices awake on a surface of 1e6, or of 1e5 where the study is brief.
TickCost usual_tick(const HardSetting& setting) {
  return measure_tick(setting.brief ? 100'000 : 1'000'000, 2000, setting.brief ? 2000 : 20'000);
}

HardFigure half_of_ticks(const HardSetting& setting) {
  HardFigure worst;
  const TickCost cost = usual_tick(setting);
  worst.add(cost.p50_us, fmt::format("{} vertices, {:.0f} awake", cost.vertices, cost.awake));
  return worst;
}

HardFigure most_ticks(const HardSetting& setting) {
  HardFigure worst;
  const TickCost cost = usual_tick(setting);
  worst.add(cost.p99_us, fmt::format("{} vertices, {:.0f} awake", cost.vertices, cost.awake));
  return worst;
}

HardFigure nearest_queries(const HardSetting& setting) {
  HardFigure worst;
  for (const PublishedQuery& query : kFcpw)
    if (!setting.brief || query.vertices <= 100'000)
      worst.add(search_scattered(query.vertices, 5000, 0).us / query.scalar_us, fmt::format("{} vertices", query.vertices));
  return worst;
}

}  // namespace

std::vector<HardCase> hard_levels() {
  constexpr const char* kOrbits = "with friction and without: ticks in which the safety layer withheld a force";
  return {
      {"NothingIsWithheldOnAnyLevelThatShips", "contact-energy.md 4: every level that ships, built-in orbit", kOrbits,
       "ticks", 0, shipped},
      {"NothingIsWithheldOnAnySoundMeshOfTheCorpus", "contact-energy.md 4: every sound mesh of the corpus", kOrbits,
       "ticks", 0, corpus},
      {"HalfOfTheTicksTakeNoMoreThanTenMicroseconds", "contact-energy.md 4: cost", "1e6 vertices, 2,000 awake: median",
       "us", 10, half_of_ticks, "", true},
      {"NearlyAllTicksTakeNoMoreThanThirtyMicroseconds", "contact-energy.md 4: cost",
       "1e6 vertices, 2,000 awake: 99 % of ticks", "us", 30, most_ticks, "", true},
      {"TheNearestPointIsFoundWithinTwiceTheTimeOfFcpw", "contact-energy.md 4: cost",
       "spheres of 1e5 and 1e6 vertices: time over FCPW's scalar figure, measured on another machine", "of it [1]", 2,
       nearest_queries, "", true},
  };
}

}  // namespace pliant
