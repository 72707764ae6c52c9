// Fits a law to an indenter's record: parameters with confidence intervals, and the error on held-out rows.
#pragma once

#include <string>
#include <vector>

#include "lab/fit/press_model.h"

namespace pliant {

struct RecordFitOptions {
  std::string law = "auto";  // auto: the law with the smallest error on the held-out rows
  PressModelOptions model;
  double hold_out = 0.25;    // [1] share of the rows held out, in stretches; 0: none
  double confidence = 0.95;  // [1] of the intervals
};

struct FittedParameter {
  std::string key, unit;
  double value = 0.0;
  double low = 0.0, high = 0.0;  // bounds of the interval, within the key's range; both the value if there is none
  bool on_bound = false;
};

struct LawFit {
  PressModel model;
  Eigen::VectorXd p;
  std::vector<FittedParameter> parameters;
  std::vector<double> force;             // [N] predicted by the model at each row
  double rms = 0.0, held_rms = 0.0;      // [N] on the fitted and on the held-out rows
  double share = 0.0, held_share = 0.0;  // [1] the same, over the RMS force of those rows
  double correlation = 0.0;              // [1] lag-1 autocorrelation of the residuals; far from 0: a wrong law
  bool converged = false, singular = false;
};

struct RecordFit {
  std::vector<LawFit> laws;  // every law that was tried
  std::size_t best = 0;
  std::vector<bool> held;  // per row: held out
  std::size_t fitted = 0;  // number of rows fitted
  std::vector<std::string> notes;
};

// Marks the held-out rows: the given share, at least one, in evenly spaced stretches.
std::vector<bool> held_rows(std::size_t rows, double share);

Result<RecordFit> fit_record(const PressRecord& record, const RecordFitOptions& options);

}  // namespace pliant
