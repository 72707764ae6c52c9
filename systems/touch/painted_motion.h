// How each vertex of a painted surface moves (P1 section 3: heterogeneous stiffness and damping). Mass is the same
// everywhere, so that what is painted stiffer comes back faster and what is painted softer more slowly.
// All empty: the whole surface moves as its Motion says. Sized at preparation, padded to whole zones.
#pragma once

#include <array>
#include <vector>

#include "components/math.h"
#include "components/mesh.h"
#include "systems/touch/local_model.h"

namespace pliant {

struct PaintedMotion {
  std::vector<vec4> linear;                 // linear law: hh, hv, vh, vv of the exact step
  std::vector<std::array<float, 9>> solid;  // standard linear solid: rows of the exact step
  std::vector<float> mass, damping;         // cubic and exponential law: [s2] m/k and [s] b/k
  double most_mass = 0.0;                   // [s2] largest m/k: of the slowest vertex
  bool empty() const { return linear.empty() && solid.empty() && mass.empty(); }
};

// What no paint makes softer: a surface without any stiffness would never come back.
inline constexpr double kLeastStiffness = 0.01;  // [1] factor

// The motion where paint multiplies stiffness, damping and the arm's stiffness by these factors, per unit of the
// stiffness there.
Motion paint(const Motion& motion, double stiffness, double damping, double relaxation);

// One step of the free surface there, without the arm of the standard linear solid.
HeightState step_free(const Motion& motion, double stiffness, double damping, HeightState state);

// k1/k at a vertex. [1]
float arm_stiffness(const Motion& motion, const Mesh& mesh, std::uint32_t vertex);

// Nothing where neither stiffness nor damping nor relaxation is painted.
PaintedMotion paint_motion(const Motion& motion, const Mesh& mesh);

}  // namespace pliant
