// A level as the editor has it: everything that can be changed, in parts that copies share. A State is a value: an edit
// makes another one and leaves the first as it was, so that undo keeps states, and other threads may read one while the
// hand goes on.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "content/level/level.h"
#include "editor/document/script_keys.h"
#include "editor/paint/paint.h"

namespace pliant {

// Stands for a node as long as the document is open, whatever is renamed, moved, deleted and brought back.
using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = 0;

struct DocumentNode {
  NodeId id = kNoNode;
  NodeId parent = kNoNode;
  LevelNode node;  // its `parent` and `children` are not used
};

// A mesh without its painted values.
struct DocumentMesh : LevelMesh {
  Box box;  // [m] mesh frame
  explicit DocumentMesh(LevelMesh mesh);
};

// What is painted on a mesh, one value a vertex of a primitive.
using Channel = PaintAttribute;
inline constexpr Channel kChannels[] = {Channel::kStiffness,  Channel::kFriction, Channel::kDamping,
                                        Channel::kRelaxation, Channel::kPinned,   Channel::kHandle};
std::string name_of(Channel channel);  // "stiffness"
// 0 to 1, 0 where nothing is painted; else a factor, 1 there.
inline bool is_share(Channel channel) {
  return channel >= Channel::kPinned;
}
inline float unpainted(Channel channel) {
  return painted_attribute(channel).unpainted;
}
inline std::vector<float>& painted(Primitive& primitive, Channel channel) {
  return primitive.*painted_attribute(channel).values;
}

struct LayerKey {
  std::uint32_t mesh = 0, primitive = 0;  // into State::meshes, its primitives
  Channel channel = Channel::kStiffness;
  auto operator<=>(const LayerKey&) const = default;
};

// By the file that a device names.
using Scripts = std::map<std::string, std::shared_ptr<const ScriptKeys>>;

struct State {
  std::vector<std::shared_ptr<const DocumentNode>> nodes;  // parents before children
  // Only ever added to, so that a number stands for the same mesh in every state.
  std::vector<std::shared_ptr<const DocumentMesh>> meshes;
  std::map<LayerKey, PaintLayer> paint;  // absent: nothing is painted
  std::shared_ptr<const Level> rest;     // materials, images, animations, notes, source; without nodes and meshes
  std::string about;                     // what the level shows
  std::optional<LevelEnvironment> environment;
  Simulation simulation;
  std::set<std::string> stated;  // keys of the scene that are said, as Level::stated; those of nodes are theirs
  // Paths that devices follow, by the file that they name, relative to the level; files that cannot be read are absent.
  Scripts scripts;

  const DocumentNode* find(NodeId id) const;
  const DocumentNode* find(const std::string& name) const;  // the first of that name
  std::size_t place(NodeId id) const;                       // into `nodes`; their number: none
  std::vector<NodeId> children(NodeId id) const;            // kNoNode: roots
  bool below(NodeId id, NodeId ancestor) const;             // or the same
  dmat4 to_world(NodeId id) const;                          // of its frame; of kNoNode the identity
};

// `next_id` gives ids and is moved on.
State state_of(Level level, NodeId& next_id);
// The whole level, painted values in its meshes: what is saved and played.
Level level_of(const State& state);
// The same without meshes' contents and painted values: names, frames and components, for what asks only for those.
Level outline_of(const State& state);

// Whether both are the same document to the bit: nodes, components, painted values, scene.
bool same(const State& a, const State& b);

// Devices that follow one of these scripts have another driver: no file is looked for that is not written yet.
void leave_out_scripts(Level& level, const Scripts& scripts, DriverKind instead);

// Writes a document's level where it is, or elsewhere; the file appears whole.
Status save_state(const State& state, const std::filesystem::path& file);

}  // namespace pliant
