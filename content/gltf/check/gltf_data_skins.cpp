// check_data: joints, weights and bind matrices.
#include <algorithm>
#include <cmath>
#include <vector>

#include "content/gltf/check/gltf_data.h"

namespace pliant {

namespace {

constexpr float kWeightTolerance = 0.01f;  // the error of 8-bit quantisation of a sum

// Skins of different sizes may share the accessor: its largest index is cached.
void check_skinned(DataCheck& check, const Json& node, std::map<std::size_t, std::uint32_t>& largest_joint) {
  const std::size_t joints = check.document.json["skins"][node["skin"].get<std::size_t>()]["joints"].size();
  for (const Json& primitive : check.document.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"])
    for (const auto& [name, value] : primitive["attributes"].items()) {
      const std::size_t i = value.get<std::size_t>();
      if (name.rfind("JOINTS_", 0) != 0) continue;
      if (check.first(i, DataRole::kJoints)) {
        std::uint32_t& largest = largest_joint[i];
        for (const std::uint32_t joint : read_integers(check.document, i)) largest = std::max(largest, joint);
      }
      if (const auto largest = largest_joint.find(i); largest != largest_joint.end() && largest->second >= joints)
        check.error(pointer_of(i), fmt::format("refers to joint {} of {}", largest->second, joints));
    }
}

void check_bind_matrices(DataCheck& check, std::size_t i) {
  if (!check.first(i, DataRole::kBindMatrices)) return;
  const std::vector<float> m = read_floats(check.document, i);
  for (std::size_t k = 0; k + 16 <= m.size(); k += 16)
    if (m[k + 3] != 0.0f || m[k + 7] != 0.0f || m[k + 11] != 0.0f || std::abs(m[k + 15] - 1.0f) > 1e-4f)
      return check.error(pointer_of(i),
                         fmt::format("holds an inverse bind matrix that is not affine, number {}", k / 16));
}

}  // namespace

void WeightData::check(const Json& attributes, const std::string& pointer) {
  weights(attributes, pointer);
  joints(attributes, pointer);
}

// A vertex's weights must be nonnegative and sum to 1 over all sets.
void WeightData::weights(const Json& attributes, const std::string& pointer) {
  std::vector<float> sums;
  for (int set = 0; attributes.contains(fmt::format("WEIGHTS_{}", set)); ++set) {
    const std::size_t i = attributes[fmt::format("WEIGHTS_{}", set)].get<std::size_t>();
    if (!has_data(check_.document, i) || (set == 0 && !weights_seen_.insert(i).second)) return;
    const std::vector<float> values = read_floats(check_.document, i);
    sums.resize(values.size() / 4);
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (values[k] < 0.0f)
        return check_.error(pointer + "/attributes", fmt::format("have a negative weight in element {}", k / 4));
      sums[k / 4] += values[k];
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v)
    if (std::abs(sums[v] - 1.0f) > kWeightTolerance)
      return check_.warn(pointer + "/attributes",
                         fmt::format("have weights that sum to {:.3g} instead of 1 in element {}; scaled", sums[v], v));
}

// A joint may have only one weight for a vertex (3.7.3.3), within a set and between sets. Skins are only read at
// rest, where adding duplicate weights gives the same result.
void WeightData::joints(const Json& attributes, const std::string& pointer) {
  std::vector<std::pair<std::vector<std::uint32_t>, std::vector<float>>> sets;
  std::set<std::size_t> read;
  for (int set = 0; attributes.contains(fmt::format("JOINTS_{}", set)); ++set) {
    const std::size_t joint = attributes[fmt::format("JOINTS_{}", set)].get<std::size_t>(),
                      weight = attributes[fmt::format("WEIGHTS_{}", set)].get<std::size_t>();
    if (!has_data(check_.document, joint) || !has_data(check_.document, weight) || !read.insert(weight).second) return;
    if (set == 0 && !joints_seen_.insert({joint, weight}).second) return;
    sets.emplace_back(read_integers(check_.document, joint), read_floats(check_.document, weight));
  }
  if (sets.empty()) return;
  std::vector<std::uint32_t> here;
  for (std::size_t v = 0; 4 * v + 4 <= sets.front().first.size(); ++v) {
    here.clear();
    for (const auto& [joint, weight] : sets)
      for (std::size_t k = 4 * v; k < 4 * v + 4 && k < std::min(joint.size(), weight.size()); ++k) {
        if (weight[k] == 0.0f) continue;
        if (std::find(here.begin(), here.end(), joint[k]) != here.end())
          return check_.warn(pointer + "/attributes",
                             fmt::format("give joint {} two weights in element {}; added up", joint[k], v));
        here.push_back(joint[k]);
      }
  }
}

void check_skin_data(DataCheck& check) {
  const Json& json = check.document.json;
  std::map<std::size_t, std::uint32_t> largest_joint;  // of each accessor
  for (const Json& node : array_of(json, "nodes"))
    if (node.contains("skin")) check_skinned(check, node, largest_joint);
  for (const Json& skin : array_of(json, "skins"))
    if (skin.contains("inverseBindMatrices"))
      check_bind_matrices(check, skin["inverseBindMatrices"].get<std::size_t>());
}

}  // namespace pliant
