#include "editor/document/stated_keys.h"

#include "content/keys/extension_table.h"

namespace pliant {
namespace {

// The set of stated keys for an extension; copies the node into this state.
std::set<std::string>& stated_of(State& state, NodeId id, const std::string& extension) {
  if (find_extension(extension)->on_scene) return state.stated;
  const std::size_t at = state.place(id);
  const auto node = std::make_shared<DocumentNode>(*state.nodes[at]);
  state.nodes[at] = node;
  return node->node.stated;
}

}  // namespace

Result<State> with_stated(const State& state, NodeId id, const std::vector<StatedKey>& keys) {
  Result<State> next(state);
  for (const StatedKey& each : keys) {
    next = with_value(*next, NodeIds(&id, 1), each.extension, each.key, each.value);
    if (!next) return next;
    stated_of(*next, id, each.extension).insert(each.extension + "." + each.key);
  }
  return next;
}

Result<State> without_stated(const State& state, NodeId id, const std::vector<StatedKey>& keys) {
  Result<State> next(state);
  for (const StatedKey& each : keys) {
    next = with_default(*next, NodeIds(&id, 1), each.extension, each.key);
    if (!next) return next;
    stated_of(*next, id, each.extension).erase(each.extension + "." + each.key);
  }
  return next;
}

}  // namespace pliant
