#include "content/keys/extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/keys/extension_table.h"
#include "content/keys/json_integer.h"

namespace pliant {

namespace {

// Reads one extension object into its owner; calls `report(pointer, note)` for every fault.
template <class Report>
class KeyReader {
 public:
  KeyReader(const Extension& extension, void* owner, const std::vector<std::string>& node_names, const Report& report)
      : extension_(extension), owner_(owner), node_names_(node_names), report_(report) {}

  void read(const Json& json, const std::string& pointer) {
    extension_.add(owner_);
    walk(json, "", pointer);
    // A modulus of 0 counts as absent.
    if (extension_.name == "deformable" && given("stiffness") && static_cast<LevelNode*>(owner_)->deformable->young > 0)
      report_(pointer,
              {"gives both young and stiffness", "keep one, young is calibrated to a stiffness", "key.both", {}});
    if (extension_.name == "deformable" && given("stiffness") && stiffness_of_table(*static_cast<LevelNode*>(owner_)))
      report_(pointer, {"gives both stiffness and a table of force",
                        "keep one, the table's slope at depth 0 is its stiffness",
                        "key.both",
                        {}});
    if (const std::optional<Note> clash = extension_.settle(owner_))
      report_(given(clash->of.c_str()) ? pointer + "/" + clash->of : pointer, *clash);
  }

 private:
  bool given(const char* key) const { return std::find(given_.begin(), given_.end(), key) != given_.end(); }

  // Nested objects are keys with dots.
  void walk(const Json& json, const std::string& prefix, const std::string& pointer) {
    if (!json.is_object()) return report_(pointer, {"is not an object", {}, "key.value", {}});
    for (const auto& [name, value] : json.items()) {
      const std::string here = pointer + "/" + name;
      if (prefix.empty() && (name == "extras" || name == "extensions")) continue;
      const std::string dotted = prefix + name;
      if (const Key* key = find_key(extension_, dotted)) {
        take(*key, value, here);
        continue;
      }
      const bool group = std::any_of(extension_.keys.begin(), extension_.keys.end(),
                                     [&](const Key& each) { return each.name.rfind(dotted + ".", 0) == 0; });
      if (group && prefix.empty())
        walk(value, dotted + ".", here);
      else
        report_(here, unknown_key(extension_, dotted));
    }
  }

  void take(const Key& key, Json value, const std::string& pointer) {
    if (key.type == KeyType::kNode && as_integer(value) && value.is_number_unsigned()) {
      if (value.get<std::uint64_t>() >= node_names_.size())
        return report_(
            pointer,
            {fmt::format("refers to node {} of {}", value.dump(), node_names_.size()), {}, "key.value", key.name});
      value = node_names_[value.get<std::size_t>()];
    }
    if (const std::optional<Note> wrong = check_value(key, value)) return report_(pointer, *wrong);
    if (const std::optional<Note> found = doubt(key, value)) report_.doubt(pointer, *found);
    key.set(owner_, value);
    note_stated(extension_, key, owner_);
    given_.push_back(key.name);
  }

