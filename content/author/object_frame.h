// Where a node's object is: in the frame that PLIANT extensions speak of (its node's, with scale and shear baked into
// the mesh), and in the world.
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

// [m] Of the meshes of a node and of all below it, world.
Box world_box(const Level& level, std::int32_t node);
// [m] Of all meshes of the scene that is shown, world.
Box world_box(const Level& level);

// Unit, against gravity; +Y where there is none.
dvec3 up_of(const Level& level);

// A frame at `eye` whose -Z looks at `target`, as cameras and lights want it; `up` is as far up as that allows. [m]
LocalTransform looking(dvec3 eye, dvec3 target, dvec3 up = {0, 1, 0});

enum class Side : std::uint8_t { kBottom, kTop, kLeft, kRight, kFront, kBack };
// "bottom", "top", ...; nothing for another word.
std::optional<Side> side_of(const std::string& word);
const char* word_of(Side side);
// Unit, world: down and up along gravity, left and right as the camera of add_camera sees them (-X, +X), front towards
// it (+Z).
dvec3 direction_of(const Level& level, Side side);

}  // namespace pliant
