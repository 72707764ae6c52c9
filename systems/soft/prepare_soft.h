// Between load and the first soft step: a Body for everything that contacts can push or press.
#pragma once

#include "components/soft_body.h"
#include "components/world.h"
#include "runtime/result.h"
#include "systems/soft/body/body.h"

namespace pliant {

// What a rigid body of these parameters weighs, by its collision mesh. An error where it encloses nothing.
Result<RigidMass> rigid_mass(const World& world, Entity entity, const RigidBody& body);

// Call after prepare_touch and prepare_tools. Makes World::soft and World::soft_snapshots anew from SoftBody, RigidBody
// and Deformable; where nothing soft or rigid could move they are null, and there is no soft clock. Refuses bodies that
// weigh nothing, and a soft_step that is no duration. Allocates.
Status prepare_soft(World& world);

}  // namespace pliant
