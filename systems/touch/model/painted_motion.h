// Motion of each vertex of a painted surface (P1 section 3: heterogeneous stiffness and damping). Mass is uniform:
// stiffer vertices recover faster, softer ones more slowly.
// All empty: the whole surface moves by its Motion. Sized at preparation, padded to whole zones.
#pragma once

#include <array>
#include <vector>

#include "components/math.h"
#include "components/mesh.h"
#include "systems/touch/model/local_model.h"

namespace pliant {

struct PaintedMotion {
  std::vector<vec4> linear;                 // linear law: hh, hv, vh, vv of the exact step
  std::vector<std::array<float, 9>> solid;  // standard linear solid: rows of the exact step
  std::vector<float> mass, damping;         // laws with a passive step: [s2] m/k and [s] b/k
  std::vector<float> arm;                   // [1] k1/k of those with an arm
  double most_mass = 0.0;                   // [s2] largest m/k: of the slowest vertex
  bool empty() const { return linear.empty() && solid.empty() && mass.empty(); }
};

// Lower bound of the painted stiffness factor: a surface without stiffness would never recover.
inline constexpr double kLeastStiffness = 0.01;  // [1] factor

// The motion with painted factors of stiffness, damping and the arm's stiffness, per unit of the local stiffness.
Motion paint(const Motion& motion, double stiffness, double damping, double relaxation);

// One step of the free surface at such a place, without the arm of the standard linear solid.
HeightState step_free(const Motion& motion, double stiffness, double damping, HeightState state);

// k1/k at a vertex. [1]
float arm_stiffness(const Motion& motion, const Mesh& mesh, std::uint32_t vertex);

// Empty if neither stiffness nor damping nor relaxation is painted.
PaintedMotion paint_motion(const Motion& motion, const Mesh& mesh);

}  // namespace pliant
