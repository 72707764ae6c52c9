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

// --- Looks
// The places of pictures in a material.
inline constexpr std::int32_t Material::*kTextures[] = {
    &Material::base_color_texture, &Material::metallic_roughness_texture,
    &Material::normal_texture,     &Material::occlusion_texture,
    &Material::emissive_texture,   &Material::transmission_texture,
    &Material::thickness_texture,  &Material::height_texture};
// Changes the material of a part of the node's mesh, for all that share it. A part without one gets it, with all parts
// of its mesh that have none.
Result<State> with_material(const State& state, NodeId id, std::size_t primitive, const Material& material);
// Gives the node a copy of that part's material, which no other node shares.
Result<State> with_own_material(const State& state, NodeId id, std::size_t primitive);
// How many other nodes show the material of that part.
std::size_t sharing_material(const State& state, NodeId id, std::size_t primitive);
// Adds a picture; `number` receives its number.
State with_image(const State& state, Image image, std::int32_t& number);
// Adds a root of the scene with a mesh of one material.
Result<State> with_object(const State& state, NodeId id, LevelNode node, LevelMesh mesh, Material material);

// Makes the node's device follow these keys, in a script of that name beside the level.
Result<State> with_script(const State& state, NodeId id, const std::string& file, const ScriptKeys& keys);

// An edit written for Levels (content/author): it may change nodes and scene, and append nodes and meshes.
Result<State> by_level(const State& state, NodeId& next_id, const std::function<Status(Level&)>& edit);

}  // namespace pliant
