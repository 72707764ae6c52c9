#include "content/keys/unused_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "components/registered.h"
#include "content/keys/extension_table.h"
#include "content/level/unfelt_relief.h"

namespace pliant {

namespace {

// When a key has no effect. A key without a row always has one.
struct UnusedWords {
  std::string what, cure;
};
struct UnusedRow {
  const char *extension, *key;
  bool (*unused)(const LevelNode&);
  UnusedWords words;
};

template <class Row, std::size_t size>
UnusedWords only_with(const char* key, const Row (&rows)[size], const std::function<bool(std::size_t)>& matters) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < size; ++i)
    if (matters(i)) words.push_back(fmt::format("`{}`", rows[i].word));
  return {fmt::format("is read with `{}` {} only", key, listed(words)),
          fmt::format("set {}, or remove the key", words.size() > 1 ? "one of these" : "that")};
}

// A registered law may read any constant.
bool is_law_without(const char* key, const LevelNode& node) {
  return !registered_spring(node.deformable->spring) && !reads_key(node.deformable->spring, key);
}
UnusedWords laws_with(const char* key) {
  return only_with("spring", kSpringRows, [key](std::size_t i) { return reads_key(static_cast<SpringLaw>(i), key); });
}
ShapeParameter parameter_of(const LevelNode& node) {
  return row_of(node.deformable->shape).parameter;
}

bool no_texture(const LevelNode& n) {
  return !(n.deformable->texture_amplitude > 0.0);
}
bool no_transient(const LevelNode& n) {
  return !(n.deformable->transient_amplitude > 0.0);
}
constexpr const char* kGiveOrRemove = "give that too, or remove the key";

