// The editor's representation of a level: all editable data, in parts that copies share. A State is a value: an edit
// creates a new one and leaves the old one unchanged. Undo keeps states, and other threads can read one during edits.
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

// Identifies a node while the document is open, through renaming, moving, deletion and undo.
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

// The painted values of a mesh, one per vertex of a primitive.
using Channel = PaintAttribute;
inline constexpr Channel kChannels[] = {Channel::kStiffness,  Channel::kFriction, Channel::kDamping,
                                        Channel::kRelaxation, Channel::kPinned,   Channel::kHandle};
std::string name_of(Channel channel);  // "stiffness"
// Shares: 0 to 1, default 0; else a factor, default 1.
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

// By the file name in the device.
using Scripts = std::map<std::string, std::shared_ptr<const ScriptKeys>>;

struct State {
  std::vector<std::shared_ptr<const DocumentNode>> nodes;  // parents before children
  // Only appended to, so that a number identifies the same mesh in every state.
  std::vector<std::shared_ptr<const DocumentMesh>> meshes;
  std::map<LayerKey, PaintLayer> paint;                // absent: unpainted
  std::shared_ptr<const std::vector<Material>> looks;  // materials by number; null: none
  std::shared_ptr<const Level> rest;  // images, animations, notes, source; without nodes, meshes and materials
  std::string about;                  // description of the level
  std::optional<LevelEnvironment> environment;
  LevelSimulation simulation;
  std::set<std::string> stated;  // stated keys of the scene, as Level::stated; nodes have their own
  // Paths of devices, by file name relative to the level; unreadable files are absent.
  Scripts scripts;

  const std::vector<Material>& materials() const;
  const DocumentNode* find(NodeId id) const;
  const DocumentNode* find(const std::string& name) const;  // the first with that name
  std::size_t place(NodeId id) const;                       // into `nodes`; their number: not found
  std::vector<NodeId> children(NodeId id) const;            // kNoNode: roots
  bool below(NodeId id, NodeId ancestor) const;             // or the same
  dmat4 to_world(NodeId id) const;                          // of its frame; of kNoNode the identity
};

// `next_id` is the source of ids and is incremented.
State state_of(Level level, NodeId& next_id);
// The whole level with painted values in its meshes, for saving and playing.
Level level_of(const State& state);
// The same without mesh contents and painted values: names, frames and components only.
Level outline_of(const State& state);
// Removes meshes that no node shows, and numbers the others anew.
void drop_unseen_meshes(Level& level);

// Whether both documents are identical, bit by bit: nodes, components, painted values, scene.
bool same(const State& a, const State& b);
// The same, without the materials.
bool same_but_looks(const State& a, const State& b);

// Replaces the driver of devices that follow one of these scripts, because their files may not be written yet.
void leave_out_scripts(Level& level, const Scripts& scripts, DriverKind instead);

// Writes a document's level to its file or another one, atomically.
Status save_state(const State& state, const std::filesystem::path& file);

}  // namespace pliant
