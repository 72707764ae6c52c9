// Checks a document by the table of gltf_specification.h: types, ranges, references.
#include <fmt/format.h>

#include <cmath>
#include <set>
#include <sstream>

#include "content/gltf/check/finding_list.h"
#include "content/gltf/check/gltf_check.h"
#include "content/gltf/check/gltf_rules.h"
#include "content/keys/json_integer.h"

namespace pliant {

namespace {

constexpr const char* kPliant = "PLIANT_";

class Structure : FindingList {
 public:
  bool mended() const { return mended_; }  // an integer was written as 1.0
  Structure(const Json& root, Findings& findings) : FindingList(findings), root_(root) {
    if (root.is_object() && array_of(root, "extensionsUsed").is_array())
      for (const Json& name : array_of(root, "extensionsUsed"))
        if (name.is_string()) used_.insert(name.get<std::string>());
  }

  void check_object(Json& json, const std::string& type, const std::string& pointer) {
    if (!json.is_object()) return mismatch(pointer, json, "an object");
    if (const auto rules = gltf_rules().rules.find(type); rules != gltf_rules().rules.end())
      for (const GltfRule& rule : rules->second) {
        auto member = json.find(rule.key);
        if (member != json.end())
          check_member(*member, rule, pointer + "/" + rule.key);
        else if (rule.required)
          error(pointer, "lacks '" + rule.key + "', which glTF requires here");
      }
    if (const auto name = json.find("name"); name != json.end()) check_name(*name, pointer + "/name");
    check_strays(json, type, pointer);
    if (json.contains("extensions")) check_extensions(json["extensions"], type, pointer + "/extensions");
  }

 private:
  void check_name(const Json& name, const std::string& pointer) {
    if (!name.is_string()) return mismatch(pointer, name, "a string");
    const std::size_t size = name.get_ref<const std::string&>().size();
    if (size > most(limits::kName))
      error(pointer, "has " + beyond(limits::kName, static_cast<double>(size), "shorten it"));
  }

  static std::string shown(const Json& json) {
    if (json.is_array()) return "an array";
    if (json.is_object()) return "an object";
    return json.dump().substr(0, 40);
  }
  void mismatch(const std::string& pointer, const Json& json, const std::string& wanted) {
    error(pointer, fmt::format("is {}, not {}", shown(json), wanted));
  }

  // PLIANT_* members outside of extensions are ignored by readers: report them.
  void check_strays(const Json& json, const std::string& type, const std::string& pointer) {
    const std::string target = type == "scene" || type == "root" ? "a scene's or node's" : "a node's";
    const auto look = [&](const Json& object, const std::string& where) {
      for (const auto& [name, value] : object.items())
        if (name.rfind(kPliant, 0) == 0)
          warn(where + "/" + escaped(name),
               "is not read, because it stands outside of `extensions`; move it into " + target + " `extensions`");
    };
    look(json, pointer);
    if (json.contains("extras") && json["extras"].is_object()) look(json["extras"], pointer + "/extras");
  }

  void check_extensions(Json& extensions, const std::string& type, const std::string& pointer) {
    if (!extensions.is_object()) return mismatch(pointer, extensions, "an object");
    for (auto& [name, json] : extensions.items()) {
      const std::string here = pointer + "/" + escaped(name);
      if (!json.is_object()) {
        mismatch(here, json, "an object");
        continue;
      }
      if (!used_.count(name)) error(here, "is not declared; add '" + name + "' to extensionsUsed");
      std::string content = "any";
      if (gltf_rules().known_extensions.count(name)) {
        const auto allowed = gltf_rules().extensions.find(type);
        const auto found = allowed == gltf_rules().extensions.end()
                               ? std::map<std::string, std::string>::const_iterator{}
                               : allowed->second.find(name);
        if (allowed == gltf_rules().extensions.end() || found == allowed->second.end()) {
          error(here, fmt::format("has no meaning {}; {}", place_of(type), right_place(name, type)));
          continue;
        }
        content = found->second;
      } else if (name.rfind(kPliant, 0) == 0 && type != "node" && type != "scene") {
        error(here, fmt::format("has no meaning {}; PLIANT extensions stand on nodes and scenes", place_of(type)));
        continue;
      }
      if (content != "any") check_object(json, content, here);
    }
  }

  // Calls check(element, pointer) over an array of at least one element.
  template <class Check>
  void each(Json& json, const std::string& pointer, bool unique, const Check& check) {
    if (!json.is_array()) return mismatch(pointer, json, "an array");
    if (json.empty()) return error(pointer, "is empty; leave it out instead");
    std::set<Json> seen;
    for (std::size_t i = 0; i < json.size(); ++i) {
      const std::string here = fmt::format("{}/{}", pointer, i);
      check(json[i], here);
      if (unique && json[i].is_primitive() && !seen.insert(json[i]).second) error(here, "repeats an earlier element");
    }
  }

