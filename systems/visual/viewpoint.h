// From where, and how wide. (Viewpoint itself stands in renderer.h.)
#pragma once

#include "components/world.h"
#include "systems/visual/renderer.h"

namespace pliant {

// Object frame to world for what is drawn: the Pose where there is one, else the WorldTransform, else the identity.
mat4 placement_of(const World& world, Entity entity);

mat4 matrix_of(const Pose& pose);

// World box of everything drawn, at rest; of what gives way alone where `only_soft`. [m]
Box drawn_box(const World& world, bool only_soft);

// View and projection matrices, with clip planes that hold a scene of this box. `aspect` is width / height.
mat4 view_of(const Viewpoint& viewpoint);
mat4 projection_of(const Viewpoint& viewpoint, const Box& scene, float aspect);

}  // namespace pliant
