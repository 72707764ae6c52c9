// The laws of a surface (methods.md 1.2, 1.8) as functions of an indenter's path, with the keys of PLIANT_deformable as
// their parameters: the engine's own contact law, fed with a record's depths.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/deformable.h"
#include "lab/fit/least_squares.h"
#include "lab/fit/press_record.h"

namespace pliant {

struct ModelParameter {
  std::string key, unit;  // of PLIANT_deformable; `contact`: the depth at which the indenter met the surface
  FitParameter box;       // with the start of the first try
};

struct ModelWish {
  double radius = 0.0;    // [m] of a spherical indenter; 0: a point or punch
  double poisson = 0.45;  // [1] with `hertz`
  bool damping = false;   // contact_damping is one of the parameters
  bool contact = false;   // the depth at which it met the surface is one
};

struct PressModel {
  std::string law;  // linear, cubic, exponential, sls, hertz
  ModelWish wish;
  std::vector<ModelParameter> parameters;
  std::vector<Eigen::VectorXd> starts;  // where a fit begins: some laws have more than one valley

  // The surface's keys at these parameters.
  Deformable deformable(const Eigen::VectorXd& p) const;
  // [N] at each row of the record.
  void predict(const PressRecord& record, const Eigen::VectorXd& p, std::vector<double>& force) const;
};

// Words of laws; `hertz` takes a radius, `sls` and damping a time.
const std::vector<std::string>& press_laws();
// Nothing: the record or the wish lacks what the law needs; `why` says what.
std::optional<PressModel> press_model(const std::string& law, const PressRecord& record, const ModelWish& wish,
                                      std::string& why);

}  // namespace pliant
