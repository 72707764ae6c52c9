// Checks skins against glTF 2.0 (3.7.3.2). A skeleton is the joints' common root or an ancestor of it. A scene that
// shows a skinned mesh contains the joints that move it. Called by check_meaning.
#include <fmt/format.h>

#include <algorithm>

#include "content/gltf/check/gltf_meaning.h"

namespace pliant {
namespace {

// Whether all joints are this node or below it. Results are cached, so that chains are traversed once.
bool all_below(const Json& joints, std::int32_t skeleton, const std::vector<std::int32_t>& parent) {
  std::vector<std::int8_t> known(parent.size(), -1);
  known[static_cast<std::size_t>(skeleton)] = 1;
  std::vector<std::size_t> way;
  for (const Json& joint : joints) {
    std::int32_t at = joint.get<std::int32_t>();
    way.clear();
    while (at >= 0 && known[static_cast<std::size_t>(at)] < 0) {
      way.push_back(static_cast<std::size_t>(at));
      at = parent[static_cast<std::size_t>(at)];
    }
    const std::int8_t below = at < 0 ? std::int8_t{0} : known[static_cast<std::size_t>(at)];
    for (const std::size_t node : way) known[node] = below;
    if (!below) return false;
  }
  return true;
}

// Whether each node is in the scene. Results are cached, so that chains are traversed once.
std::vector<bool> shown_in(const Json& scene, const std::vector<std::int32_t>& parent) {
  std::vector<std::int8_t> known(parent.size(), -1);
  for (const Json& root : array_of(scene, "nodes")) known[root.get<std::size_t>()] = 1;
  std::vector<std::size_t> way;
  for (std::size_t i = 0; i < parent.size(); ++i) {
    auto at = static_cast<std::int32_t>(i);
    way.clear();
    while (at >= 0 && known[static_cast<std::size_t>(at)] < 0) {
      way.push_back(static_cast<std::size_t>(at));
      at = parent[static_cast<std::size_t>(at)];
    }
    const std::int8_t shown = at < 0 ? std::int8_t{0} : known[static_cast<std::size_t>(at)];
    for (const std::size_t node : way) known[node] = shown;
  }
  std::vector<bool> shown(parent.size());
  for (std::size_t i = 0; i < parent.size(); ++i) shown[i] = known[i] > 0;
  return shown;
}

}  // namespace

void check_skeletons(const Json& json, const std::vector<std::int32_t>& parent, Meaning& check) {
  const Json& skins = array_of(json, "skins");
  for (std::size_t s = 0; s < skins.size(); ++s)
    if (skins[s].contains("skeleton") &&
        !all_below(skins[s]["joints"], skins[s]["skeleton"].get<std::int32_t>(), parent))
      check.error(fmt::format("/skins/{}/skeleton", s), "is not above the joints");
  if (skins.empty()) return;
  const Json &nodes = array_of(json, "nodes"), &scenes = array_of(json, "scenes");
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const std::vector<bool> shown = shown_in(scenes[s], parent);
    std::vector<std::int8_t> whole(skins.size(), -1);  // whether the scene contains all joints of a skin
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!shown[i] || !nodes[i].contains("skin")) continue;
      const std::size_t skin = nodes[i]["skin"].get<std::size_t>();
      const Json& joints = skins[skin]["joints"];
      if (whole[skin] < 0)
        whole[skin] = std::all_of(joints.begin(), joints.end(),
                                  [&](const Json& joint) { return bool(shown[joint.get<std::size_t>()]); });
      if (!whole[skin])
        check.error(fmt::format("/nodes/{}/skin", i),
                    fmt::format("has joints that are not in /scenes/{}, which shows this node", s), "add them there");
    }
  }
}

}  // namespace pliant
