// Checks the bytes of a glTF file against its JSON: finite numbers, declared bounds, indices, unit vectors, weights.
// Every accessor is read once. Placeholders have no data to check.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "components/math.h"
#include "content/gltf/check/gltf_check.h"
#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_mend.h"

namespace pliant {

namespace {

// Tolerance for the length of unit vectors and for sums of weights: the error of 8-bit quantisation.
constexpr float kUnitTolerance = 0.00674f;
constexpr float kWeightTolerance = 0.01f;

enum class Role { kNormal, kTangent, kColor, kIndex, kJoints, kBindMatrices, kTimes, kRotations, kRotationSplines };

class DataCheck {
 public:
  DataCheck(const SourceDocument& document, Findings& findings)
      : document_(document), json_(document.json), findings_(findings) {}

  void all() {
    for (std::size_t i = 0; i < array_of(json_, "accessors").size(); ++i) bounds(i);
    const Json& meshes = array_of(json_, "meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m)
      for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p)
        primitive(meshes[m]["primitives"][p], fmt::format("/meshes/{}/primitives/{}", m, p));
    for (const Json& node : array_of(json_, "nodes"))
      if (node.contains("skin")) skinned(node);
    for (const Json& skin : array_of(json_, "skins"))
      if (skin.contains("inverseBindMatrices")) bind_matrices(skin["inverseBindMatrices"].get<std::size_t>());
    animations();
  }
  bool zero_directions() const { return zero_directions_; }

 private:
  void error(const std::string& pointer, std::string what, std::string cure = {}) {
    add({Severity::kError, pointer, std::move(what), std::move(cure), "gltf.data"});
  }
  void warn(const std::string& pointer, std::string what, std::string cure = {}) {
    add({Severity::kWarning, pointer, std::move(what), std::move(cure), "gltf.data"});
  }
  void add(Finding finding) {
    if (findings_.size() < 1000) findings_.push_back(std::move(finding));
  }
  static std::string pointer_of(std::size_t accessor) { return fmt::format("/accessors/{}", accessor); }
  const Json& accessor(std::size_t i) const { return json_["accessors"][i]; }
  // True the first time an accessor with data is checked in this role.
  bool first(std::size_t i, Role role) { return has_data(document_, i) && seen_.insert({i, role}).second; }

  // Numbers must be finite, and min and max must match the elements.
  void bounds(std::size_t i) {
    const AccessorLayout layout = layout_of(accessor(i));
    if (!layout.known || !has_data(document_, i)) return;
    if (accessor(i).contains("sparse")) sparse_indices(i, layout.count);
    const bool is_float = layout.component_type == kFloat;
    const bool declared = accessor(i).contains("min") || accessor(i).contains("max");
    if (!is_float && !declared) return;
    // Bounds refer to the stored values: integers for quantised data.
    if (is_float)
      compare_bounds(i, layout.components(), read_floats(document_, i), 2e-6);
    else
      compare_bounds(i, layout.components(), read_stored(document_, i), 0.0);
  }

  // `slack`: tolerance, because exporters print bounds with six or more digits.
  template <class T>
  void compare_bounds(std::size_t i, std::size_t width, const std::vector<T>& values, double slack) {
    std::vector<double> low(width, INFINITY), high(width, -INFINITY);
    for (std::size_t e = 0; e * width < values.size(); ++e)
      for (std::size_t c = 0; c < width; ++c) {
        const double value = static_cast<double>(values[e * width + c]);
        if (!std::isfinite(value))
          return error(pointer_of(i), fmt::format("holds a number that is not finite in element {}", e));
        low[c] = std::min(low[c], value);
        high[c] = std::max(high[c], value);
      }
    const Json& json = accessor(i);
    for (std::size_t c = 0; c < width; ++c) {
      const double allowed = slack * std::max({std::abs(low[c]), std::abs(high[c]), 1e-30});
      if (json.contains("min") && std::abs(json["min"][c].get<double>() - low[c]) > allowed)
        return error(fmt::format("{}/min/{}", pointer_of(i), c),
                     fmt::format("is not the smallest element, {}", low[c]));
      if (json.contains("max") && std::abs(json["max"][c].get<double>() - high[c]) > allowed)
        return error(fmt::format("{}/max/{}", pointer_of(i), c),
                     fmt::format("is not the largest element, {}", high[c]));
    }
  }

  void sparse_indices(std::size_t i, std::uint64_t count) {
    const std::vector<std::uint32_t> indices = read_sparse_indices(document_, i);
    for (std::size_t k = 0; k < indices.size(); ++k)
      if (indices[k] >= count || (k > 0 && indices[k] <= indices[k - 1]))
        return error(pointer_of(i) + "/sparse/indices", fmt::format("are out of range or not ascending at {}", k));
  }

