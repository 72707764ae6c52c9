// Where a probe touches a deformable, and how deep. One per (probe, object) pair, never one per object: a second tool
// far away must not feel the first one's contact. Rate: touch. Writer: collision (geometry), force_field (amplitude,
// targets), friction_feedback (law, bristle, force). Lives from the level's preparation to its end; `state` says
// whether it means anything now.
#pragma once

#include <cstdint>

#include "components/math.h"
#include "runtime/entity.h"

namespace pliant {

enum class ContactState : std::uint8_t {
  kFree,     // the probe is outside the rest surface; nothing else here is valid
  kInside,   // below the rest surface but above the current one (which is still recovering from an earlier press)
  kTouching  // the probe holds the surface down
};

struct Contact {
  Entity probe;                   // has a Probe; kNoEntity: flesh presses here (systems/touch/press.h)
  Entity object;                  // has a Deformable
  std::uint32_t object_slot = 0;  // its place in TouchState::objects
  ContactState state = ContactState::kFree;

  // The virtual vertex (P1: interpolated contact vertex), object frame. Written by collision.
  std::uint32_t triangle = 0;    // undeformed triangle under the probe
  dvec3 barycentric{1, 0, 0};    // [1]   of the virtual vertex in that triangle
  dvec3 foot{0};                 // [m]   its rest position P(u,v), object frame
  dvec3 normal{0, 1, 0};         // [1]   interpolated, unit, outward, object frame
  double height = 0.0;           // [m]   t: of the probe's lowest point along the normal; < 0: below the rest surface
  double previous_height = 0.0;  // [m]   t one tick ago, and two: what the surface would do if the probe let go now
  double older_height = 0.0;     // [m]
  bool interpolated = true;      // false: no virtual vertex exists here (crease, border); closest point instead

  // Force law (methods.md 1.8). Started by collision at touch, advanced by friction_feedback; rim_height by
  // force_field.
  bool just_touched = false;      // this tick is the first of the touch
  double surface_height = 0.0;    // [m]   h*: height of the surface at the virtual vertex
  double surface_velocity = 0.0;  // [m/s] its rate
  double free_height = 0.0;       // [m]   y: what h* would be had the probe not come
  double free_velocity = 0.0;     // [m/s]
  double rim_height = 0.0;        // [m]   >= 0: how high other probes' fields hold the surface up here
  double arm_force = 0.0;         // [N]   q of the standard linear solid
  double normal_force = 0.0;      // [N]   >= 0
  dvec3 bristle{0};               // [m]   e: tangential deflection, object frame
  bool sliding = false;
  dvec3 force{0};  // [N]   on the probe, world frame

  // Field. Written by force_field.
  double amplitude = 0.0;  // [m]  alpha >= 0: the field's target at distance r is -alpha f(r)
};

}  // namespace pliant