const UnusedRow kRows[] = {
    {"deformable", "cubic", [](const LevelNode& n) { return is_law_without("cubic", n); }, laws_with("cubic")},
    {"deformable", "stiffening", [](const LevelNode& n) { return is_law_without("stiffening", n); },
     laws_with("stiffening")},
    {"deformable", "relaxation.stiffness", [](const LevelNode& n) { return is_law_without("relaxation.stiffness", n); },
     laws_with("relaxation.stiffness")},
    {"deformable", "relaxation.time", [](const LevelNode& n) { return is_law_without("relaxation.time", n); },
     laws_with("relaxation.time")},
    {"deformable", "volume", [](const LevelNode& n) { return parameter_of(n) != ShapeParameter::kVolume; },
     only_with("shape", kShapeRows, [](std::size_t i) { return kShapeRows[i].parameter == ShapeParameter::kVolume; })},
    {"deformable", "contact_radius", [](const LevelNode& n) { return !depends_on_contact(n.deformable->shape); },
     only_with("shape", kShapeRows, [](std::size_t i) { return depends_on_contact(static_cast<Shape>(i)); })},
    {"deformable",
     "poisson",
     [](const LevelNode& n) { return !(n.deformable->young > 0.0); },
     {"is read with `young` only", "give that too, or remove the key"}},
    {"deformable",
     "thickness",
     [](const LevelNode& n) { return !(n.deformable->young > 0.0); },
     {"is read with `young` only", "give that too, or remove the key"}},
    {"deformable", "table", [](const LevelNode& n) { return is_law_without("table", n); }, laws_with("table")},
    {"deformable",
     "sphere",
     [](const LevelNode& n) { return !(n.deformable->young > 0.0); },
     {"is read with `young` only", "give that too, or remove the key"}},
    {"deformable",
     "friction_stribeck",
     [](const LevelNode& n) { return !(n.deformable->friction_static > n.deformable->friction_sliding); },
     {"is a fall from `friction_static` to `friction_sliding`, which are equal", "raise one, or remove the key"}},
    {"deformable", "texture.wavelength", no_texture, {"is read with `texture.amplitude` only", kGiveOrRemove}},
    {"deformable", "texture.seed", no_texture, {"is read with `texture.amplitude` only", kGiveOrRemove}},
    {"deformable", "transient.frequency", no_transient, {"is read with `transient.amplitude` only", kGiveOrRemove}},
    {"deformable", "transient.decay", no_transient, {"is read with `transient.amplitude` only", kGiveOrRemove}},
    {"deformable",
     "hole_radius",
     [](const LevelNode& n) { return n.deformable->layers.empty(); },
     {"is read with `layers` only", kGiveOrRemove}},
    {"deformable",
     "yield.hardening",
     [](const LevelNode& n) { return !(n.deformable->yield_force > 0.0); },
     {"is read with `yield.force` only", kGiveOrRemove}},
    {"probe",
     "coupling",
     [](const LevelNode& n) { return n.probe->meets == ProbeMeets::kSurfaces; },
     {"is for soft and rigid bodies, which a probe whose `meets` is `surfaces` does not meet",
      "set `meets` to `all`, or remove the key"}},
    {"haptic_device",
     "file",
     [](const LevelNode& n) { return n.device->driver != DriverKind::kScript; },
     {"is read with `driver` `script` only", "set that, or remove the key"}},
    {"haptic_device",
     "id",
     [](const LevelNode& n) { return n.device->driver != DriverKind::kExternal; },
     {"is read with `driver` `external` only", "set that, or remove the key"}},
    {"haptic_device",
     "scale",
     [](const LevelNode& n) { return n.device->driver != DriverKind::kExternal; },
     {"is of a real device's workspace, which only the `driver` `external` has: a path is in metres of the world",
      "write the path as large as it shall be, or remove the key"}},
    {"soft_body",
     "stiffening",
     [](const LevelNode& n) { return n.soft_body->law != TissueLaw::kFung; },
     {"is of the `law` `fung`", "set `law` to `fung`, or remove the key"}},
    {"soft_body",
     "cell",
     [](const LevelNode& n) { return !n.soft_body->mesh.empty(); },
     {"is not needed where `mesh` gives the tetrahedra", "remove one of them"}},
    {"soft_body",
     "focus",
     [](const LevelNode& n) { return !n.soft_body->mesh.empty(); },
     {"is of a lattice, and `mesh` gives the tetrahedra", "remove one of them"}},
    {"soft_body",
     "elements",
     [](const LevelNode& n) { return !n.soft_body->mesh.empty(); },
     {"is of a lattice, and `mesh` gives the tetrahedra", "remove one of them"}},
    {"soft_body",
     "thickness",
     [](const LevelNode& n) { return !n.soft_body->mesh.empty() || n.soft_body->fill != Fill::kWall; },
     {"is of a `fill` of `wall`", "set `fill` to `wall`, or remove the key"}},
    {"soft_body",
     "under_gravity",
     [](const LevelNode& n) { return n.handle.has_value(); },
     {"is of bodies that are pinned, and a tool always begins as it rests in the hand", "remove the key"}},
    {"soft_body",
     "under_gravity",
     [](const LevelNode& n) { return !n.soft_body->rigid.empty(); },
     {"is of tissue without `rigid` parts, which fall into place by themselves", "remove the key"}},
    {"soft_body",
     "velocity",
     [](const LevelNode& n) { return n.handle.has_value(); },
     {"is of bodies without a handle: a tool moves with its device", "remove the key"}},
    {"soft_body",
     "velocity",
     [](const LevelNode& n) { return n.soft_body->integrator == StepMethod::kQuasiStatic; },
     {"is of a body with inertia, which `integrator` `quasi_static` leaves out", "remove one of them"}},
    {"soft_body",
     "rayleigh",
     [](const LevelNode& n) { return n.soft_body->integrator == StepMethod::kQuasiStatic; },
     {"is of a motion, and `integrator` `quasi_static` has none", "remove one of them"}},
    {"rigid_body",
     "velocity",
     [](const LevelNode& n) { return n.handle.has_value() || n.rigid_body->fixed; },
     {"is of bodies that move without a handle", "remove the key"}},
    {"handle",
     "box",
     [](const LevelNode& n) { return n.rigid_body && !n.soft_body; },
     {"has no effect on a rigid body, all of which is its handle", "remove it"}},
    {"handle",
     "attachment",
     [](const LevelNode& n) { return n.rigid_body && !n.soft_body; },
     {"is how tissue is held, and a rigid body has none", "remove it"}},
    {"rigid_body",
     "density",
     [](const LevelNode& n) { return n.rigid_body->mass > 0.0; },
     {"is not needed where `mass` is given", "remove one of them"}},
    {"soft_body",
     "fibres.direction",
     [](const LevelNode& n) { return !(n.soft_body->fibres.young > 0.0); },
     {"is read with `fibres.young` only", kGiveOrRemove}},
    {"soft_body",
     "fibres.only_tension",
     [](const LevelNode& n) { return !(n.soft_body->fibres.young > 0.0); },
     {"is read with `fibres.young` only", kGiveOrRemove}},
    {"soft_body",
     "fibres.contraction",
     [](const LevelNode& n) { return !(n.soft_body->fibres.young > 0.0); },
     {"is read with `fibres.young` only", kGiveOrRemove}},
    {"soft_body",
     "fibres.period",
     [](const LevelNode& n) { return !(n.soft_body->fibres.young > 0.0); },
     {"is read with `fibres.young` only", kGiveOrRemove}},
};

