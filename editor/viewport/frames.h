// Where a state's nodes are in the world, and what stands below what: each in one walk over the nodes.
#pragma once

#include <span>
#include <vector>

#include "components/mesh.h"
#include "editor/document/state.h"

namespace pliant {

// Of every node, node -> world, in the order of State::nodes.
std::vector<dmat4> world_frames(const State& state);
// Whether a node is one of `ids` or stands below one, in the order of State::nodes.
std::vector<bool> at_or_below(const State& state, std::span<const NodeId> ids);
// Whether a node is shown: it is in the scene and, where some are isolated, one of them or below one.
std::vector<bool> shown_nodes(const State& state, std::span<const NodeId> isolated);
// Those of `ids` that no other one of them stands above, in the order of State::nodes.
std::vector<NodeId> topmost_of(const State& state, std::span<const NodeId> ids);
// [m] world, around all meshes (and the places of nodes without) of a state; `only`: of these and what is below them.
Box bounds_of(const State& state, std::span<const NodeId> only = {});
// The same where the frames are known.
Box bounds_of(const State& state, const std::vector<dmat4>& frames, std::span<const NodeId> only);
// [m] world, of one node's mesh; empty where it has none.
Box bounds_of(const State& state, std::size_t node, const dmat4& frame);

}  // namespace pliant
