// Place and depth of a contact, from its foot and the creases around it (foot_blend.h).
#pragma once

#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// Behind the surface: blended with the feet on the sides of convex creases, as far as they matter. x [m], object frame.
// `before`: the blend a tick ago, whose sides are followed. nullptr: none.
FootBlend contact_place(const ObjectState& object, const Mesh& mesh, const Foot& own, dvec3 x,
                        const FootBlend* before = nullptr);

}  // namespace pliant
