#include "content/gltf/check/gltf_rules.h"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "content/gltf/check/gltf_specification.h"

namespace pliant {

namespace {

ValueRange parse_range(const std::string& text) {
  ValueRange range;
  range.text = text;
  const std::size_t dots = text.find("..");
  std::string low = text.substr(0, dots), high = text.substr(dots + 2);
  if (!low.empty() && low[0] == '>') {
    range.open = true;
    low.erase(0, 1);
  }
  if (!low.empty()) range.min = std::strtod(low.c_str(), nullptr);
  if (!high.empty()) range.max = std::strtod(high.c_str(), nullptr);
  return range;
}

}  // namespace

GltfRules::GltfRules() {
  std::istringstream lines(kSpecification);
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string object, extra;
    GltfRule rule;
    if (!(words >> object >> rule.key >> rule.kind)) continue;
    words >> rule.argument >> extra;
    if (rule.kind == "ext") {
      extensions[object][rule.key] = rule.argument;
      known_extensions.insert(rule.key);
      continue;
    }
    if (rule.key.back() == '!') {
      rule.required = true;
      rule.key.pop_back();
    }
    if (rule.kind == "string" || rule.kind == "ints") {
      std::istringstream list(rule.argument);
      for (std::string item; std::getline(list, item, '|');) rule.list.push_back(item);
    }
    if (rule.kind == "int" || rule.kind == "number") rule.range = parse_range(rule.argument);
    if (rule.kind == "numbers") {
      rule.range = parse_range(extra);
      rule.count = std::strtoul(rule.argument.c_str(), nullptr, 10);
      rule.or_more = rule.argument.back() == '+';
    }
    rules[object].push_back(rule);
  }
}

const GltfRules& gltf_rules() {
  static const GltfRules rules;
  return rules;
}

std::string place_of(const std::string& type) {
  if (type == "root") return "at the top level";
  const bool vowel = std::string("aeiou").find(type[0]) != std::string::npos;
  return fmt::format("on a{} {}", vowel ? "n" : "", type);
}

std::string right_place(const std::string& name, const std::string& type) {
  std::string places;
  for (const auto& [object, names] : gltf_rules().extensions)
    if (names.count(name)) places += (places.empty() ? "" : " or ") + place_of(object);
  std::string out = "it stands " + places;
  if (places == "on a node" && (type == "mesh" || type == "primitive")) out += ": move it to the one with this mesh";
  if (places == "on a node" && type == "root") out += ": move it to the one that it is about";
  if (places == "on a scene") out += ": move it to the one that is shown";
  return out;
}

}  // namespace pliant
