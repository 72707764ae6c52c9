// World transforms and hierarchy of a state's nodes, each computed in one pass.
#pragma once

#include <span>
#include <vector>

#include "components/mesh.h"
#include "editor/document/state.h"

namespace pliant {

// Of every node, node -> world, in the order of State::nodes.
std::vector<dmat4> world_frames(const State& state);
// Whether a node is one of `ids` or below one, in the order of State::nodes.
std::vector<bool> at_or_below(const State& state, std::span<const NodeId> ids);
// Whether a node is visible: in the scene and, if some are isolated, one of them or below one.
std::vector<bool> shown_nodes(const State& state, std::span<const NodeId> isolated);
// Those of `ids` without an ancestor among them, in the order of State::nodes.
std::vector<NodeId> topmost_of(const State& state, std::span<const NodeId> ids);
// [m] world, bounding box of all meshes (and positions of nodes without one); `only`: of these and their subtrees.
Box bounds_of(const State& state, std::span<const NodeId> only = {});
// The same with known frames.
Box bounds_of(const State& state, const std::vector<dmat4>& frames, std::span<const NodeId> only);
// [m] world, of one node's mesh; empty if it has none.
Box bounds_of(const State& state, std::size_t node, const dmat4& frame);

}  // namespace pliant