  // The first three of `width` components are a unit vector; with `sign`, the fourth is 1 or -1.
  void unit_vectors(std::size_t i, std::size_t width, bool sign) {
    const std::vector<float> values = read_floats(document_, i);
    // Exporters write zeros at degenerate triangles: mend_directions recomputes them.
    const auto at = [&](std::size_t e) { return vec3(values[e], values[e + 1], values[e + 2]); };
    std::size_t zeros = 0, first = 0;
    double longest = 0.0;
    for (std::size_t e = 0; e + width <= values.size(); e += width) {
      if (has_direction(at(e))) continue;
      if (zeros++ == 0) first = e / width;
      longest = std::max(longest, length(dvec3(at(e))));
    }
    zero_directions_ |= zeros > 0;
    if (zeros > 0)
      warn(pointer_of(i),
           fmt::format("holds {} vector{} of length 0{}, the first in element {}", zeros, zeros == 1 ? "" : "s",
                       longest > 0.0 ? fmt::format(" or nearly so (at most {:.3g})", longest) : "", first),
           "made anew");
    for (std::size_t e = 0; e + width <= values.size(); e += width) {
      if (!has_direction(at(e))) continue;
      const float norm = length(at(e));
      if (std::abs(norm - 1.0f) > kUnitTolerance)
        return error(pointer_of(i),
                     fmt::format("holds a vector of length {:.3g} instead of 1 in element {}", norm, e / width));
      if (sign && std::abs(values[e + 3]) != 1.0f)
        return error(pointer_of(i),
                     fmt::format("holds a tangent whose w is neither 1 nor -1 in element {}", e / width));
    }
  }

  void primitive(const Json& primitive, const std::string& pointer) {
    const Json& attributes = primitive["attributes"];
    const auto attribute = [&](const char* name) {
      return attributes.contains(name) ? attributes[name].get<std::size_t>() : SIZE_MAX;
    };
    if (const std::size_t i = attribute("NORMAL"); i != SIZE_MAX && first(i, Role::kNormal)) unit_vectors(i, 3, false);
    if (const std::size_t i = attribute("TANGENT"); i != SIZE_MAX && first(i, Role::kTangent)) unit_vectors(i, 4, true);
    for (const auto& [name, value] : attributes.items())
      if (name.rfind("COLOR_", 0) == 0 && first(value.get<std::size_t>(), Role::kColor))
        for (const float channel : read_floats(document_, value.get<std::size_t>()))
          if (channel < 0.0f || channel > 1.0f) {
            error(pointer + "/attributes/" + name, "holds a colour outside [0, 1]");
            break;
          }
    weights(attributes, pointer);
    joints(attributes, pointer);
    if (!primitive.contains("indices") || attributes.empty()) return;
    const std::size_t i = primitive["indices"].get<std::size_t>();
    const std::uint64_t vertices = accessor(attributes.begin()->get<std::size_t>())["count"].get<std::uint64_t>();
    if (first(i, Role::kIndex)) {
      std::uint32_t& largest = largest_index_[i];
      for (const std::uint32_t index : read_integers(document_, i)) largest = std::max(largest, index);
    }
    const auto largest = largest_index_.find(i);
    if (largest == largest_index_.end()) return;
    // The largest value of an index type restarts a strip in other formats and on some GPUs (glTF 3.7.2.1).
    if (const std::uint32_t restart = restart_index(accessor(i)["componentType"].get<int>());
        largest->second == restart)
      return error(pointer + "/indices",
                   fmt::format("hold {}, the primitive restart of their type, which glTF forbids", restart),
                   fmt::format("export the mesh with {}",
                               restart < 65536 ? "wider indices" : "indices of vertices that are there"));
    if (largest->second >= vertices)
      error(pointer + "/indices", fmt::format("refer to vertex {} of {}", largest->second, vertices));
  }

  // A vertex's weights must be nonnegative and sum to 1 over all sets.
  void weights(const Json& attributes, const std::string& pointer) {
    std::vector<float> sums;
    for (int set = 0; attributes.contains(fmt::format("WEIGHTS_{}", set)); ++set) {
      const std::size_t i = attributes[fmt::format("WEIGHTS_{}", set)].get<std::size_t>();
      if (!has_data(document_, i) || (set == 0 && !weights_seen_.insert(i).second)) return;
      const std::vector<float> values = read_floats(document_, i);
      sums.resize(values.size() / 4);
      for (std::size_t k = 0; k < values.size(); ++k) {
        if (values[k] < 0.0f)
          return error(pointer + "/attributes", fmt::format("have a negative weight in element {}", k / 4));
        sums[k / 4] += values[k];
      }
    }
    for (std::size_t v = 0; v < sums.size(); ++v)
      if (std::abs(sums[v] - 1.0f) > kWeightTolerance)
        return warn(pointer + "/attributes",
                    fmt::format("have weights that sum to {:.3g} instead of 1 in element {}", sums[v], v), "scaled");
  }

