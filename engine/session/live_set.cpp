#include "engine/session/live_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "components/varying.h"
#include "content/level/varying_keys.h"

namespace pliant {
namespace {

// In the order of NamedKind.
constexpr const char* kKindWords[] = {
    "a deformable surface", "a soft body", "a rigid body", "a tool", "a probe", "an effect"};

const char* words_of_kind(const LiveNamed& named) {
  return kKindWords[static_cast<std::size_t>(kind_of(named))];
}

// Whether an animation varies what this key of a surface sets.
bool is_varied(const World& world, const LiveNamed& named, const Key& key) {
  const Varying* const varying = named.object == kNoEntity ? nullptr : world.registry.find<Varying>(named.object);
  const VaryingKey* const varied = find_varying_key(key.name);
  if (!varying || !varied) return false;
  for (const auto member : varied->members)
    for (const ParameterTrack& track : varying->tracks)
      if (track.member == member) return true;
  return false;
}

}  // namespace

std::vector<const Extension*> extensions_of(const LiveNamed& named) {
  std::vector<const Extension*> out;
  for (const Extension& extension : extension_table())
    if (!extension.on_scene && extension.present(&named.node)) out.push_back(&extension);
  return out;
}

NamedKind kind_of(const LiveNamed& named) {
  if (named.node.deformable) return NamedKind::kSurface;
  if (named.node.probe) return NamedKind::kProbe;
  if (named.node.handle) return NamedKind::kTool;
  if (named.node.effect) return NamedKind::kEffect;
  return named.node.soft_body ? NamedKind::kSoftBody : NamedKind::kRigidBody;
}

std::vector<std::string> live_keys_of(const LiveNamed& named) {
  std::vector<std::string> keys;
  for (const Extension* extension : extensions_of(named))
    for (const Key& each : extension->keys)
      if (why_not_live(*extension, each).empty()) keys.push_back(each.name);
  return keys;
}

Result<FoundKey> find_named_key(const LiveNamed& named, const std::string& key, bool live) {
  const std::string where = "`" + named.name + "`: " + key;
  for (const Extension* extension : extensions_of(named)) {
    if (const Key* const found = find_key(*extension, key)) {
      const std::string why = live ? why_not_live(*extension, *found) : std::string();
      if (!why.empty()) return Error{where, why};
      return FoundKey{extension, found};
    }
  }
  const std::vector<std::string> keys = live_keys_of(named);
  std::string whose;
  for (const Extension& extension : extension_table())
    if (find_key(extension, key)) whose += (whose.empty() ? "" : " and ") + ("`" + extension.name + "`");
  if (!whose.empty())
    return Error{where, fmt::format("`{}` is {}, and this is a key of {}", named.name, words_of_kind(named), whose),
                 fmt::format("its keys are: {}", fmt::join(keys, ", "))};
  const std::string near = suggestion(key, keys);
  return Error{where, fmt::format("unknown key of {}", words_of_kind(named)),
               near + (near.empty() ? "" : " ") + fmt::format("keys are: {}", fmt::join(keys, ", ")), "name.unknown"};
}

std::string LiveSet::words() const {
  return extension->name + "." + key->name + "=" + (value.is_string() ? value.get<std::string>() : value.dump());
}

Result<LiveSet> live_set(const World& world, const LiveNamed& named, const std::string& key_name, Json value) {
  const Result<FoundKey> found = find_named_key(named, key_name, true);
  if (!found) return found.error();
  LiveSet set{found->extension, found->key, std::move(value), named.node, {}};
  const Key& key = *set.key;
  const std::string where = "`" + named.name + "`: " + key_name;
  if (key.type == KeyType::kFlag && (set.value == "true" || set.value == "false")) set.value = set.value == "true";
  if (const std::optional<Note> fault = check_value(key, set.value)) return error_at(where, *fault);
  if (named.node.deformable && is_varied(world, named, key))
    return Error{where, "is varied by an animation of the scene", "change its keys, or remove the channel"};
  if (named.node.deformable && named.node.deformable->young > 0.0 && key.name == "stiffness")
    return Error{where, "follows from its Young's modulus", "set `young` instead"};
  if (key.name == "stiffness" && stiffness_of_table(named.node))
    return Error{where, "follows from the rows of its table", "set another `spring` first"};
  key.set(&set.now, set.value);
  if (const std::optional<Note> fault = set.extension->settle(&set.now)) return error_at(where, *fault);
  Result<SessionChange> change = change_of(world, named, where, *set.extension, key, set.now);
  if (!change) return change.error();
  set.change = std::move(change).value();
  return set;
}

}  // namespace pliant
