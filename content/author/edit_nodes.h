// Nodes of a Level added, copied, removed, renamed and moved in the tree. Whatever refers to a node follows: parents
// and children, animations, and the names by which probes and handles call their device. Nodes stay in the order in
// which load_level has them: parents before children, the scene that is shown first.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

inline constexpr std::int32_t kNoLevelNode = -1;

// `wanted`, or wanted_2, wanted_3...: a name that no node has.
std::string free_name(const Level& level, const std::string& wanted);

// Each of these says where nodes went: by their number before, their number now, kNoLevelNode for those that are gone.
using NodesMoved = std::vector<std::int32_t>;

// The last child of `parent`, or the last root of the scene (kNoLevelNode). The name is made free. Its number.
std::int32_t add_node(Level& level, LevelNode node, std::int32_t parent = kNoLevelNode, NodesMoved* moved = nullptr);
// A copy of a node and of all below it, beside it. Meshes are shared; names are made free; a probe or a handle whose
// device is copied too goes by the copy. The number of the copy.
std::int32_t copy_node(Level& level, std::int32_t node, NodesMoved* moved = nullptr);
// With all below it. Meshes that nobody else shows go too, and so do channels of animations.
NodesMoved remove_node(Level& level, std::int32_t node);
// Under another parent (kNoLevelNode: a root of the scene), as its `place`-th child; where it is in the world stays as
// far as translation, rotation and scale can say it. Error: the parent is the node itself or below it.
Result<NodesMoved> move_node(Level& level, std::int32_t node, std::int32_t parent, std::size_t place);
// Probes and handles that go by this node's device follow, unless another node has the name. Error: it is empty.
Status rename_node(Level& level, std::int32_t node, const std::string& name);

}  // namespace pliant
