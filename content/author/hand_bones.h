// A hand of tissue on bones: a rigid part for every bone of its digits and a hinge at every joint, closed by the grip
// of its device. The palm is the tool's handle.
#pragma once

#include <array>
#include <string>

#include "content/level/level.h"

namespace pliant {

struct DigitBones {
  std::array<std::string, 3> name;  // of its bones, from the palm outwards
  // [m] world: the root of a thumb's metacarpal or a finger's knuckle, two joints, the tip
  std::array<dvec3, 4> joint;
};
struct HandBones {
  dvec3 wrist{0};                   // [m] world
  std::array<DigitBones, 5> digit;  // the thumb, then the index to the little finger
};

// The node with a skin whose mesh is the largest. Error: the level has none.
Result<std::int32_t> skinned_node(const Level& level);
// By the names of the skin's joints, as those of OpenXR and WebXR: `wrist`; `thumb`, `index`, `middle`, `ring`, and
// `little` or `pinky`, each four times or more up to its tip; a finger's `metacarpal` belongs to the palm. Errors:
// joints that are missing, of two hands, or at one place.
Result<HandBones> bones_of_skin(const Level& level, std::int32_t node);

// Gives a soft body rigid parts, handle, device and hinges, which become roots of the scene; and a cell, if it has
// none. Error: of its tetrahedra.
Status put_on_bones(Level& level, std::int32_t node, const HandBones& bones);

// A device that stays where the node is; its grip closes and opens twice. World frame.
Path closing_path(const Level& level, std::int32_t node);

}  // namespace pliant
