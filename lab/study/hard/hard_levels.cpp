// Shipped and user levels, touched by the built-in orbit: the safety layer must not withhold a force in any tick.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "content/level_file.h"
#include "engine/run/limits.h"
#include "engine/run/sources.h"
#include "engine/session/session_world.h"
#include "lab/files/content_folder.h"
#include "lab/study/hard/hard_case.h"
#include "systems/device/hands.h"
#include "systems/device/reading.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr double kOrbit = 4.2;          // [s] slightly more than one turn of the orbit
constexpr double kLeastContact = 0.05;  // [1] of the ticks of a run: with less contact nothing was judged

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code absent;
  for (fs::recursive_directory_iterator at(folder, absent), end; !absent && at != end; at.increment(absent))
    for (const char* kind : {".gltf", ".glb", ".obj", ".drc"})
      if (at->path().extension() == kind) found.push_back(at->path());
  std::sort(found.begin(), found.end());
  return found;
}

// A file may repeat object names, a session may not.
void make_distinct(Level& level) {
  std::set<std::string> names;
  for (LevelNode& node : level.nodes)
    for (int i = 2; !names.insert(node.name).second; ++i) node.name = fmt::format("{} ({})", node.name, i);
}

bool has_bodies(const Level& level) {
  return std::any_of(level.nodes.begin(), level.nodes.end(),
                     [](const LevelNode& node) { return node.soft_body || node.rigid_body; });
}

void without_friction(Level& level) {
  for (LevelNode& node : level.nodes) {
    if (node.deformable)
      node.deformable->friction_static = node.deformable->friction_sliding = node.deformable->friction_viscous = 0.0;
    if (node.soft_body) node.soft_body->friction_static = node.soft_body->friction_sliding = 0.0;
    if (node.rigid_body) node.rigid_body->friction_static = node.rigid_body->friction_sliding = 0.0;
  }
}

// Result over many files.
struct Judged {
  HardFigure worst;
  int files = 0, refused = 0, left_out = 0;
  double least_contact = 1.0;  // [1] of the ticks of a run
  HardFigure figure(const std::string& of) {
    worst.need(files > 0, "no file was judged");
    worst.looked_at(
        fmt::format("{} {}, each with friction and without, in contact in {:.0f} % of the ticks or more{}{}", files, of,
                    100 * least_contact, refused ? fmt::format("; {} more hold nothing to touch", refused) : "",
                    left_out ? fmt::format("; {} left out", left_out) : ""));
    return worst;
  }
};

// Counts the ticks in which any force of a probe or tool was withheld. Returns the share of the ticks in contact.
double run(Judged& judged, const Level& level, const std::string& where) {
  HardFigure& worst = judged.worst;
  auto session = Session::open(Scene(level));
  worst.need(session.ok(), where + (session ? "" : ": " + session.error().message()));
  if (!session) return 0.0;
  const World& world = world_of(*session);
  const auto ticks = static_cast<std::uint64_t>(kOrbit * world.simulation.touch_rate);
  std::uint64_t touching = 0;
  for (std::uint64_t i = 0; i < ticks; ++i) {
    if (!session->step()) {
      worst.need(false, where + ": it did not run");
      return 0.0;
    }
    bool any = false;
    for (const Entity held : hands(world)) any = any || reading(world, held).in_contact;
    touching += any;
  }
  double withheld = 0;
  for (const Entity held : hands(world)) {
    const HandSafety safety = find_safety(world, held);
    for (const SafetyState* state : {safety.force, safety.torque})
      if (state) withheld += static_cast<double>(state->tally.of(SafetyLimit::kWithheld).ticks);
  }
  worst.add(withheld, where);
  return static_cast<double>(touching) / static_cast<double>(ticks);
}

// Every probe and tool follows its orbit, or, where that touches too little, its script. `orbits`: the devices.
void run_in_contact(Judged& judged, Level level, const std::vector<std::size_t>& orbits, const std::string& where) {
  const Level scripted = level;
  for (const std::size_t node : orbits) level.nodes[node].device->driver = DriverKind::kOrbit;
  double contact = run(judged, level, where);
  if (contact < kLeastContact) contact = run(judged, scripted, where + ", by its scripts");
  judged.least_contact = std::min(judged.least_contact, contact);
  judged.worst.need(contact >= kLeastContact,
                    fmt::format("{}: in contact in {:.1f} % of the ticks", where, 100 * contact));
}

// `sound`: the file must load; otherwise it may be rejected with a sentence that names it.
void judge(Judged& judged, const fs::path& file, bool sound, bool bodies) {
  const std::string name = file.filename().string();
  auto loaded = load_level(file);
  if (!loaded) {
    const Error& error = loaded.error();
    judged.worst.need(!sound, error.message());
    judged.worst.need(error.where.starts_with(file.string()), name + ": " + error.message());
    ++judged.refused;
    return;
  }
  Level level = *std::move(loaded);
  if (has_bodies(level) && !bodies) {
    ++judged.left_out;
    return;
  }
  if (!level.has_pliant()) {
    make_touchable(level);
    make_distinct(level);
    const Status added = add_probes(level, {{"orbiting probe", DriverKind::kOrbit, {}, {}, false, {}}});
    judged.worst.need(added.ok(), added ? "" : added.error().message());
    if (!added) return;
  }
  const bool surface = std::any_of(level.nodes.begin(), level.nodes.end(),
                                   [](const LevelNode& node) { return node.deformable && !node.soft_body; });
  const auto grips = [&](const LevelNode& hand) {
    return std::any_of(level.nodes.begin(), level.nodes.end(),
                       [&](const LevelNode& node) { return node.joint && node.joint->grip == hand.name; });
  };
  // A probe orbits over a surface; without one it follows its script, as does a hand that grips by it.
  std::vector<std::size_t> orbits;
  for (std::size_t n = 0; n < level.nodes.size(); ++n)
    if (const LevelNode& node = level.nodes[n]; node.device && !grips(node) && (surface || !node.probe))
      orbits.push_back(n);
  ++judged.files;
  run_in_contact(judged, level, orbits, name);
  without_friction(level);
  run_in_contact(judged, level, orbits, name + ", without friction");
}

HardFigure shipped(const HardSetting& setting) {
  Judged judged;
  for (const fs::path& file : shipped_levels()) judge(judged, file, true, !setting.brief);
  return judged.figure("levels");
}

HardFigure corpus(const HardSetting& setting) {
  Judged judged;
  if (!fs::exists(setting.corpus)) {
    judged.worst.absent("the corpus");
    return judged.worst;
  }
  for (const bool draco : {false, true})
    for (const fs::path& file : files_in(setting.corpus / (draco ? "meshes-draco" : "meshes-valid"))) {
      if (setting.brief && fs::file_size(file) > 400'000)
        ++judged.left_out;
      else
        judge(judged, file, !draco, true);
    }
  return judged.figure("meshes");
}

}  // namespace

std::vector<HardCase> hard_levels() {
  constexpr const char* kOrbits =
      "with friction and without, in contact in 5 % of the ticks at least: ticks in which the safety layer "
      "withheld "
      "a force";
  return {
      {"NothingIsWithheldOnAnyLevelThatShips", "methods.md 3.10: every level that ships", kOrbits, "ticks", 0, shipped},
      {"NothingIsWithheldOnAnySoundMeshOfTheCorpus", "methods.md 3.10: every sound mesh of the corpus", kOrbits,
       "ticks", 0, corpus},
  };
}

}  // namespace pliant
