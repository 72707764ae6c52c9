// `pliant fit`: the keys of a deformable surface from measured presses, from an object's finite elements, or from the
// runs of a sweep (docs/fit.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pliant {

struct FitOptions {
  std::string in;                                     // a level, or measured presses (.csv, .tsv, .txt)
  std::string object;                                 // node of the level
  std::string out;                                    // level to write; empty: none
  std::string report;                                 // folder; empty: out/fit
  bool force = false;                                 // replace an existing level and report
  std::optional<double> unit;                         // [m] unit of a bare mesh; empty: not said
  std::vector<std::string> of_measured, of_elements;  // options given that apply to one kind of fit only

  // Options of a fit to measured presses.
  std::string level;  // level to write the keys into; empty: they are only printed
  std::string probe;  // probe to read from a forces.csv
  std::string law = "auto";
  double radius = 0.0;  // [m] of the indenter; 0: a point (finite elements: the level's value)
  double hold_out = 0.25, confidence = 0.95;
  bool damping = false, contact = false;

  // Options of a fit to finite elements; a value below 0 means the level's.
  double young = -1.0, poisson = -1.0, thickness = -1.0, cell = -1.0;
  bool linear = false;  // small strains
  std::string pin;      // side to pin; empty: as in the level
  double reach = 0.0;   // [m] of the surface's dents; 0: the best fit
  unsigned points = 24, held = 12;

  std::string sweep, target;  // a sweep's folder, and the presses to compare its runs with
};
int fit(const FitOptions& options);

// One function per kind of fit.
int fit_press(const FitOptions& options);
int fit_tissue(const FitOptions& options);
int fit_sweep(const FitOptions& options);

}  // namespace pliant
