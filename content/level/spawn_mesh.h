// Meshes as built for a level's nodes: a mesh is built once for every distinct scale of the nodes that show it, and
// again where a node's dents need a finer one.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "content/level/spawn_state.h"
#include "content/mesh/mesh_build.h"

namespace pliant {

// Properties that nodes must have in common to share a built mesh.
struct TouchShape {
  bool touchable;
  double crease_angle;              // [rad]
  std::array<float, 16> to_object;  // the transform baked into the mesh
  auto operator<=>(const TouchShape&) const = default;
};

// A mesh as built for a node.
struct BakedMesh {
  std::optional<DentSize> dents;  // dents that the mesh must resolve; empty: none
  bool refined = false;           // refined for that
  Handle<Mesh> touch;
  Handle<DrawMesh> draw;
};

inline bool is_touched(const LevelNode& node) {
  return node.deformable || node.rigid_body;
}
// A moving node that is only drawn may change its scale, so its transform is not baked into its mesh.
inline bool has_pose(const SpawnState& state, std::size_t n) {
  return is_touched(state.level.nodes[n]) || !state.motions.moves[n];
}

class MeshBaker {
 public:
  explicit MeshBaker(SpawnState& state) : state_(state), baked_(state.level.meshes.size()) {}

  // Counts the total size of the level before anything is built.
  Status count() const;
  Result<BakedMesh> bake(std::size_t n);
  // One note per mesh, for all its nodes.
  void note_winding(std::int32_t mesh, const BuiltMesh& built);
  // One note for all nodes whose mesh was refined.
  void say_refinement();

 private:
  TouchShape shape_of(std::size_t n) const;
  bool serves(const BakedMesh& built, const BakedMesh& wanted) const;
  void note_refinement(const LevelNode& node, const BuiltMesh& built);

  SpawnState& state_;
  std::vector<std::map<TouchShape, std::vector<BakedMesh>>> baked_;  // of each mesh of the level
  std::set<std::int32_t> noted_;                                     // meshes whose winding has been noted
  struct {
    std::size_t count = 0, from = 0, to = 0;  // nodes, triangles
    std::string names;
  } refined_;
};

// 1,234,567
std::string with_commas(std::size_t number);

}  // namespace pliant
