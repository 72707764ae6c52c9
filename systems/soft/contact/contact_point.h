// A pair of collision mesh points that may touch during the step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "systems/soft/body/body.h"

namespace pliant {

struct ContactPoint {
  std::uint32_t body_a = 0, body_b = 0;  // into SoftState::bodies; equal: self-collision
  SurfacePoint a, b;
  dvec3 normal{0, 1, 0};                     // [1] world, unit, from b's outside towards a; where the step will end
  double gap = 0.0;                          // [m] along it, for the step's linear law: at the end it is gap + T u_n
  double depth = 0.0;                        // [m] >= 0: how deep a is behind b where the step begins
  double end_gap = 0.0;                      // [m] predicted along the normal, after look_again
  bool predicted = false;                    // normal and gap are those of the step's end
  bool again = false;                        // predicted once more, with this step's impulses
  dvec2 lean{0};                             // [1] of the normal against axes[0], along the tangents
  dmat2 turning{0};                          // [1/m] of the normal with slip (contact_geometry.h: find_turning)
  dmat2 over_a{0}, over_b{0};                // [1] how far the place of touch goes over each body, per slip
  double reach = 0.0;                        // [m] of slip: beyond it, what was open when the step ended meets nothing
  dmat3 axes{1};                             // columns: normal, two tangents (steady from step to step)
  double mu_static = 0.4, mu_sliding = 0.3;  // [1] of the pair
  std::uint64_t key = 0;                     // the same pair of features has the same key in the next step: warm start
  dvec3 impulse{0};                          // [N s] along the axes, on a; of the last solve
  bool sliding = false;
  bool joined = false;       // thinning would have left it out, but without it the bodies sink in
  std::uint32_t source = 0;  // whatever Proximity finds it by, in this step
};

// What a step still takes through each other: how many features, and the first of them when [1] of the step.
struct Crossings {
  std::size_t count = 0;
  double first = 1.0;
  void add(const Crossings& more) {
    count += more.count;
    first = std::min(first, more.first);
  }
};

// `out` comes in with the last contacts and their impulses: side, axes, impulse and sliding carry over by key.
// Pairs whose gap may close within a step T [s], by the bodies' surface_velocity, at most a margin apart at the end:
// broad phase over bodies and over each collision mesh's boxes, then vertex-triangle and edge-edge pairs. Normals do
// not flip. Penetrations are followed as deep as the smaller of two bodies is large.
class Proximity {
 public:
  explicit Proximity(const std::vector<std::unique_ptr<Body>>& bodies);
  ~Proximity();
  // What earlier steps knew of this body: it has been put elsewhere.
  void forget(std::uint32_t body);
  // Every pair of bodies with the margin of its own size and edges (proximity.cpp: margin_of), so that no body changes
  // what others feel.
  void find(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& out);
  // All pairs with the same `margin` [m].
  void find(const std::vector<std::unique_ptr<Body>>& bodies, double T, double margin, std::vector<ContactPoint>& out);
  // What find() did not know of and crosses within the step by the bodies' velocities as they now are: what fell beside
  // something that has been stopped meets it. Appends to the contacts of this step's find(); returns the crossings
  // that it saw: those that found no room among the contacts are included, and contacts that slip off their face and
  // would end a margin deep. Surfaces that yield are left out.
  Crossings find_missed(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                        std::vector<ContactPoint>& contacts);
  // The same contacts, as find() gave them, where the step will end by the bodies' velocities as they now are
  // (contact_geometry.h: look_again). False: nothing to speak of is different there.
  bool look_again(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& contacts);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pliant