  const Extension& extension_;
  void* owner_;
  const std::vector<std::string>& node_names_;
  const Report& report_;
  std::vector<std::string> given_;
};

// Reads every PLIANT_* extension of an object.
template <class Report>
void read_all(const Json& extensions, const std::string& pointer, bool on_scene,
              const std::vector<std::string>& node_names, void* owner, const Report& report) {
  std::vector<std::string> names;
  for (const Extension& each : extension_table())
    if (each.on_scene == on_scene) names.push_back("PLIANT_" + each.name);
  for (const auto& [name, json] : extensions.items()) {
    if (name.rfind("PLIANT_", 0) != 0) continue;
    const std::string here = pointer + "/" + name;
    const Extension* extension = find_extension(name.substr(7));
    if (!extension || extension->on_scene != on_scene)
      report(here, unknown("extension", name, "", on_scene ? "extensions of a scene" : "extensions of a node", names));
    else
      KeyReader<Report>(*extension, owner, node_names, report).read(json, here);
  }
}

// Keeps the first fault as an error.
struct FirstFault {
  std::optional<Error>& error;
  void operator()(const std::string& pointer, const Note& fault) const {
    if (!error) error = error_at(pointer, fault);
  }
  void doubt(const std::string&, const Note&) const {}  // only `validate` reports doubts
};
struct AllFaults {
  Findings& findings;
  void operator()(const std::string& pointer, const Note& fault) const {
    findings.push_back(finding_of(fault, Severity::kError, pointer));
  }
  void doubt(const std::string& pointer, const Note& found) const {
    findings.push_back(finding_of(found, Severity::kWarning, pointer));
  }
};

// json[a][b] for the key a.b.
Json& place(Json& json, const std::string& dotted) {
  const std::size_t dot = dotted.find('.');
  return dot == std::string::npos ? json[dotted] : place(json[dotted.substr(0, dot)], dotted.substr(dot + 1));
}

Json write(const Extension& extension, const void* owner, const void* defaults, const std::set<std::string>& stated,
           const Json& before) {
  Json out = Json::object();
  // A stiffness that `young` or a table says is derived at loading, so it is not saved.
  const bool deformable = extension.name == "deformable";
  const bool young = deformable && static_cast<const LevelNode*>(owner)->deformable->young > 0.0,
             derived = young || (deformable && stiffness_of_table(*static_cast<const LevelNode*>(owner)));
  for (const Key& key : extension.keys) {
    if (key.alias || (derived && key.name == "stiffness")) continue;
    if (extension.name == "deformable" && key.name == "young" && !young) continue;  // 0: absent, even if written
    const Json value = key.get(owner);
    if (value.is_null() || (value == key.get(defaults) && !stated.contains(extension.name + "." + key.name))) continue;
    place(out, key.name) = value;
  }
  for (const char* kept : {"extras", "extensions"})
    if (before.is_object() && before.contains(kept)) out[kept] = before[kept];
  return out;
}

template <class Owner>
Json write_all(bool on_scene, const Owner& owner, const Json& before) {
  Json out = Json::object();
  for (const Extension& extension : extension_table()) {
    if (extension.on_scene != on_scene || !extension.present(&owner)) continue;
    Owner defaults;
    extension.add(&defaults);
    if constexpr (std::is_same_v<Owner, LevelNode>) scale_defaults(defaults, owner);  // what follows is not saved
    const std::string name = "PLIANT_" + extension.name;
    const bool was = before.is_object() && before.contains(name);
    Json json = write(extension, &owner, &defaults, owner.stated, was ? before[name] : Json());
    // PLIANT_simulation always exists in memory; it is written only if it has keys.
    if (extension.name == "simulation" && json.empty() && !was) continue;
    out[name] = std::move(json);
  }
  return out;
}

}  // namespace

Status parse_node_extensions(const Json& extensions, const std::string& pointer,
                             const std::vector<std::string>& node_names, LevelNode& node) {
  std::optional<Error> error;
  read_all(extensions, pointer, false, node_names, &node, FirstFault{error});
  if (error) return *error;
  return Done{};
}

Status parse_scene_extensions(const Json& extensions, const std::string& pointer, Level& level) {
  std::optional<Error> error;
  read_all(extensions, pointer, true, {}, &level, FirstFault{error});
  if (error) return *error;
  return Done{};
}

void find_in_node_extensions(const Json& extensions, const std::string& pointer,
                             const std::vector<std::string>& node_names, Findings& findings) {
  LevelNode node;
  read_all(extensions, pointer, false, node_names, &node, AllFaults{findings});
}

void find_in_scene_extensions(const Json& extensions, const std::string& pointer, Findings& findings) {
  Level level;
  read_all(extensions, pointer, true, {}, &level, AllFaults{findings});
}

Json node_extensions(const LevelNode& node, const Json& before) {
  return write_all(false, node, before);
}
Json scene_extensions(const Level& level, const Json& before) {
  return write_all(true, level, before);
}

}  // namespace pliant
