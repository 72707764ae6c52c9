#include "editor/play/live_edits.h"

#include "content/keys/live_keys.h"

namespace pliant {
namespace {

// Probes and tools moved by this node's device.
std::vector<std::string> held_by(const State& state, const DocumentNode& device) {
  std::vector<std::string> names;
  for (const auto& each : state.nodes) {
    const LevelNode& node = each->node;
    const bool probe = node.probe && node.probe_device == device.node.name;
    const bool tool = node.handle && (node.handle->device == device.node.name ||
                                      (node.handle->device.empty() && each->id == device.id));
    if (probe || tool) names.push_back(node.name);
  }
  return names;
}

}  // namespace

LiveEdits live_edits(const State& before, const State& after) {
  LiveEdits out;
  State almost = before;  // with the changes that apply at once
  for (auto& each : almost.nodes) {
    const DocumentNode* const now = after.find(each->id);
    if (!now || now == each.get()) continue;
    DocumentNode changed = *each;
    for (const LiveKey& key : live_keys()) {
      if (key.surface && changed.node.deformable && now->node.deformable) {
        const double to = (*now->node.deformable).*(key.surface);
        double& from = (*changed.node.deformable).*(key.surface);
        if (from == to) continue;
        from = to;
        const bool follows = key.surface == &DeformableParameters::stiffness && now->node.deformable->young > 0.0;
        if (!follows) out.now.push_back({now->node.name, key.key, to});
      }
      if (key.device && changed.node.device && now->node.device) {
        const double to = (*now->node.device).*(key.device);
        double& from = (*changed.node.device).*(key.device);
        if (from == to) continue;
        from = to;
        for (const std::string& name : held_by(after, *now)) out.now.push_back({name, key.key, to});
      }
    }
    each = std::make_shared<const DocumentNode>(std::move(changed));
  }
  out.later = !same(almost, after);
  return out;
}

}  // namespace pliant
