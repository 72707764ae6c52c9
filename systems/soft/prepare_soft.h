// Between load and the first soft step: creates a Body for everything that contacts can push or press.
#pragma once

#include "components/soft_body.h"
#include "components/world.h"
#include "runtime/result.h"
#include "systems/soft/body/body.h"

namespace pliant {

// Mass properties of a rigid body with these parameters, from its collision mesh. An error if it encloses no volume.
Result<RigidMass> rigid_mass(const World& world, Entity entity, const RigidBody& body);

// Call after prepare_touch and prepare_tools. Rebuilds World::soft and World::soft_snapshots from SoftBody, RigidBody
// and Deformable. Without movable soft or rigid bodies they are null, and there is no soft clock. Rejects bodies
// without mass, and an invalid soft_step. Allocates.
Status prepare_soft(World& world);

}  // namespace pliant
