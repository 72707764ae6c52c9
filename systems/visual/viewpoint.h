// Camera transforms. (Viewpoint itself is in renderer.h.)
#pragma once

#include "components/world.h"
#include "systems/visual/renderer.h"

namespace pliant {

// Object frame to world of a drawn entity: the Pose if it has one, else the WorldTransform, else the identity.
mat4 placement_of(const World& world, Entity entity);

mat4 matrix_of(const Pose& pose);

// World box of everything drawn, at rest; only of deformable objects if `only_soft`. [m]
Box drawn_box(const World& world, bool only_soft);

// View and projection matrices, with clip planes that contain a scene of this box. `aspect` is width / height.
mat4 view_of(const Viewpoint& viewpoint);
mat4 projection_of(const Viewpoint& viewpoint, const Box& scene, float aspect);

}  // namespace pliant
