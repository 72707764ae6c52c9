// Edits which objects of a level can be touched, and where they are pinned.
#pragma once

#include <span>

#include "content/author/object_frame.h"

namespace pliant {

// Makes the node a deformable surface (P1) or a soft body (P2), and removes the other. Error: it has no mesh, or its
// mesh has no area.
Status make_touchable_surface(Level& level, std::int32_t node, const DeformableParameters& parameters = {});
Status make_soft(Level& level, std::int32_t node, const SoftBodyParameters& parameters = {});

// Pins the part of the object on that side: `share` [1] of its extent there, along the axis of the object frame that is
// nearest to the side's direction. The first side is the soft body's pinned box, others are painted on its mesh. Error:
// no soft body, or a share that is not within (0, 1].
Status pin(Level& level, std::int32_t node, Side side, double share = 0.15);
// Removes the pinned box and the painted weights.
void unpin(Level& level, std::int32_t node);

// Gives the node a mesh that no other node uses, so that it can be painted alone.
LevelMesh& own_mesh(Level& level, std::int32_t node);
// Sets _PINNED of these vertices of a primitive of the node's mesh to `value`, within [0, 1]. Others keep theirs.
Status pin_vertices(Level& level, std::int32_t node, std::size_t primitive, std::span<const std::uint32_t> vertices,
                    float value = 1.0f);

}  // namespace pliant
