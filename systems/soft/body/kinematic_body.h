// Rigid bodies that an animation or a script moves: their motion is prescribed, and contacts do not change it. Pose and
// velocity follow from the motions of a node and its ancestors. Writer: soft clock.
#pragma once

#include <vector>

#include "components/world.h"
#include "systems/soft/body/rigid_state.h"

namespace pliant {

struct KinematicBody {
  // One node on the way from the root to the body.
  struct Link {
    Handle<PrescribedMotion> motion;  // not valid: it does not move
    LocalTransform rest;
  };
  std::uint32_t body = 0;  // into SoftState::bodies, a FixedBody
  std::vector<Link> links;
};

// The links of a node that moves; none if it does not.
std::vector<KinematicBody::Link> links_of(const World& world, Entity entity);
// Sets a body's velocity to that which brings it over the tick to its pose at the tick's end. A jump of its motion has
// no velocity.
void lead(const World& world, const KinematicBody& led, FixedBody& body, Tick tick);

struct ContactPoint;
// [J] that bodies with a prescribed motion give to the others by their contacts and joints in a step of T [s].
double energy_given(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts);

}  // namespace pliant
