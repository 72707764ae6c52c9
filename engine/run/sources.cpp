#include "engine/run/sources.h"

#include <algorithm>

#include "components/soft_body.h"
#include "content/level/script.h"
#include "content/level/unit.h"
#include "runtime/assert.h"
#include "systems/device/hands.h"
#include "systems/device/orbit.h"

namespace pliant {
namespace {

constexpr double kMouseTip = 5e-3, kMouseTipShare = 0.015;  // [m], [1] of the level's diagonal
constexpr vec3 kMouseColor(0.75f, 0.78f, 0.85f);            // linear: pale, distinct from other probes' colours

// [m] A point for surfaces only. If there are bodies, a sphere like a fingertip: the deflection of FEM tissue under a
// point force depends on its mesh.
double mouse_probe_radius(const Level& level) {
  const bool meets = std::any_of(level.nodes.begin(), level.nodes.end(), [](const LevelNode& node) {
    return node.in_scene && (node.soft_body || node.rigid_body);
  });
  const Box box = meets ? bounds(level) : Box();
  return box.empty() ? 0.0 : std::min(kMouseTip, kMouseTipShare * static_cast<double>(box.diagonal()));
}

// The first probe or tool of this name.
Entity find_hand(const World& world, const std::string& name) {
  for (const Entity hand : hands(world))
    if (const Name* its_name = world.registry.find<Name>(hand); its_name && its_name->value == name) return hand;
  return kNoEntity;
}

}  // namespace

Entity own_device(World& world, Entity hand) {
  if (find_device(world, hand)) return device_of(world, hand);
  HapticDevice device;
  if (Handle6* handle = world.registry.find<Handle6>(hand)) {  // a tool without a device name gets its own device
    handle->device.clear();
    if (const Pose* pose = world.registry.find<Pose>(hand))
      device.position = pose->position, device.rotation = pose->rotation;
    world.registry.add<HapticDevice>(hand, device);
    return hand;
  }
  const Entity made = world.registry.create();
  world.registry.add<HapticDevice>(made, device);
  world.registry.get<Probe>(hand).device = made;
  return made;
}

dvec3 place_of(const World& world, Entity hand) {
  if (const Probe* probe = world.registry.find<Probe>(hand)) return probe->position;
  const HapticDevice* device = find_device(world, hand);
  return device ? device->position : dvec3(0);
}

Result<ProbeSource> parse_source(const std::string& argument) {
  const std::size_t equals = argument.find('=');
  const std::string where = "--probe " + argument;
  if (equals == std::string::npos || equals == 0)
    return Error{where, "is not NAME=SOURCE", "write, say, --probe finger=orbit"};
  ProbeSource source{argument.substr(0, equals), DriverKind::kOrbit, {}};
  const std::string words = argument.substr(equals + 1);
  const std::size_t colon = std::min(words.find(':'), words.size());
  const std::string kind = words.substr(0, colon), rest = words.substr(std::min(colon + 1, words.size()));
  const bool alone = colon == words.size();
  if (kind == "orbit" && alone) return source;
  if (kind == "script" && !rest.empty()) {
    source.driver = DriverKind::kScript;
    source.file = rest;
    return source;
  }
  if (kind == "mouse" && alone) {
    source.driver = DriverKind::kMouse;
    return source;
  }
  if (kind == "device" && !rest.empty()) {
    source.driver = DriverKind::kExternal;
    source.device = rest;
    return source;
  }
  if (kind == "hand") {
    source.held = true;
    source.words = rest;
    const HandWords hand = hand_words(source.words);
    source.file = hand.file;
    if (!hand.file.empty()) source.driver = DriverKind::kScript;
    if (const auto options = parse_simulated(hand.device); !options) {
      const Error& why = options.error();
      return Error{where, why.where + ": " + why.what, why.cure};
    }
    return source;
  }
  return Error{where, "unknown source '" + words + "'",
               "sources are: script:FILE.csv, orbit, hand[:FILE.csv], mouse, device:ID (`pliant devices` lists them)"};
}

Status add_probes(Level& level, const std::vector<ProbeSource>& sources) {
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::string& name = sources[i].name;
    for (std::size_t j = 0; j < i; ++j)
      if (sources[j].name == name) return Error{"--probe " + name, "is given twice", "give each probe one source"};
    bool taken = false, is_probe = false;
    for (const LevelNode& node : level.nodes) {
      if (node.name != name) continue;
      taken = true;
      is_probe = is_probe || node.probe.has_value() || node.handle.has_value();
    }
    if (is_probe) continue;
    if (taken)
      return Error{"--probe " + name, "the level has a node of that name that is neither probe nor tool",
                   "choose another name"};
    LevelNode node;
    node.name = name;
    node.probe.emplace();
    if (sources[i].driver == DriverKind::kMouse) {
      node.probe->color = kMouseColor;
      node.probe->radius = mouse_probe_radius(level);
    }
    node.device.emplace();
    node.probe_device = name;
    level.nodes.push_back(node);
  }
  return Done{};
}