  // Skins of different sizes may share the accessor: its largest index is cached.
  void skinned(const Json& node) {
    const std::size_t joints = json_["skins"][node["skin"].get<std::size_t>()]["joints"].size();
    for (const Json& primitive : json_["meshes"][node["mesh"].get<std::size_t>()]["primitives"])
      for (const auto& [name, value] : primitive["attributes"].items()) {
        const std::size_t i = value.get<std::size_t>();
        if (name.rfind("JOINTS_", 0) != 0) continue;
        if (first(i, Role::kJoints)) {
          std::uint32_t& largest = largest_joint_[i];
          for (const std::uint32_t joint : read_integers(document_, i)) largest = std::max(largest, joint);
        }
        if (const auto largest = largest_joint_.find(i); largest != largest_joint_.end() && largest->second >= joints)
          error(pointer_of(i), fmt::format("refers to joint {} of {}", largest->second, joints));
      }
  }

  // A joint may have only one weight for a vertex (3.7.3.3), within a set and between sets. Skins are only read at
  // rest, where adding duplicate weights gives the same result.
  void joints(const Json& attributes, const std::string& pointer) {
    std::vector<std::pair<std::vector<std::uint32_t>, std::vector<float>>> sets;
    std::set<std::size_t> read;
    for (int set = 0; attributes.contains(fmt::format("JOINTS_{}", set)); ++set) {
      const std::size_t joint = attributes[fmt::format("JOINTS_{}", set)].get<std::size_t>(),
                        weight = attributes[fmt::format("WEIGHTS_{}", set)].get<std::size_t>();
      if (!has_data(document_, joint) || !has_data(document_, weight) || !read.insert(weight).second) return;
      if (set == 0 && !joints_seen_.insert({joint, weight}).second) return;
      sets.emplace_back(read_integers(document_, joint), read_floats(document_, weight));
    }
    if (sets.empty()) return;
    std::vector<std::uint32_t> here;
    for (std::size_t v = 0; 4 * v + 4 <= sets.front().first.size(); ++v) {
      here.clear();
      for (const auto& [joint, weight] : sets)
        for (std::size_t k = 4 * v; k < 4 * v + 4 && k < std::min(joint.size(), weight.size()); ++k) {
          if (weight[k] == 0.0f) continue;
          if (std::find(here.begin(), here.end(), joint[k]) != here.end())
            return warn(pointer + "/attributes", fmt::format("give joint {} two weights in element {}", joint[k], v),
                        "added up");
          here.push_back(joint[k]);
        }
    }
  }

  void bind_matrices(std::size_t i) {
    if (!first(i, Role::kBindMatrices)) return;
    const std::vector<float> m = read_floats(document_, i);
    for (std::size_t k = 0; k + 16 <= m.size(); k += 16)
      if (m[k + 3] != 0.0f || m[k + 7] != 0.0f || m[k + 11] != 0.0f || std::abs(m[k + 15] - 1.0f) > 1e-4f)
        return error(pointer_of(i), fmt::format("holds an inverse bind matrix that is not affine, number {}", k / 16));
  }

  void animations() {
    for (const Json& animation : array_of(json_, "animations")) {
      for (const Json& sampler : animation["samplers"]) {
        const std::size_t input = sampler["input"].get<std::size_t>();
        if (!first(input, Role::kTimes)) continue;
        float before = -1.0f;
        for (const float time : read_floats(document_, input)) {
          if (time < 0.0f || time <= before) {
            error(pointer_of(input), "holds times that are negative or do not increase");
            break;
          }
          before = time;
        }
      }
      for (const Json& channel : animation["channels"]) {
        const Json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
        const std::size_t output = sampler["output"].get<std::size_t>();
        const bool cubic = value_of<std::string>(sampler, "interpolation", "LINEAR") == "CUBICSPLINE";
        if (channel["target"]["path"] != "rotation" ||
            !first(output, cubic ? Role::kRotationSplines : Role::kRotations))
          continue;
        const std::vector<float> q = read_floats(document_, output);
        for (std::size_t k = 0; k * 4 + 4 <= q.size(); ++k) {
          if (cubic && k % 3 != 1) continue;  // tangents are stored before and after each value
          const float norm = std::sqrt(q[4 * k] * q[4 * k] + q[4 * k + 1] * q[4 * k + 1] + q[4 * k + 2] * q[4 * k + 2] +
                                       q[4 * k + 3] * q[4 * k + 3]);
          if (std::abs(norm - 1.0f) > kUnitTolerance) {
            error(pointer_of(output), fmt::format("holds a rotation of length {:.3g} instead of 1", norm));
            break;
          }
        }
      }
    }
  }

  const SourceDocument& document_;
  const Json& json_;
  Findings& findings_;
  std::set<std::pair<std::size_t, Role>> seen_;
  std::set<std::size_t> weights_seen_;
  bool zero_directions_ = false;
  std::map<std::size_t, std::uint32_t> largest_index_, largest_joint_;
  std::set<std::pair<std::size_t, std::size_t>> joints_seen_;  // JOINTS_0 and WEIGHTS_0
};

}  // namespace

bool check_data(const SourceDocument& document, Findings& findings) {
  DataCheck check(document, findings);
  check.all();
  return check.zero_directions();
}

}  // namespace pliant
