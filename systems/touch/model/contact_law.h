// Stored energy and force of one contact, as if it were alone (methods.md 1.8, 1.10). The law of the depth d behind the
// rest surface is
//   F(d) = law(d) - law(y) + r1 (law(d) - S(q)),   never negative,   W = its integral from where it is zero,
// y: depth of the free surface. It is 0 at rest. For a recovering surface it is the depth without the contact; it also
// covers unpushed depth (Contact::unpushed).
//
// law(d) = S(z(d)), z the law's stiffening of the depth. S(z) = k z, or, with Young's modulus and a sphere, Hertz's
// 4/3 E* sqrt(r) z^1.5 or the curve of components/sphere_curve.h. A point presses as a flat punch of the smallest
// radius, whose stiffness is k.
//
// r1 = k1/k, of a law with an arm. q: the relaxed part of z at the foot, q' = (z - q) / tau. The arm is passive for any
// q that moves towards z, as S rises: it stores r1 (P(d) - P(e) - S(q) (d - e)) >= 0, P the integral of law and z(e) =
// q.
//
// Of a surface with layers, law(d) is the sum of the layers' own, each below its top and, where it is broken, its share
// that remains (methods.md 1.14).
#pragma once

#include <span>

#include "components/deformable.h"
#include "systems/touch/model/local_model.h"

namespace pliant {

// law(depth) [N]; odd if the restoring law is. `stiffness` [N/m] is the local one (painted factor included).
double law_force(const RestoringLaw& law, double stiffness, double depth);

// A painted factor (Mesh::stiffness_factor, friction_factor) at a place on the surface. [1]
double painted(const std::vector<float>& factor, const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric);

// The force of a contact no longer rises above this: squares of it stay finite, whatever the law. [N]
inline constexpr double kMostForce = 1e9;

struct StoredEnergy {
  double energy = 0.0;      // [J]  W
  double force = 0.0;       // [N]  dW/dd >= 0
  double by_relaxed = 0.0;  // [N]  dW/dq <= 0
  double by_arm = 0.0;      // [J]  dW/dr1
};

struct ContactLaw {
  const RestoringLaw* law = nullptr;  // of the Motion
  double stiffness = 0.0;             // [N/m] at the foot, painted factor included
  double hertz = 0.0;  // [N/m^1.5] 4/3 E* sqrt(r), painted factor included; 0: not a sphere of known modulus
  const SphereCurve* sphere = nullptr;  // of that sphere, of the Motion; nullptr: Hertz
  double unit = 0.0;                    // [m] of the curve's depth
  double arm = 0.0;                     // [1] k1/k at the foot, painted factor included
  double relaxed = 0;                   // [m]   q >= 0
  double free_depth = 0.0;              // [m]   y >= 0
  std::span<const Layer> layers;
  std::uint32_t broken = 0;  // layers, from the surface down
  double unlayered = 1.0;    // [N/m] stiffness that `law`'s factors are of, for those of the layers

  double force(double depth) const;      // [N] law(d)
  double slope(double depth) const;      // [N/m] of force(), arm included
  double potential(double depth) const;  // [J] its integral from 0
  StoredEnergy stored(double depth) const;
  // Of a layer alone, without free_depth's: [N], [J].
  double layer_force(std::size_t layer, double depth) const;
  double layer_energy(std::size_t layer, double depth) const;

 private:
  double own_force(double depth) const;
  double own_slope(double depth) const;
  double own_potential(double depth) const;
  // The sum of `own` over the layers and what is below them.
  template <class Own>
  double over_layers(double depth, Own own) const;
  struct Limited {
    double force, potential;  // [N] at most kMostForce, [J] its integral from 0
  };
  double of_depth(double z) const;  // [N] S
  double of_depth_slope(double z) const;
  double depth_of_zero(double pressed) const;
  Limited limited(double depth) const;
};

// E* = E / (1 - nu^2). [Pa]
double plane_modulus(const Deformable& deformable);

// The law at a place whose painted stiffness factor is `factor` [1], for a tip of this radius [m]. It lives as long as
// the motion.
ContactLaw contact_law(const Deformable& deformable, const Motion& motion, double factor, double radius);
ContactLaw contact_law(const Deformable& deformable, Motion&& motion, double factor, double radius) = delete;

}  // namespace pliant
