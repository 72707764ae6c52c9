// Edits of a level: each function returns a new State, or an error sentence. Document::change takes the result. Edits
// of several nodes are one edit.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <span>

#include "editor/document/state.h"
#include "runtime/result.h"

namespace pliant {

using Json = nlohmann::json;
using NodeIds = std::span<const NodeId>;

// --- The tree
// An unused name: "probe", "probe 2", "probe 3" ...
std::string unique_name(const State& state, const std::string& wanted);
// Updates references by name. Error: another node has the name.
Result<State> renamed(const State& state, NodeId id, const std::string& name);
Result<State> with_node(const State& state, NodeId id, NodeId parent, LevelNode node);  // its name is made unique
Result<State> without(const State& state, NodeIds ids);                                 // with their subtrees
// Copies subtrees under the same parents; `ids_out` receives the copies' ids. References within the copied nodes refer
// to the copies.
Result<State> duplicated(const State& state, NodeIds ids, NodeId& next_id, std::vector<NodeId>* ids_out = nullptr);
// Inserts nodes of another state (the clipboard), with their meshes, below `parent`.
Result<State> pasted(const State& state, const State& from, NodeIds ids, NodeId parent, NodeId& next_id,
                     std::vector<NodeId>* ids_out = nullptr);
// Moves nodes below another parent (kNoNode: a root) and before a sibling (kNoNode: last); world transforms are
// preserved.
Result<State> reparented(const State& state, NodeIds ids, NodeId parent, NodeId before = kNoNode);

// --- One node
Result<State> placed(const State& state, NodeId id, const LocalTransform& local);
struct Placing {
  NodeId id = kNoNode;
  LocalTransform local;
};
Result<State> placed(const State& state, std::span<const Placing> all);  // skips deleted nodes
Result<State> with_light(const State& state, NodeId id, const std::optional<Light>& light);
Result<State> with_camera(const State& state, NodeId id, const std::optional<Camera>& camera);

// --- Components, by the key table: `extension` without PLIANT_, `key` as in the level format
Result<State> with_component(const State& state, NodeIds ids, const std::string& extension);
Result<State> without_component(const State& state, NodeIds ids, const std::string& extension);
// For every node of `ids` that has the component; for scene extensions `ids` is ignored.
Result<State> with_value(const State& state, NodeIds ids, const std::string& extension, const std::string& key,
                         const Json& value);
Result<State> with_default(const State& state, NodeIds ids, const std::string& extension, const std::string& key);
// The value; null: the node lacks the component. kNoNode: the scene.
Json value_of_key(const State& state, NodeId id, const std::string& extension, const std::string& key);
Json default_of_key(const std::string& extension, const std::string& key);
bool has_component(const State& state, NodeId id, const std::string& extension);

// --- Paint and meshes
Result<State> with_layer(const State& state, const LayerKey& key, PaintLayer layer);
Result<State> without_layer(const State& state, std::uint32_t mesh, Channel channel);  // of all its primitives
// Gives the node its own mesh (a refined one, for instance); other nodes keep theirs. Painted values are in the mesh's
// arrays.
Result<State> with_mesh(const State& state, NodeId id, LevelMesh mesh);

// Makes the node's device follow these keys, in a script of that name beside the level.
Result<State> with_script(const State& state, NodeId id, const std::string& file, const ScriptKeys& keys);

// An edit written for Levels (content/author): it may change nodes and scene, and append nodes and meshes.
Result<State> by_level(const State& state, NodeId& next_id, const std::function<Status(Level&)>& edit);

}  // namespace pliant
