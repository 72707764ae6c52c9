// Adds, copies, removes, renames and moves nodes of a Level. All references to a node are updated: parents, children,
// animations, and the device names of probes and handles. Nodes keep the order of load_level: parents before children,
// the shown scene first.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

inline constexpr std::int32_t kNoLevelNode = -1;

// `wanted`, or wanted_2, wanted_3, ...: the first name not in use.
std::string free_name(const Level& level, const std::string& wanted);

// Index: a node's old number. Value: its new number, or kNoLevelNode if it was removed.
using NodesMoved = std::vector<std::int32_t>;

// Adds the last child of `parent`, or the last root of the scene (kNoLevelNode). Makes the name unique. Returns its
// number.
std::int32_t add_node(Level& level, LevelNode node, std::int32_t parent = kNoLevelNode, NodesMoved* moved = nullptr);
// Copies a node with its subtree; the copy is its sibling. Meshes are shared; names are made unique. References to a
// device or probe that is copied too go to its copy. Returns the number of the copy.
std::int32_t copy_node(Level& level, std::int32_t node, NodesMoved* moved = nullptr);
// Removes the subtree, meshes that no other node uses, and animation channels of removed nodes.
NodesMoved remove_node(Level& level, std::int32_t node);
// Moves the node to another parent (kNoLevelNode: a root of the scene), as its `place`-th child. Its world transform is
// preserved as far as translation, rotation and scale can represent it. Error: the parent is the node itself or below
// it.
Result<NodesMoved> move_node(Level& level, std::int32_t node, std::int32_t parent, std::size_t place);
// References to this node's device or probe follow, unless another one has the name. Error: the name is empty.
Status rename_node(Level& level, std::int32_t node, const std::string& name);
// Takes a probe that is gone off the list of those that feel an effect. The last name stays, and is an error of the
// level: without it every probe would feel the effect.
// The joint of `node`, where it names this body, names another one; `to` empty: it is removed.
void rename_body(LevelNode& node, const std::string& from, const std::string& to);
void forget_probe(Effect& effect, const std::string& probe);

}  // namespace pliant
