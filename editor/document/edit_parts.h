// Shared by the kinds of edits (edits.h).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "editor/document/edits.h"

namespace pliant {

inline const Error kNoSuchNode{"edit", "the node is not there any more"};

// A copy of the node to change, in a copy of the state.
struct NodeChange {
  State state;
  std::shared_ptr<DocumentNode> node;
};
std::optional<NodeChange> changing(const State& state, NodeId id);

// Updates every reference to a node by name.
void rename_references(State& state, const std::string from, const std::string to);

}  // namespace pliant
