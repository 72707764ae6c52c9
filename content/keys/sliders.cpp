#include "content/keys/sliders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/keys/extension_table.h"
#include "content/keys/live_keys.h"

namespace pliant {
namespace {

// A path NODE.EXTENSION.KEY; names of nodes may contain dots.
struct KeyPath {
  std::string node;
  const Extension* extension = nullptr;
  const Key* key = nullptr;
};

std::vector<KeyPath> readings_of(const std::string& path) {
  std::vector<KeyPath> found;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1)) {
    const std::size_t end = path.find('.', dot + 1);
    if (end == std::string::npos) break;
    const Extension* const extension = find_extension(path.substr(dot + 1, end - dot - 1));
    if (!extension || extension->on_scene) continue;
    if (const Key* const key = find_key(*extension, path.substr(end + 1)))
      found.push_back({path.substr(0, dot), extension, key});
  }
  return found;
}

// The probe or tool that this device moves; "": none.
std::string moved_by(const Level& level, const LevelNode& device) {
  for (const LevelNode& node : level.nodes) {
    const bool own = &node == &device;
    if (node.probe && (node.probe_device == device.name || (own && node.probe_device.empty()))) return node.name;
    if (node.handle && (node.handle->device == device.name || (own && node.handle->device.empty()))) return node.name;
  }
  return "";
}

bool is_varied(const Level& level, const LevelNode& node, const Key& key) {
  for (const LevelAnimation& animation : level.animations)
    for (const LevelChannel& channel : animation.channels)
      if (channel.property == NodeProperty::kKey && channel.key == key.name &&
          &level.nodes[static_cast<std::size_t>(channel.node)] == &node)
        return true;
  return false;
}

// The reason why a run cannot change this key of this node; empty: it can.
std::optional<Note> why_fixed(const Level& level, const LevelNode& node, const Extension& extension, const Key& key) {
  if (extension.name == "joint" || extension.name == "motion" || (extension.name == "soft_body" && node.deformable))
    return Note{"is read when the run begins", "expose a key that a session can set", "key.value", {}};
  if (key.type != KeyType::kNumber) return Note{"is no single number", "a slider sets a number", "key.value", {}};
  if (std::string why = why_not_live(extension, key); !why.empty())
    return Note{std::move(why), "expose a key that a session can set", "key.value", {}};
  if (extension.name == "deformable" && key.name == "stiffness" && node.deformable->young > 0.0)
    return Note{"follows from Young's modulus", "expose `young`", "key.value", {}};
  if (extension.name == "deformable" && key.name == "stiffness" && stiffness_of_table(node))
    return Note{"follows from the rows of its table", "expose another key", "key.value", {}};
  if (extension.name == "effect" && !reads_key(node.effect->kind, key.name))
    return Note{"is not read by an effect of this kind", "expose a key that it reads", "key.value", {}};
  if (extension.name == "deformable" && is_varied(level, node, key))
    return Note{"is varied by an animation", "expose another key, or remove the channel", "key.value", {}};
  return std::nullopt;
}

// Sets the bounds of a slider.
std::optional<Note> bound(const ExposedKey& exposed, const Key& key, Slider& out) {
  const bool given = exposed.range[0] != exposed.range[1], usual = std::isfinite(key.usual.min);
  out.low = given ? exposed.range[0] : usual ? key.usual.min : key.range.min;
  out.high = given ? exposed.range[1] : usual ? key.usual.max : key.range.max;
  out.step = key.whole ? std::max(1.0, std::round(exposed.step)) : exposed.step;
  if (!std::isfinite(out.low) || !std::isfinite(out.high))
    return Note{"has no usual range", "give `range`", "key.value", {}};
  if (!(out.low < out.high))
    return Note{"has a range that begins above its end", "exchange its two values", "key.value", {}};
  if (!key.range.holds(out.low) || !key.range.holds(out.high))
    return Note{
        fmt::format("has a range of {:g} to {:g}, and `{}` is {}", out.low, out.high, key.name, range_text(key)),
        "narrow it",
        "key.value",
        {}};
  if (out.step > out.high - out.low) return Note{"has a step wider than its range", "lower it", "key.value", {}};
  return std::nullopt;
}

Result<Slider> slider_of(const Level& level, const ExposedKey& exposed, const std::string& where) {
  const std::vector<KeyPath> readings = readings_of(exposed.key);
  if (readings.empty())
    return Error{where, fmt::format("names '{}', which is not NODE.EXTENSION.KEY", exposed.key.substr(0, 100)),
                 "write for example belly.deformable.stiffness", "key.value"};
  std::vector<std::string> nodes;
  const LevelNode* node = nullptr;
  const KeyPath* of = nullptr;
  for (const KeyPath& reading : readings)
    for (const LevelNode& each : level.nodes) {
      if (!reading.extension->present(&each)) continue;
      nodes.push_back(each.name);
      if (each.name != reading.node) continue;
      if (node)
        return Error{where, fmt::format("names '{}', and two nodes have that name", reading.node.substr(0, 100)),
                     "give each its own", "key.value"};
      node = &each, of = &reading;
    }
  if (!node)
    return Error{where,
                 fmt::format("names '{}', which is no node with PLIANT_{}", readings.front().node.substr(0, 100),
                             readings.front().extension->name),
                 suggestion(readings.front().node, nodes), "name.unknown"};
  Slider out{node->name, of->key->name, exposed.name, of->key->unit == "1" ? "" : of->key->unit, 0.0, 0.0, 0.0};
  const std::string place = where + " (" + exposed.key.substr(0, 200) + ")";
  if (of->extension->name == "haptic_device") out.object = moved_by(level, *node);
  if (out.object.empty()) return Error{place, "is of a device that moves nothing", "name it in a probe", "key.value"};
  if (out.name.empty()) out.name = node->name + ": " + of->key->name;
  if (const std::optional<Note> fault = why_fixed(level, *node, *of->extension, *of->key))
    return error_at(place, *fault);
  if (const std::optional<Note> fault = bound(exposed, *of->key, out)) return error_at(place, *fault);
  return out;
}

// Whether this path is of the node, and what follows its name.
std::optional<std::string> rest_of(const std::string& path, const std::string& node) {
  for (const KeyPath& reading : readings_of(path))
    if (reading.node == node) return path.substr(node.size() + 1);
  return std::nullopt;
}

}  // namespace

Result<std::vector<Slider>> sliders_of(const Level& level) {
  std::vector<Slider> out;
  for (std::size_t i = 0; i < level.simulation.expose.size(); ++i) {
    Result<Slider> made = slider_of(level, level.simulation.expose[i], fmt::format("simulation.expose item {}", i + 1));
    if (!made) return made.error();
    out.push_back(std::move(made).value());
  }
  return out;
}

void rename_exposed(LevelSimulation& simulation, const std::string& from, const std::string& to) {
  if (to.empty())
    std::erase_if(simulation.expose, [&](const ExposedKey& each) { return rest_of(each.key, from).has_value(); });
  for (ExposedKey& each : simulation.expose)
    if (const std::optional<std::string> rest = rest_of(each.key, from)) each.key = to + "." + *rest;
}

void forget_exposed(LevelSimulation& simulation, const std::string& node, const std::string& extension) {
  std::erase_if(simulation.expose, [&](const ExposedKey& each) {
    const std::optional<std::string> rest = rest_of(each.key, node);
    return rest && rest->starts_with(extension + ".");
  });
}

}  // namespace pliant