// Keys of an effect that its kind, region, target or detents do not read.
std::optional<UnusedWords> unused_of_effect(const Effect& effect, const std::string& key) {
  if (key == "kind" || key == "probes") return std::nullopt;
  if (!reads_key(effect.kind, key))
    return only_with("kind", kEffectRows, [&](std::size_t i) { return reads_key(static_cast<EffectKind>(i), key); });
  const auto needs = [](bool has, const char* what) -> std::optional<UnusedWords> {
    if (has) return std::nullopt;
    return UnusedWords{fmt::format("is read with {} only", what), "set that, or remove the key"};
  };
  if (key == "radius") return needs(effect.region == EffectRegion::kSphere, "`region` `sphere`");
  if (key == "box") return needs(effect.region == EffectRegion::kBox, "`region` `box`");
  if (key == "edge" && !(effect.kind == EffectKind::kDetents && effect.detents == DetentAxis::kAround))
    return needs(effect.region != EffectRegion::kEverywhere, "a `region` that has a border");
  if (key == "length") return needs(effect.target == EffectTarget::kSegment, "`target` `segment`");
  if (key == "size") return needs(effect.target == EffectTarget::kPlane, "`target` `plane`");
  if (key == "spacing") return needs(effect.detents == DetentAxis::kAlong, "`detents` `along`");
  if (key == "count") return needs(effect.detents == DetentAxis::kAround, "`detents` `around`");
  return std::nullopt;
}

std::optional<UnusedWords> unused_of_joint(const Joint& joint, const std::string& key) {
  const auto reads = [&](std::size_t i) { return has_word(kJointRows[i].reads, key); };
  const auto needs = [](bool has, const char* what) -> std::optional<UnusedWords> {
    if (has) return std::nullopt;
    return UnusedWords{fmt::format("is read with `{}` only", what), "set that, or remove the key"};
  };
  if (key == "kind" || key == "a" || key == "b" || key == "strength" || key.starts_with("part_")) return std::nullopt;
  if (reads(static_cast<std::size_t>(joint.kind)))
    return key == "closed" ? needs(!joint.grip.empty(), "grip")
                           : needs(key != "max_force" || joint.stiffness > 0.0 || joint.damping > 0.0, "stiffness");
  return only_with("kind", kJointRows, reads);
}

// Whether the owner's value differs from the default.
template <class Owner>
bool is_set(const Extension& extension, const Key& key, const Owner& owner) {
  Owner fresh;
  extension.add(&fresh);
  if constexpr (std::is_same_v<Owner, LevelNode>) scale_defaults(fresh, owner);
  return key.get(&owner) != key.get(&fresh);
}

// Keys of the law of a soft body's dents; the others are of a surface that does not bend.
const std::set<std::string> kOfDentLaw = {
    "spring",         "stiffness", "cubic",  "stiffening", "table",           "relaxation.stiffness",
    "friction",       "shape",     "reach",  "volume",     "contact_radius",  "relaxation.time",
    "young",          "poisson",   "sphere", "thickness",  "friction_static", "friction_sliding",
    "contact_damping"};

void find_in_dent_law(const LevelNode& node, std::size_t n, std::vector<UnusedKey>& found) {
  const auto add = [&](const char* of, const std::string& key, const char* what, const char* cure) {
    const Extension& extension = *find_extension(of);
    const Key& it = *find_key(extension, key);
    if (!it.alias && is_set(extension, it, node))
      found.push_back({static_cast<std::int32_t>(n), fmt::format("PLIANT_{}/{}", of, key), what, cure});
  };
  for (const Key& key : find_extension("deformable")->keys)
    if (!kOfDentLaw.contains(key.name))
      add("deformable", key.name, "is of a surface alone: a soft body's dents take the law and its friction",
          "remove the key, or PLIANT_soft_body");
  for (const char* key : {"contact", "friction_static", "friction_sliding"})
    add("soft_body", key, "is of a soft body alone: PLIANT_deformable is the law of its dents", "remove the key");
}

