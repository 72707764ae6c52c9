#include "content/safety_cap.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/gltf/form/gltf_document.h"

namespace pliant {
namespace {

constexpr std::size_t kNamed = 3;

// Returns whether the value was above the cap.
bool lower(double& value, double cap) {
  if (!(value > cap)) return false;
  value = cap;
  return true;
}

bool lower(LevelNode& node, const SafetyCap& cap) {
  bool any = false;
  if (node.device) {
    any = lower(node.device->max_force, cap.max_force) || any;
    any = lower(node.device->max_slew, cap.max_slew()) || any;
  }
  if (node.handle) any = lower(node.handle->max_torque, cap.max_torque()) || any;
  return any;
}

}  // namespace

std::vector<std::string> cap_safety(Level& level, const SafetyCap& cap) {
  std::size_t lowered = 0;
  std::string names;
  for (std::size_t n = 0; n < level.nodes.size(); ++n) {
    if (!lower(level.nodes[n], cap)) continue;
    if (lowered++ < kNamed) names += (names.empty() ? "`" : ", `") + level.nodes[n].name + "`";
  }
  if (lowered == 0) return {};
  if (level.source) level.source->cap = cap;
  if (lowered > kNamed) names += fmt::format(" and {} more", lowered - kNamed);
  return {
      fmt::format("{}: the file asks for more than max_force {:g} N, max_slew {:.4g} N/s or max_torque {:.3g} N m, "
                  "which is what it "
                  "gets; allow more with --max-force, or one of them with --set",
                  names, cap.max_force, cap.max_slew(), cap.max_torque())};
}

}  // namespace pliant
