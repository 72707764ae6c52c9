// Seams: places where surfaces are so close that a probe feels one surface. Examples are nodes that are flush with each
// other, an organ in parts, and cracks in one mesh. A foot that reaches such an edge continues on the other surface.
#pragma once

#include <array>

#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// A crack narrower than this share of the mean edge in the file is ignored (as is one a third wider). [1]
inline constexpr double kCrack = 0.02;

// [m] Twice that: no crack that is ignored is wider.
double crack_of(const Mesh& mesh);

// Of a triangle, outwards. [1]
dvec3 facet_normal(const Mesh& mesh, std::uint32_t triangle);
// Of an object's surface.
const Mesh& touch_mesh(const World& world, const ObjectState& object);

// The seams under a foot: of a vertex, up to two. Null: none.
std::array<const Seam*, 3> seams_at(const ObjectState& object, const Foot& foot);
// Whether a foot is on either side of a seam.
bool at_seam(const ObjectState& object, const Foot& foot);
// Whether another surface covers a foot: it is at a seam of others, as the side wall of a crack is at that of its top.
bool is_covered(const ObjectState& object, const Foot& foot);

// Pose of the second in the first's frame.
Pose relative_pose(const Pose& first, const Pose& second);

// Largest number of key times at which moving surfaces are examined.
inline constexpr std::size_t kMostKeyTimes = 64;

// Finds the seams of surfaces that are flush at the start, or at a key of the motion of one of them
// (TouchState::moving, the first kMostKeyTimes). Allocates.
void find_seams(World& world, TouchState& touch);

// Opens the seams of an object that has left the pose at which it was flush with another, and closes those of one that
// has come back. Does not allocate.
void move_seams(const World& world, TouchState& touch, std::uint32_t slot);

}  // namespace pliant
