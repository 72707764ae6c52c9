// A pair of collision mesh points that may touch during the step.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "systems/soft/body/body.h"

namespace pliant {

// Of a joint's point (systems/soft/joint/joints.h), along its axes: u + softness lambda + rate off = 0.
struct JointHold {
  std::int32_t joint = -1;  // -1: the point is a contact
  std::uint8_t axes = 0;    // bits of those that it holds; 0: it pushes along the normal alone (a limit, a rope)
  dvec3 off{0};             // [m] at the step's beginning
  dvec3 rate{0};            // [1/s]
  dvec3 softness{0};        // [1/kg]
  double most = HUGE_VAL;   // [N s] bound of its impulse along the first axis
};

struct ContactPoint {
  std::uint32_t body_a = 0, body_b = 0;  // into SoftState::bodies; equal: self-collision
  SurfacePoint a, b;
  dvec3 normal{0, 1, 0};                     // [1] world, unit, from b's outside towards a; at the end of the step
  double gap = 0.0;                          // [m] along it, for the step's linear law: at the end it is gap + T u_n
  double depth = 0.0;                        // [m] >= 0: penetration of a in b at the beginning of the step
  double end_gap = 0.0;                      // [m] predicted along the normal, after look_again
  bool predicted = false;                    // normal and gap are those of the step's end
  bool again = false;                        // predicted once more, with this step's impulses
  dvec2 lean{0};                             // [1] tilt of the normal against axes[0], along the tangents
  dmat2 turning{0};                          // [1/m] change of that tilt with slip (contact_geometry.h: find_turning)
  dmat2 over_a{0}, over_b{0};                // [1] motion of the contact point over each body, per slip
  double reach = 0.0;                        // [m] of slip: beyond it, an open contact no longer exists
  dmat3 axes{1};                             // columns: normal, two tangents (steady from step to step)
  double mu_static = 0.4, mu_sliding = 0.3;  // [1] of the pair
  std::uint64_t key = 0;                     // the same pair of features has the same key in the next step: warm start
  dvec3 impulse{0};                          // [N s] along the axes, on a; of the last solve
  dvec3 strained{0};                         // [m] of a split contact: its local tangential displacement, world
  double dented = 0.0;                       // [m] of a split contact: depth of its local dent, of the last solve
  double relaxed = 0.0;                      // [N] of a DentLaw that relaxes: the part of its force that has
  bool sliding = false;
  double slipped = 0.0;  // [m] at the static limit, since it last stuck
  bool joined = false;   // added although thinning dropped it: without it the bodies sink in
  JointHold hold;
  std::uint32_t source = 0;  // an index of Proximity, in this step
};

// Crossings that a step still has: number of features, and the time of the first [1] of the step.
struct Crossings {
  std::size_t count = 0;
  double first = 1.0;
  void add(const Crossings& more) {
    count += more.count;
    first = std::min(first, more.first);
  }
};

// On entry `out` has the last contacts and their impulses: side, axes, impulse and sliding carry over by key. Finds
// pairs whose gap may close within a step T [s], by the bodies' surface_velocity, at most a margin apart at the end.
// Broad phase over bodies and over each collision mesh's boxes, then vertex-triangle and edge-edge pairs. Normals do
// not flip. Penetrations are tracked up to the size of the smaller body.
class Proximity {
 public:
  explicit Proximity(const std::vector<std::unique_ptr<Body>>& bodies);
  ~Proximity();
  // Clears the memory of this body: it has been placed elsewhere.
  void forget(std::uint32_t body);
  // Every pair of bodies uses the margin of its size and edges (proximity.cpp: margin_of), so that no body affects
  // other pairs.
  void find(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& out);
  // All pairs with the same `margin` [m].
  void find(const std::vector<std::unique_ptr<Body>>& bodies, double T, double margin, std::vector<ContactPoint>& out);
  // Finds crossings within the step, by the bodies' current velocities, that find() did not know of: a body that moved
  // past a stopped one touches it. Appends to the contacts of this step's find(). Returns the number of crossings,
  // including those without room among the contacts, and contacts that leave their face and would end a margin deep.
  // Yielding surfaces are excluded.
  Crossings find_missed(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                        std::vector<ContactPoint>& contacts);
  // Updates the contacts of find() to the end of the step by the bodies' current velocities (contact_geometry.h:
  // look_again). False: no significant change.
  bool look_again(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& contacts);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pliant