  // An integer may be written as 1.0; it is rewritten as 1.
  bool integer(Json& json) {
    const bool is_float = json.is_number_float(), is_integer = as_integer(json);
    mended_ = mended_ || (is_float && is_integer);
    return is_integer;
  }
  void check_index(Json& json, const std::string& collection, const std::string& pointer) {
    if (!integer(json)) return mismatch(pointer, json, "an integer");
    const Json* target = &root_;
    std::istringstream path(collection);
    for (std::string key; target && std::getline(path, key, '/');)
      target = target->is_object() && target->contains(key) ? &(*target)[key] : nullptr;
    const std::size_t count = target && target->is_array() ? target->size() : 0;
    if (json.is_number_unsigned() ? json.get<std::uint64_t>() >= count : true)
      error(pointer, fmt::format("refers to element {} of {}, which has {}", json.dump(), collection, count));
  }
  void check_number(const Json& json, const ValueRange& range, const std::string& pointer) {
    if (!json.is_number()) return mismatch(pointer, json, "a number");
    const double value = json.get<double>();
    // Values are stored in single precision: a larger number would become infinite.
    if (!std::isfinite(static_cast<float>(value))) return error(pointer, "is too large a number");
    if (!range.holds(value)) error(pointer, fmt::format("is {}, out of the range {}", json.dump(), range.text));
  }
  void check_map(Json& json, const std::string& collection, const std::string& pointer) {
    if (!json.is_object()) return mismatch(pointer, json, "an object");
    if (json.empty()) return error(pointer, "is empty");
    for (auto& [name, value] : json.items()) {
      const std::string here = pointer + "/" + escaped(name);
      if (!collection.empty())
        check_index(value, collection, here);
      else if (!integer(value) || !value.is_number_unsigned())
        mismatch(here, value, "an integer of at least 0");
    }
  }

  void check_member(Json& json, const GltfRule& rule, const std::string& pointer) {
    const auto nested = [&](Json& element, const std::string& here) { check_object(element, rule.argument, here); };
    const auto index = [&](Json& element, const std::string& here) { check_index(element, rule.argument, here); };
    const auto map = [&](Json& element, const std::string& here) { check_map(element, rule.argument, here); };
    const auto number = [&](Json& element, const std::string& here) { check_number(element, rule.range, here); };
    const auto string = [&](Json& element, const std::string& here) {
      if (!element.is_string()) mismatch(here, element, "a string");
    };
    if (rule.kind == "object") nested(json, pointer);
    if (rule.kind == "objects") each(json, pointer, false, nested);
    if (rule.kind == "index") index(json, pointer);
    if (rule.kind == "indices") each(json, pointer, true, index);
    if (rule.kind == "map") map(json, pointer);
    if (rule.kind == "maps") each(json, pointer, false, map);
    if (rule.kind == "strings") each(json, pointer, true, string);
    if (rule.kind == "number") number(json, pointer);
    if (rule.kind == "bool" && !json.is_boolean()) mismatch(pointer, json, "true or false");
    if (rule.kind == "int") {
      if (!integer(json))
        mismatch(pointer, json, "an integer");
      else if (!rule.range.holds(json.get<double>()) || json.get<double>() > 4e9)
        error(pointer, fmt::format("is {}, out of the range {}", json.dump(), rule.range.text));
    }
    if (rule.kind == "numbers") {
      each(json, pointer, false, number);
      if (json.is_array() && (rule.or_more ? json.size() < rule.count : json.size() != rule.count))
        error(pointer, fmt::format("has {} numbers instead of {}", json.size(), rule.count));
    }
    if (rule.kind == "string") {
      string(json, pointer);
      if (json.is_string() && !rule.list.empty()) check_list(json.get<std::string>(), rule, pointer);
    }
    if (rule.kind == "ints") {
      if (!integer(json))
        mismatch(pointer, json, "an integer");
      else
        check_list(json.dump(), rule, pointer);
    }
  }
  void check_list(const std::string& value, const GltfRule& rule, const std::string& pointer) {
    for (const std::string& each : rule.list)
      if (each == value) return;
    warn(pointer, fmt::format("must be one of {}; got '{}'", fmt::join(rule.list, ", "), value.substr(0, 40)));
  }

  const Json& root_;
  std::set<std::string> used_;  // extensionsUsed
  bool mended_ = false;
};

}  // namespace

bool check_structure(Json& json, Findings& findings) {
  Structure structure(json, findings);
  structure.check_object(json, "root", "");
  return structure.mended();
}

bool extension_is_used(const Json& json, const std::string& name) {
  const auto used = json.find("extensionsUsed");
  if (used == json.end() || !used->is_array()) return false;
  for (const Json& each : *used)
    if (each == name) return true;
  return false;
}

}  // namespace pliant
