// Shared by the checks of data: the document, the list of findings, and the accessors already checked.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "content/gltf/check/finding_list.h"
#include "content/gltf/form/gltf_accessor.h"
#include "content/gltf/form/gltf_document.h"

namespace pliant {

// Tolerance for the length of unit vectors: the error of 8-bit quantisation.
inline constexpr float kUnitTolerance = 0.00674f;

enum class DataRole { kNormal, kTangent, kColor, kIndex, kJoints, kBindMatrices, kTimes, kRotations, kRotationSplines };

struct DataCheck : FindingList {
  DataCheck(const SourceDocument& of, Findings& findings) : FindingList(findings), document(of) {}
  const Json& accessor(std::size_t i) const { return document.json["accessors"][i]; }
  // True the first time an accessor with data is checked in this role.
  bool first(std::size_t i, DataRole role) { return has_data(document, i) && seen.insert({i, role}).second; }

  const SourceDocument& document;
  std::set<std::pair<std::size_t, DataRole>> seen;
};

inline std::string pointer_of(std::size_t accessor) {
  return fmt::format("/accessors/{}", accessor);
}

// Numbers must be finite, and min and max must match the elements.
void check_bounds(DataCheck& check);

// Joints and weights of a primitive's vertices.
class WeightData {
 public:
  explicit WeightData(DataCheck& check) : check_(check) {}
  void check(const Json& attributes, const std::string& pointer);

 private:
  void weights(const Json& attributes, const std::string& pointer);
  void joints(const Json& attributes, const std::string& pointer);

  DataCheck& check_;
  std::set<std::size_t> weights_seen_;
  std::set<std::pair<std::size_t, std::size_t>> joints_seen_;  // JOINTS_0 and WEIGHTS_0
};
// Joints must be of the skin; bind matrices must be affine.
void check_skin_data(DataCheck& check);
void check_animation_data(DataCheck& check);

}  // namespace pliant
