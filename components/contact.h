// Where a probe touches a deformable, and how deep. A probe may touch an object in several places at once: the walls of
// a groove, the folds of an organ. Each object has a pool of contacts; a contact belongs to a probe while it is
// tracked. Rate: touch. Writer: collision (geometry), force_field (amplitude), friction_feedback (law, bristle, force).
// Lives from the level's preparation to its end; `state` tells which members are valid.
#pragma once

#include <cstdint>

#include "components/math.h"
#include "runtime/entity.h"

namespace pliant {

enum class ContactState : std::uint8_t {
  kFree,     // the probe is outside the rest surface; nothing else here is valid
  kInside,   // below the rest surface, but in another probe's dent or in a recovering one. No force
  kTouching  // the probe presses
};

// State of what is felt beside the law: a knock and the fading of detail. Written by friction_feedback; all zero while
// neither is asked for.
struct ContactEffects {
  bool pressed = false;        // it pressed in the last tick
  double knock = 0.0;          // [N]   amplitude of the knock when it began; 0: none
  double knock_time = 0.0;     // [s]   since it began
  double knock_force = 0.0;    // [N]   sent in the last tick, outwards
  double knock_account = 0.0;  // [J] >= 0: work that the hand has done on it and has not got back
  double finest = 0.0;         // [m]   finest wavelength of texture and relief that is felt at this speed
};

// The damage that the tip has done to the surface here. Written by friction_feedback; all zero where nothing breaks or yields.
struct ContactDamage {
  std::uint32_t broken = 0;  // layers that it has gone through
  bool relaxes = false;      // the outer layer broke: its dent recovers from the next tick on
  bool yields = false;       // it has pressed with the yield force, and not with half of it since
  double grip = 0.0;         // [m] bristle of the tip in its hole, along the normal
  bool slides = false;       // in its hole
};

struct Contact {
  Entity probe;                   // has a Probe; kNoEntity: unused, or tissue presses here (systems/touch/feed/press.h)
  std::uint8_t tip = 0;           // index into ProbeState::tips
  Entity object;                  // has a Deformable
  std::uint32_t object_slot = 0;  // index into TouchState::objects
  ContactState state = ContactState::kFree;

  // The foot (P1: interpolated contact vertex), object frame. Written by collision.
  std::uint32_t triangle = 0;    // undeformed triangle under the probe
  dvec3 barycentric{1, 0, 0};    // [1]   of the foot in that triangle
  dvec3 foot{0};                 // [m]   its rest position
  dvec3 normal{0, 1, 0};         // [1]   unit, outward, object frame
  double height = 0.0;           // [m]   t: of the probe's lowest point over the foot; < 0: below the rest surface
  double previous_height = 0.0;  // [m]   t one tick ago, and two: extrapolates the surface if the probe lets go now
  double older_height = 0.0;     // [m]

  // Force law (methods.md 1.8, 1.10). Started by collision, advanced by friction_feedback.
  double free_height = 0.0;    // [m]   y <= 0: height that the surface would have without the probe
  double free_velocity = 0.0;  // [m/s]
  double unpushed = 0.0;       // [m] depth not pushed by the hand: the contact began inside or jumped to a deeper place
  double load = 0.0;           // [sqrt J] l: its part of the shared load, last tick
  double share = 0.0;          // [1]   of its law: 1 alone, 0 in another's dent
  double normal_force = 0.0;   // [N]   >= 0
  dvec3 bristle{0};            // [m]   e: tangential deflection, object frame
  bool sliding = false;
  dvec3 force{0};  // [N]   on the probe, world frame

  // Local derivatives of the force, for extrapolation between two ticks (systems/device/device_model.h). Zero where the
  // contact does not press. Written by friction_feedback.
  dvec3 gradient{0};               // [1]     d height / dx, world frame
  double stiffness = 0.0;          // [N/m]   along the gradient
  double damping = 0.0;            // [N s/m] the same
  double bristle_stiffness = 0.0;  // [N/m]   tangential; zero while it slides
  double bristle_damping = 0.0;    // [N s/m] the same; while it slides, the rise of friction with speed

  ContactEffects effects;
  ContactDamage damage;

  // Field. Written by force_field.
  double amplitude = 0.0;  // [m]  alpha >= 0: the field's target at distance r is -alpha f(r)
};

}  // namespace pliant
