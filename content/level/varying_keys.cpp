#include "content/level/varying_keys.h"

#include <algorithm>

namespace pliant {
namespace {

constexpr const char* kNodes = "/nodes/";
constexpr const char* kExtensions[] = {"/extensions/PLIANT_deformable/", "/extensions/PLIANT_joint/"};

}  // namespace

const std::vector<VaryingKey>& varying_keys() {
  using D = DeformableParameters;
  using R = DeformableRange;
  static const std::vector<VaryingKey> keys{{"stiffness", R::kStiffness, {&D::stiffness}},
                                            {"contact_damping", R::kContactDamping, {&D::contact_damping}},
                                            {"damping_ratio", R::kDampingRatio, {&D::damping_ratio}},
                                            {"friction", kFrictionRange, {&D::friction_static, &D::friction_sliding}},
                                            {"friction_static", kFrictionRange, {&D::friction_static}},
                                            {"friction_sliding", kFrictionRange, {&D::friction_sliding}},
                                            {"friction_viscous", R::kViscous, {&D::friction_viscous}},
                                            {"rest", JointRange::kLimits, {}}};
  return keys;
}

const VaryingKey* find_varying_key(const std::string& key) {
  for (const VaryingKey& each : varying_keys())
    if (key == each.key) return &each;
  return nullptr;
}

KeyPointer key_pointer(const std::string& pointer) {
  const std::string nodes = kNodes;
  if (!pointer.starts_with(nodes)) return {};
  const std::size_t end = std::min(pointer.find_first_not_of("0123456789", nodes.size()), pointer.size());
  const std::string digits = pointer.substr(nodes.size(), end - nodes.size());
  if (digits.empty() || digits.size() > 9) return {};
  for (const bool of_joint : {false, true}) {
    const std::string extension = kExtensions[of_joint];
    if (pointer.compare(end, extension.size(), extension) != 0) continue;
    std::string key = pointer.substr(end + extension.size());
    std::replace(key.begin(), key.end(), '/', '.');
    const VaryingKey* const its = find_varying_key(key);
    if (its && its->of_joint() != of_joint) return {};
    return {std::stol(digits), key};
  }
  return {};
}

std::string pointer_of_key(std::int64_t node, const std::string& key) {
  std::string path = key;
  std::replace(path.begin(), path.end(), '.', '/');
  const VaryingKey* const its = find_varying_key(key);
  return kNodes + std::to_string(node) + kExtensions[its && its->of_joint()] + path;
}

}  // namespace pliant