Status apply_sources(World& world, const std::vector<ProbeSource>& sources) {
  for (const ProbeSource& source : sources) {
    const Entity hand = find_hand(world, source.name);
    if (hand == kNoEntity)
      return Error{"--probe " + source.name, "the level has no such probe or tool", "check the name"};
    Handle<Path> path;
    if (source.driver == DriverKind::kScript) {
      auto script = load_script(source.file);
      if (!script) return script.error();
      path = world.paths.add(std::move(script).value());
    }
    HapticDevice& device = world.registry.get<HapticDevice>(own_device(world, hand));
    if (source.held && source.file.empty() && device.driver == DriverKind::kScript && device.path.valid())
      continue;  // the hand follows the level's script
    device.driver = source.driver;
    device.file = source.file;
    device.id = source.device;
    device.path = path;
  }
  return Done{};
}

Path orbit_of(const World& world, Entity hand, unsigned index) {
  const Probe* probe = world.registry.find<Probe>(hand);
  return probe ? make_orbit(world, index, probe->radius) : make_tool_orbit(world, hand);
}

std::string moving_cure(const World& world, const std::string& name) {
  const auto surfaces = world.registry.view<const Deformable>();
  const bool orbits = !world.registry.has<Probe>(find_hand(world, name)) || surfaces.begin() != surfaces.end();
  return "give it --probe " + name + (orbits ? "=orbit" : "=script:FILE.csv");
}

std::vector<std::string> make_orbits(World& world) {
  std::vector<std::string> held;
  unsigned index = 0;
  for (const Entity hand : hands(world)) {
    const HapticDevice* device = find_device(world, hand);
    if (!device || device->driver != DriverKind::kOrbit) continue;
    Path path = orbit_of(world, hand, index);
    index += world.registry.has<Probe>(hand);
    if (path.rows.empty()) {
      const Name* name = world.registry.find<Name>(hand);
      const std::string its = name ? name->value : std::string();
      held.push_back("`orbit` of `" + its + "` found no deformable surface, so `" + its +
                     "` does not move; give it a script, or a node PLIANT_deformable");
      continue;
    }
    world.registry.get<HapticDevice>(device_of(world, hand)).path = world.paths.add(std::move(path));
  }
  return held;
}

Result<SimulatedHands> make_hands(World& world, const std::vector<ProbeSource>& sources) {
  SimulatedHands made;
  for (const ProbeSource& source : sources) {
    if (!source.held) continue;
    if (const Status added = made.add(world, find_hand(world, source.name), source.words); !added)
      return Error{"--probe " + source.name, added.error().message()};
  }
  return made;
}

std::string describe_source(const World& world, Entity hand) {
  const HapticDevice* device = find_device(world, hand);
  if (!device) return "null";
  switch (device->driver) {
    case DriverKind::kScript:
      return "script:" + device->file;
    case DriverKind::kOrbit:
      return "orbit";
    case DriverKind::kMouse:
      return "mouse";
    case DriverKind::kExternal:
      if (!device->id.starts_with(kHandId)) return "device:" + device->id;
      return device->id.size() == kHandId.size() ? "hand" : device->id;
    case DriverKind::kNull:
      return "null";
  }
  UNREACHABLE();
}

}  // namespace pliant
