// Run state of effects. Made by prepare_effects, for every probe of a level with effects.
#pragma once

#include <vector>

#include "components/math.h"
#include "runtime/entity.h"
#include "systems/effects/effect_law.h"
#include "systems/effects/guide_path.h"

namespace pliant {

// The sum of all effects on a probe; on the probe. Rate: touch. Writer: effects; write_devices (the account).
struct FeltEffects {
  dvec3 force{0};        // [N] world: minus the gradient of `energy`
  dvec3 drag{0};         // [N] world: of viscosity
  dvec3 torque{0};       // [N m] world, about the probe's position: of `force`
  dvec3 drag_torque{0};  // [N m] the same, of `drag`
  dmat3 stiffness{0.0};  // [N/m] world: -d force / d position, without its negative eigenvalues
  double damping = 0.0;  // [N s/m] of the drag
  dvec3 carried{0};      // [N m/s] world: velocities of moving viscous regions, each times its part of the drag
  double energy = 0.0;   // [J] of the world, >= 0: stored by all effects
  double before = 0.0;   // [J] last tick's; where a probe or an effect was put elsewhere: this tick's
  double limited = 1.0;  // [1] share of the potentials, for the device's `max_stiffness`
  double reserve = 0.0;  // [J] of the world: what the effects may give to the hand (effect_account.h)
  dvec3 last_torque{0};  // [N m] last tick's
  double sent = 0.0;     // [1] last tick's share of `force` that was sent
  double let_in = 0.0;   // [1] last tick's share that the safety layer's gate let in
};

// A tip on which effects act: of a capsule one of the spheres along its axis.
struct EffectTip {
  dvec3 place{0};          // [m] its centre, probe frame
  std::uint32_t part = 0;  // of the probe: spheres of one capsule have one
  EffectMemory memory;
  EffectValue value;    // this tick's
  double before = 0.0;  // [J] last tick's energy
};

// One effect on one probe, an entity of its own. Rate: touch. Writer: effects.
struct EffectPair {
  Entity effect, probe;
  std::vector<EffectTip> tips;
  bool resting = false;     // of detents: `detent` is valid
  std::int32_t detent = 0;  // the nearest one, 0 at the node
};

// On an effect that guides. Rate: never changes.
struct GuidedBy {
  GuidePath path;
};

}  // namespace pliant