void find_in_node(const Level& level, std::size_t n, std::vector<UnusedKey>& found) {
  const LevelNode& node = level.nodes[n];
  const bool both = node.soft_body && node.deformable;
  if (both) find_in_dent_law(node, n, found);
  for (const UnusedRow& row : kRows) {
    if (both && row.extension == std::string_view("deformable") && !kOfDentLaw.contains(row.key)) continue;
    const Extension& extension = *find_extension(row.extension);
    if (!extension.present(&node) || !row.unused(node)) continue;
    if (is_set(extension, *find_key(extension, row.key), node))
      found.push_back({static_cast<std::int32_t>(n), fmt::format("PLIANT_{}/{}", row.extension, row.key),
                       row.words.what, row.words.cure});
  }
  if (node.effect) {
    const Extension& extension = *find_extension("effect");
    for (const Key& key : extension.keys)
      if (const auto words = unused_of_effect(*node.effect, key.name); words && is_set(extension, key, node))
        found.push_back({static_cast<std::int32_t>(n), "PLIANT_effect/" + key.name, words->what, words->cure});
  }
  if (node.joint) {
    const Extension& extension = *find_extension("joint");
    for (const Key& key : extension.keys)
      if (const auto words = unused_of_joint(*node.joint, key.name); words && is_set(extension, key, node))
        found.push_back({static_cast<std::int32_t>(n), "PLIANT_joint/" + key.name, words->what, words->cure});
  }
  for (const char* each : {"friction_static", "friction_sliding"})
    if (node.deformable && node.stated.contains("deformable.friction") &&
        node.stated.contains(std::string("deformable.") + each))
      found.push_back({static_cast<std::int32_t>(n), "PLIANT_deformable/friction",
                       fmt::format("sets both coefficients, and `{}` is given too, which counts in a file", each),
                       "remove one of them"});
  if (node.deformable && node.deformable->relief > 0.0 && !draws_relief(level, node))
    found.push_back({static_cast<std::int32_t>(n), "PLIANT_deformable/relief",
                     "is of normal and height maps, and no material of the mesh has one with texture coordinates",
                     "add one, or remove the key"});
  if (const auto& d = node.deformable;
      d && d->transient_amplitude > 0.0 && d->transient_frequency > kMostKnock * level.simulation.touch_rate)
    found.push_back({static_cast<std::int32_t>(n), "PLIANT_deformable/transient.amplitude",
                     fmt::format("makes no knock: {:g} Hz is above {:g} of the touch rate, {:g} Hz",
                                 d->transient_frequency, kMostKnock, level.simulation.touch_rate),
                     "lower `transient.frequency`, or raise `touch_rate`"});
}

void find_in_scene(const Level& level, std::vector<UnusedKey>& found) {
  const bool has_bodies = std::any_of(level.nodes.begin(), level.nodes.end(), [](const LevelNode& node) {
    return node.in_scene && (node.soft_body || node.rigid_body || node.handle);
  });
  const auto add = [&](const char* extension, const char* key, bool unused, const char* what, const char* cure) {
    const Extension& in = *find_extension(extension);
    if (unused && in.present(&level) && is_set(in, *find_key(in, key), level))
      found.push_back({-1, fmt::format("PLIANT_{}/{}", extension, key), what, cure});
  };
  const bool bare = !level.environment || level.environment->panorama.empty();
  for (const char* key : {"intensity", "rotation"})
    add("environment", key, bare, "is of the `panorama`, and there is none", "name one, or remove the key");
  for (const char* key : {"soft_step", "gravity"})
    add("simulation", key, !has_bodies, "is for soft and rigid bodies, and the scene has none", "remove it");
}

}  // namespace

std::vector<UnusedKey> find_unused_keys(const Level& level) {
  std::set<std::string> moving;  // names of devices that move something
  for (const LevelNode& node : level.nodes) {
    if (node.probe) moving.insert(node.probe_device);
    if (node.handle) moving.insert(node.handle->device);
  }
  std::vector<UnusedKey> found;
  for (std::size_t n = 0; n < level.nodes.size(); ++n) {
    const LevelNode& node = level.nodes[n];
    if (!node.in_scene) continue;
    const bool moves = node.probe || node.handle || moving.count(node.name);
    if (node.device && !moves)
      found.push_back({static_cast<std::int32_t>(n), "PLIANT_haptic_device", "moves nothing: no probe or tool names it",
                       "name it as the `device` of one, or remove it"});
    else
      find_in_node(level, n, found);
  }
  find_in_scene(level, found);
  return found;
}

std::vector<Note> unused_key_notes(const Level& level) {
  const std::vector<UnusedKey> found = find_unused_keys(level);
  std::vector<Note> notes;
  std::set<std::string> said;
  for (const UnusedKey& key : found) {
    if (!said.insert(key.pointer).second) continue;
    const auto same = [&](const UnusedKey& other) { return other.pointer == key.pointer; };
    const std::ptrdiff_t more = std::count_if(found.begin(), found.end(), same) - 1;
    const std::string name = key.node < 0 ? "" : level.nodes[static_cast<std::size_t>(key.node)].name;
    const std::string others = more > 0 ? fmt::format(" ({} more node{} too)", more, more == 1 ? "" : "s") : "";
    notes.push_back({(key.node < 0 ? "" : "`" + name + "`: ") + key.pointer + " " + key.what, key.cure + others,
                     "key.unused", key.pointer});
  }
  return notes;
}

}  // namespace pliant
