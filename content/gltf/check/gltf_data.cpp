// Checks the bytes of a glTF file against its JSON: finite numbers, declared bounds, indices, unit vectors, weights.
// Every accessor is read once. Placeholders have no data to check.
#include "content/gltf/check/gltf_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "components/math.h"
#include "content/gltf/check/gltf_check.h"
#include "content/gltf/form/gltf_mend.h"

namespace pliant {

namespace {

// Attributes and indices of every primitive.
class PrimitiveData {
 public:
  explicit PrimitiveData(DataCheck& check) : check_(check), json_(check.document.json) {}

  void all() {
    const Json& meshes = array_of(json_, "meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m)
      for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p)
        primitive(meshes[m]["primitives"][p], fmt::format("/meshes/{}/primitives/{}", m, p));
  }
  bool zero_directions() const { return zero_directions_; }

 private:
  // The first three of `width` components are a unit vector; with `sign`, the fourth is 1 or -1.
  void unit_vectors(std::size_t i, std::size_t width, bool sign) {
    const std::vector<float> values = read_floats(check_.document, i);
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
      check_.warn(pointer_of(i),
                  fmt::format("holds {} vector{} of length 0{}, the first in element {}; made anew", zeros,
                              zeros == 1 ? "" : "s",
                              longest > 0.0 ? fmt::format(" or nearly so (at most {:.3g})", longest) : "", first));
    for (std::size_t e = 0; e + width <= values.size(); e += width) {
      if (!has_direction(at(e))) continue;
      const float norm = length(at(e));
      if (std::abs(norm - 1.0f) > kUnitTolerance)
        return check_.error(pointer_of(i),
                            fmt::format("holds a vector of length {:.3g} instead of 1 in element {}", norm, e / width));
      if (sign && std::abs(values[e + 3]) != 1.0f)
        return check_.error(pointer_of(i),
                            fmt::format("holds a tangent whose w is neither 1 nor -1 in element {}", e / width));
    }
  }

  void primitive(const Json& primitive, const std::string& pointer) {
    const Json& attributes = primitive["attributes"];
    const auto attribute = [&](const char* name) {
      return attributes.contains(name) ? attributes[name].get<std::size_t>() : SIZE_MAX;
    };
    if (const std::size_t i = attribute("NORMAL"); i != SIZE_MAX && check_.first(i, DataRole::kNormal))
      unit_vectors(i, 3, false);
    if (const std::size_t i = attribute("TANGENT"); i != SIZE_MAX && check_.first(i, DataRole::kTangent))
      unit_vectors(i, 4, true);
    for (const auto& [name, value] : attributes.items())
      if (name.rfind("COLOR_", 0) == 0 && check_.first(value.get<std::size_t>(), DataRole::kColor))
        for (const float channel : read_floats(check_.document, value.get<std::size_t>()))
          if (channel < 0.0f || channel > 1.0f) {
            check_.error(pointer + "/attributes/" + name, "holds a colour outside [0, 1]");
            break;
          }
    weights_.check(attributes, pointer);
    if (!primitive.contains("indices") || attributes.empty()) return;
    const std::size_t i = primitive["indices"].get<std::size_t>();
    const std::uint64_t vertices =
        check_.accessor(attributes.begin()->get<std::size_t>())["count"].get<std::uint64_t>();
    if (check_.first(i, DataRole::kIndex)) {
      std::uint32_t& largest = largest_index_[i];
      for (const std::uint32_t index : read_integers(check_.document, i)) largest = std::max(largest, index);
    }
    const auto largest = largest_index_.find(i);
    if (largest == largest_index_.end()) return;
    // The largest value of an index type restarts a strip in other formats and on some GPUs (glTF 3.7.2.1).
    if (const std::uint32_t restart = restart_index(check_.accessor(i)["componentType"].get<int>());
        largest->second == restart)
      return check_.error(
          pointer + "/indices",
          fmt::format("hold {}, the primitive restart of their type, which glTF forbids; export the mesh with "
                      "{}",
                      restart, restart < 65536 ? "wider indices" : "indices of vertices that are there"));
    if (largest->second >= vertices)
      check_.error(pointer + "/indices", fmt::format("refer to vertex {} of {}", largest->second, vertices));
  }

  DataCheck& check_;
  const Json& json_;
  WeightData weights_{check_};
  bool zero_directions_ = false;
  std::map<std::size_t, std::uint32_t> largest_index_;
};

}  // namespace

bool check_data(const SourceDocument& document, Findings& findings) {
  DataCheck check(document, findings);
  check_bounds(check);
  PrimitiveData primitives(check);
  primitives.all();
  check_skin_data(check);
  check_animation_data(check);
  return primitives.zero_directions();
}

}  // namespace pliant
