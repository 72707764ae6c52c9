// `pliant fit`: a surface's keys from measured presses, from the finite elements of an object, or from a sweep's runs
// (docs/fit.md).
#pragma once

#include <string>
#include <vector>

namespace pliant {

struct FitOptions {
  std::string in;                                     // a level, or measured presses (.csv, .tsv, .txt)
  std::string object;                                 // node of the level
  std::string out;                                    // level that is written; empty: none
  std::string report;                                 // folder; empty: out/fit
  bool force = false;                                 // replaces level and report
  double unit = 1.0;                                  // [m] of a bare mesh
  std::vector<std::string> of_measured, of_elements;  // options that were said and are for one kind only

  // Of measured presses.
  std::string level;  // that the keys are written into; empty: they are only said
  std::string probe;  // of a forces.csv
  std::string law = "auto";
  double radius = 0.0;  // [m] of the indenter; 0: a point (finite elements: as the level says)
  double hold_out = 0.25, confidence = 0.95;
  bool damping = false, contact = false;

  // Of finite elements; below 0: the level's.
  double young = -1.0, poisson = -1.0, thickness = -1.0, cell = -1.0;
  bool linear = false;  // small strains
  std::string pin;      // side; empty: as the level has it
  double reach = 0.0;   // [m] of the presses; 0: what fits best
  unsigned points = 24, held = 12;

  std::string sweep, target;  // a sweep's folder, and the presses that its runs should come near to
};
int fit(const FitOptions& options);

// The three, once it is known which is meant.
int fit_press(const FitOptions& options);
int fit_tissue(const FitOptions& options);
int fit_sweep(const FitOptions& options);

}  // namespace pliant
