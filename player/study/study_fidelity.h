// The same indentation by every model that the engine has: a flat punch of 4 mm, pressed into a block of tissue that is
// bonded below. P1 and tissue run in levels, as a user has them; the truth is a block of tetrahedra that is fine under
// the punch (block_press.h).
#pragma once

#include <utility>
#include <vector>

#include "player/study/study_shapes.h"
#include "pliant/parameters.h"
#include "runtime/result.h"

namespace pliant {

// What is pressed, in all models. The depths are a share of the radius.
struct Indented {
  double young = 10e3, poisson = 0.45;               // [Pa] [1]
  double radius = 0.004;                             // [m] of the punch: a point's, as `young` is calibrated for
  double thickness = 0.02;                           // [m]
  double half_width = 0.024;                         // [m]
  std::vector<double> depths{0.0005, 0.001, 0.002};  // [m] ascending

  BlockPress block(int cells) const;
};

struct Indentation {
  std::vector<double> force;                       // [N] at each depth, held still
  std::vector<std::pair<double, double>> surface;  // at the deepest: [m] from the middle, [1] share of the depth
  double us = 0.0;                                 // processor time a tick of 1 ms, all threads
};

// A P1 surface under a probe, in a session.
Result<Indentation> press_surface(const Indented& what, const DeformableParameters& parameters);
// A soft body of lattice cell [m] under a rigid punch that a device leads, in a session.
struct PressWish {
  double cell = 0.004;    // [m]
  double seconds = 0.25;  // [s] that each depth takes, half of it held still
  std::size_t tets = 0;   // written: of the lattice
};
Result<Indentation> press_tissue(const Indented& what, PressWish& press);
// Blocks of ascending depth, solved anew in every soft step of 1/60 s: force and cost.
Indentation as_indentation(const std::vector<PressedBlock>& blocks);

// [1] RMS of the difference over the RMS of the truth: of the force over the depths, of the surface within five radii.
double force_error(const Indentation& model, const Indentation& truth);
double surface_error(const Indentation& model, const PressTruth& truth);

// The law's parameters with the least force error; its damping and times stay as they are.
DeformableParameters fitted_law(DeformableParameters law, const Indented& what, const Indentation& truth);

}  // namespace pliant
