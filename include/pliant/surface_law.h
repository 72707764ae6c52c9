// Custom spring laws and shapes for deformable surfaces: derive, register under a name, and set the result in
// DeformableParameters, or the name in a level file (`spring`, `shape`).
//
//   struct Quintic : pliant::SpringFunction { ... };
//   const auto quintic = pliant::register_spring("quintic", std::make_shared<Quintic>());
//
// The touch clock calls the functions thousands of times per tick, from several threads. They must not allocate, lock,
// block or throw, and equal arguments must give equal bits. Fields with them are stepped on the CPU. Register before
// opening a scene; registrations last until the program ends.
#pragma once

#include <memory>
#include <string>

#include "pliant/parameters.h"
#include "pliant/result.h"

namespace pliant {

struct MonotoneCubic;

// The authored constants of DeformableParameters for laws that are not linear.
struct SpringConstants {
  double cubic = 0.0;                    // [1/m2] DeformableParameters::cubic / stiffness
  double stiffening = 0.0;               // [1/m] DeformableParameters::stiffening
  const MonotoneCubic* table = nullptr;  // DeformableParameters::table, of the laws that ship
};

// The restoring force of a vertex against its height h [m] (below zero: pushed in), in units of the stiffness at small
// depth (P1 eq. 1; docs/methods.md 1.2): the force is stiffness * force(h).
class SpringFunction {
 public:
  virtual ~SpringFunction() = default;
  virtual double force(double h, const SpringConstants& constants) const = 0;      // [m] rises with h; 0 at 0
  virtual double potential(double h, const SpringConstants& constants) const = 0;  // [m2] its integral from 0
  virtual double slope(double h, const SpringConstants& constants) const = 0;      // [1] its derivative; 1 at 0
  // [m] Mean of the force between two heights: (potential(h1) - potential(h0)) / (h1 - h0), which makes the step
  // passive. Override it where a closed form does not cancel.
  virtual double mean_force(double h0, double h1, const SpringConstants& constants) const;
};

// How much of the dent's depth a vertex at distance r takes, as a function of u = (r / reach)^2 (P1 section 3;
// docs/methods.md 1.3).
class ShapeFunction {
 public:
  virtual ~ShapeFunction() = default;
  virtual double value(double u) const = 0;  // [1] 1 at u = 0, 0 at u = 1; not called beyond
  virtual double slope(double u) const = 0;  // [1] its derivative by u; 0 at u = 1
};

// At most 32 of each. Error: the name is in use, or the function violates the conditions above. It is tested at some
// hundred points within 2 cm, with cubic 0 and stiffening 100.
Result<SpringLaw> register_spring(const std::string& name, std::shared_ptr<const SpringFunction> function);
Result<Shape> register_shape(const std::string& name, std::shared_ptr<const ShapeFunction> function);

}  // namespace pliant
