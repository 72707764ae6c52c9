// The soft step's order of things for tests of contact alone: free motion, contacts, impulses, motion.
#pragma once

#include <optional>

#include "systems/soft/body/rigid_state.h"
#include "systems/soft/contact/delassus.h"

namespace pliant::test {

struct ContactLoop {
  std::vector<std::unique_ptr<Body>> bodies;
  std::unique_ptr<Proximity> proximity;
  std::vector<ContactPoint> contacts;
  Delassus delassus;
  ContactProblem problem;
  SweepReport report;
  SweepLimits limits{.sweeps = 200, .tolerance = 1e-8};
  dvec3 gravity{0, -9.81, 0};           // [m/s2]
  std::optional<double> margin = 1e-3;  // [m] for all pairs; none: one per pair
  double beta = 0.15;                   // [1]
  double last = 0.0;                    // [s] length of the last step

  template <class Kind, class... Args>
  Kind& add(Args&&... args) {
    bodies.push_back(std::make_unique<Kind>(std::forward<Args>(args)...));
    return static_cast<Kind&>(*bodies.back());
  }
  void set_friction(double mu_static, double mu_sliding) {
    for (auto& body : bodies) body->friction_static = mu_static, body->friction_sliding = mu_sliding;
  }
  void step(double T) {
    last = T;
    if (!proximity) proximity = std::make_unique<Proximity>(bodies);
    for (auto& body : bodies) body->free_step(T, gravity);
    if (margin)
      proximity->find(bodies, T, *margin, contacts);
    else
      proximity->find(bodies, T, contacts);
    build_problem(bodies, contacts, T, beta, delassus, problem);
    report = solve_and_apply(bodies, *proximity, T, beta, limits, delassus, contacts, problem);
    for (auto& body : bodies) body->advance(T);
  }
  // [N] on body `of`, by body `by`, in the last step.
  dvec3 force(std::uint32_t of, std::uint32_t by) const {
    dvec3 impulse(0);
    for (const ContactPoint& c : contacts) {
      if (c.body_a == of && c.body_b == by) impulse += c.axes * c.impulse;
      if (c.body_b == of && c.body_a == by) impulse -= c.axes * c.impulse;
    }
    return impulse / last;
  }
};

inline RigidMass block_mass(dvec3 size, double mass) {
  const dvec3 s = size * size;
  RigidMass m{.mass = mass};
  m.inertia = dmat3(0.0);
  m.inertia[0][0] = mass / 12.0 * (s.y + s.z);
  m.inertia[1][1] = mass / 12.0 * (s.z + s.x);
  m.inertia[2][2] = mass / 12.0 * (s.x + s.y);
  return m;
}
inline RigidMass sphere_mass(double radius, double mass) {
  RigidMass m{.mass = mass};
  m.inertia = dmat3(0.4 * mass * radius * radius);
  return m;
}

}  // namespace pliant::test
