// The pose of a node's object. PLIANT extensions use the object frame: the node's frame, with scale and shear baked
// into the mesh.
#pragma once

#include "components/transform.h"
#include "content/level/level.h"

namespace pliant {

struct ObjectFrame {
  Pose pose;             // object frame to world
  dmat4 to_object{1.0};  // mesh frame to object frame
  Box box;               // [m] of the mesh, object frame; empty: no mesh
};
ObjectFrame object_frame(const Level& level, std::int32_t node);

// [m] Bounding box of all meshes of a node's subtree, world.
Box world_box(const Level& level, std::int32_t node);
// [m] Bounding box of all meshes of the shown scene, world.
Box world_box(const Level& level);

// Unit, against gravity; +Y where there is none.
dvec3 up_of(const Level& level);

// A frame at `eye` whose -Z points at `target`, as glTF cameras and lights need. `up` is projected. [m]
LocalTransform looking(dvec3 eye, dvec3 target, dvec3 up = {0, 1, 0});

enum class Side : std::uint8_t { kBottom, kTop, kLeft, kRight, kFront, kBack };
// "bottom", "top", ...; empty for an unknown word.
std::optional<Side> side_of(const std::string& word);
const char* word_of(Side side);
// Unit, world: down and up along gravity, left and right as the camera of add_camera sees them (-X, +X), front towards
// it (+Z).
dvec3 direction_of(const Level& level, Side side);

}  // namespace pliant
