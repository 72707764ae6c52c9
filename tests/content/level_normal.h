// A Level in a normal form that does not depend on the numbering of nodes and meshes, for comparison.
#pragma once

#include <algorithm>
#include <functional>

#include "content/level/level.h"

namespace pliant::test {

// Parents first, the shown scene first, document nodes in their order; every node with its own mesh; without invisible
// data.
inline Level normal_form(const Level& level) {
  Level out = level;
  out.nodes.clear();
  out.meshes.clear();
  out.animations.clear();
  std::vector<std::int32_t> moved(level.nodes.size(), -1), roots, hidden;
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (level.nodes[i].parent < 0) (level.nodes[i].in_scene ? roots : hidden).push_back(static_cast<std::int32_t>(i));
  const auto rank = [&](std::int32_t i) {
    const std::int32_t source = level.nodes[static_cast<std::size_t>(i)].source;
    return source >= 0 ? source : 1000000 + i;
  };
  std::sort(hidden.begin(), hidden.end(), [&](auto a, auto b) { return rank(a) < rank(b); });
  roots.insert(roots.end(), hidden.begin(), hidden.end());
  const std::function<void(std::int32_t, std::int32_t)> add = [&](std::int32_t node, std::int32_t parent) {
    const LevelNode& from = level.nodes[static_cast<std::size_t>(node)];
    const std::int32_t here = static_cast<std::int32_t>(out.nodes.size());
    moved[static_cast<std::size_t>(node)] = here;
    out.nodes.push_back(from);
    out.nodes.back().parent = parent;
    out.nodes.back().children.clear();
    if (parent >= 0) out.nodes[static_cast<std::size_t>(parent)].children.push_back(here);
    if (from.mesh >= 0) {
      const LevelMesh& mesh = level.meshes[static_cast<std::size_t>(from.mesh)];
      out.nodes.back().mesh = mesh.primitives.empty() ? -1 : static_cast<std::int32_t>(out.meshes.size());
      if (!mesh.primitives.empty()) out.meshes.push_back(mesh);
    }
    for (const std::int32_t child : from.children) add(child, here);
  };
  for (const std::int32_t root : roots) add(root, -1);
  for (LevelAnimation animation : level.animations) {
    if (animation.channels.empty()) continue;
    for (LevelChannel& channel : animation.channels) channel.node = moved[static_cast<std::size_t>(channel.node)];
    out.animations.push_back(std::move(animation));
  }
  return out;
}

}  // namespace pliant::test
