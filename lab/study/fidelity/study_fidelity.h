// The same indentation with every model of the engine: a flat punch of 4 mm radius, pressed into a block of tissue
// bonded at its bottom. P1 and tissue run in levels; the reference is a tetrahedral block refined under the punch
// (block_press.h).
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "lab/study/shapes/study_shapes.h"
#include "pliant/parameters.h"
#include "runtime/result.h"

namespace pliant {

// The indentation, for all models. Laws are fitted at `fit_depths` and judged at `depths`. The shape's reach is fitted
// at the second fit depth and judged at the deepest judged depth.
struct Indented {
  double young = 10e3, poisson = 0.45;                   // [Pa] [1]
  double radius = 0.004;                                 // [m] of the punch, for which `young` is calibrated
  double thickness = 0.02;                               // [m]
  double half_width = 0.025;                             // [m]
  std::vector<double> depths{0.00075, 0.0015};           // [m] ascending, for judging
  std::vector<double> fit_depths{0.0005, 0.001, 0.002};  // [m] ascending, for fitting

  BlockPress block(int cells) const;
};

struct Indentation {
  std::vector<double> force;                       // [N] at each depth, at rest
  std::vector<std::pair<double, double>> surface;  // at the deepest: [m] from the centre, [1] share of the depth
  double us = 0.0;                                 // CPU time per tick of 1 ms, all threads
};

// A P1 surface under a probe, in a session.
Result<Indentation> press_surface(const Indented& what, const DeformableParameters& parameters);
// A soft body with lattice cells [m] under a rigid punch with a prescribed device, in a session.
struct PressRun {
  double cell = 0.004;                                  // [m]
  double seconds = 0.25;                                // [s] per depth, half of it at rest
  std::size_t tets = 0;                                 // output: of the lattice
  std::function<bool()> goes_on = [] { return true; };  // called in every tick; false ends the press with an error
  bool focus = false;                                   // cell size under the punch; larger away from it
  SoftContact contact = SoftContact::kLattice;
};
Result<Indentation> press_tissue(const Indented& what, PressRun& press);
// A sequence of block presses at these depths [m], solved anew in every soft step of 1/60 s: force and cost.
Indentation as_indentation(const std::vector<PressedBlock>& blocks, const std::vector<double>& depths);

// [1] RMS difference over the RMS of the truth: of the force over the depths, of the surface within five radii.
double force_error(const Indentation& model, const Indentation& truth);
double surface_error(const Indentation& model, const PressTruth& truth);

// [N] A law's force at the depth d [m].
double law_force(const DeformableParameters& law, double d);

// The law's parameters by least squares of the force [N] at these depths [m]; damping and times are kept.
DeformableParameters fitted_law(DeformableParameters law, const std::vector<double>& depths,
                                const std::vector<double>& force);

}  // namespace pliant
