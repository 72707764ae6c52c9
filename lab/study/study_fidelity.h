// The same indentation by every model that the engine has: a flat punch of 4 mm, pressed into a block of tissue that is
// bonded below. P1 and tissue run in levels, as a user has them; the truth is a block of tetrahedra that is fine under
// the punch (block_press.h).
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "lab/study/study_shapes.h"
#include "pliant/parameters.h"
#include "runtime/result.h"

namespace pliant {

// What is pressed, in all models. Laws are fitted at other depths than they are judged at, the shape's reach at the
// second of those and judged at the deepest of these.
struct Indented {
  double young = 10e3, poisson = 0.45;                   // [Pa] [1]
  double radius = 0.004;                                 // [m] of the punch: a point's, as `young` is calibrated for
  double thickness = 0.02;                               // [m]
  double half_width = 0.025;                             // [m]
  std::vector<double> depths{0.00075, 0.0015};           // [m] ascending: judged
  std::vector<double> fit_depths{0.0005, 0.001, 0.002};  // [m] ascending

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
  double cell = 0.004;                                  // [m]
  double seconds = 0.25;                                // [s] that each depth takes, half of it held still
  std::size_t tets = 0;                                 // written: of the lattice
  std::function<bool()> goes_on = [] { return true; };  // asked in every tick; no: the press ends with an error
  bool focus = false;                                   // cells are that large under the punch, and grow away from it
};
Result<Indentation> press_tissue(const Indented& what, PressWish& press);
// A block's row of presses at these depths [m], solved anew in every soft step of 1/60 s: force and cost.
Indentation as_indentation(const std::vector<PressedBlock>& blocks, const std::vector<double>& depths);

// [1] RMS of the difference over the RMS of the truth: of the force over the depths, of the surface within five radii.
double force_error(const Indentation& model, const Indentation& truth);
double surface_error(const Indentation& model, const PressTruth& truth);

// The law's parameters with the least squares of force [N] at these depths [m]; its damping and times stay as they are.
DeformableParameters fitted_law(DeformableParameters law, const std::vector<double>& depths,
                                const std::vector<double>& force);

}  // namespace pliant
