// A law fitted to what an indenter measured: parameters with confidence intervals, and the error on rows that the fit
// has not seen.
#pragma once

#include <string>
#include <vector>

#include "lab/fit/press_model.h"

namespace pliant {

struct RecordWish {
  std::string law = "auto";  // auto: the one with the least error on the rows held out
  ModelWish model;
  double hold_out = 0.25;    // [1] share of the rows, in stretches; 0: none
  double confidence = 0.95;  // [1] of the intervals
};

struct FittedParameter {
  std::string key, unit;
  double value = 0.0;
  double low = 0.0, high = 0.0;  // of the interval, within the key's range; both the value where there is none
  bool on_bound = false;
};

struct LawFit {
  PressModel model;
  Eigen::VectorXd p;
  std::vector<FittedParameter> parameters;
  std::vector<double> force;             // [N] of the model, at each row
  double rms = 0.0, held_rms = 0.0;      // [N] on rows fitted, and on rows held out
  double share = 0.0, held_share = 0.0;  // [1] of the RMS force there
  double correlation = 0.0;  // [1] of a residual with the one before it; far from 0: the law is not the tissue's
  bool converged = false, singular = false;
};

struct RecordFit {
  std::vector<LawFit> laws;  // each that was tried
  std::size_t best = 0;
  std::vector<bool> held;  // of each row
  std::size_t fitted = 0;  // rows
  std::vector<std::string> notes;
};

// Whether a row is held out: so many as the share says, but one at least, in stretches that lie evenly apart.
std::vector<bool> held_rows(std::size_t rows, double share);

Result<RecordFit> fit_record(const PressRecord& record, const RecordWish& wish);

}  // namespace pliant
