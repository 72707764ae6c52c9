// The table of gltf_specification.h as data: rules by object, and the objects on which an extension may stand.
#pragma once

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace pliant {

struct ValueRange {
  double min = -INFINITY, max = INFINITY;
  bool open = false;  // min itself is excluded
  std::string text;
  bool holds(double value) const { return (open ? value > min : value >= min) && value <= max; }
};

// One member of an object.
struct GltfRule {
  std::string key, kind, argument;
  bool required = false;
  std::vector<std::string> list;
  std::size_t count = 0;
  bool or_more = false;
  ValueRange range;
};

// The table of gltf_specification.h, parsed.
struct GltfRules {
  GltfRules();

  std::map<std::string, std::vector<GltfRule>> rules;                    // by object
  std::map<std::string, std::map<std::string, std::string>> extensions;  // by object: name -> type
  std::set<std::string> known_extensions;
};
const GltfRules& gltf_rules();

// "on a node", in the specification's terms.
std::string place_of(const std::string& type);
// The objects that the table allows an extension on, as a remedy where it stands on another one.
std::string right_place(const std::string& extension, const std::string& type);

}  // namespace pliant
