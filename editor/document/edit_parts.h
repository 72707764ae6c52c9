// Shared by the kinds of edits (edits.h).
#pragma once

#include <map>
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

// Materials of another state's meshes, with their pictures: each is added once.
class LooksBrought {
 public:
  void bring(State& to, const State& from, LevelMesh& mesh);

 private:
  std::map<std::int32_t, std::int32_t> material_, image_;
};

// Updates every reference to a node by name.
void rename_references(State& state, const std::string from, const std::string to);

}  // namespace pliant
