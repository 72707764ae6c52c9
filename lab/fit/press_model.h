// The laws of a surface (methods.md 1.2, 1.8) as functions of an indenter's path. Their parameters are the keys of
// PLIANT_deformable. The engine's own contact law is evaluated on the recorded depths.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/deformable.h"
#include "lab/fit/least_squares.h"
#include "lab/fit/press_record.h"

namespace pliant {

struct ModelParameter {
  std::string key, unit;  // key of PLIANT_deformable; `contact`: the depth at which the indenter met the surface
  FitParameter box;       // bounds and scale, with the first initial guess
};

struct PressModelOptions {
  double radius = 0.0;     // [m] of a spherical indenter; 0: a point or a flat punch
  double poisson = 0.45;   // [1] for the laws `hertz` and `sneddon`
  double thickness = 0.0;  // [m] of the layer for the law `hertz`; 0: deep
  bool damping = false;    // contact_damping is one of the parameters
  bool contact = false;    // the contact depth is one of the parameters
};

struct PressModel {
  std::string law;  // word of a spring law, hertz or sneddon
  PressModelOptions options;
  double deepest = 0.0;  // [m] of the last row of a table, whose rows are even
  std::vector<ModelParameter> parameters;
  std::vector<Eigen::VectorXd> starts;  // initial guesses: some laws have several local minima

  // The surface's keys for these parameters.
  Deformable deformable(const Eigen::VectorXd& p) const;
  // [N] Predicted force at each row of the record.
  void predict(const PressRecord& record, const Eigen::VectorXd& p, std::vector<double>& force) const;
};

// Names of the laws; `hertz` and `sneddon` need a radius, laws that relax and damping need time.
const std::vector<std::string>& press_laws();
// Whether the law is of a sphere on tissue of a modulus.
bool of_modulus(const std::string& law);
// Whether it is fitted on request alone: a table imitates every other law.
bool by_name_alone(const std::string& law);
// Empty if the record or the request lacks something that the law needs; `why` gives the reason.
std::optional<PressModel> press_model(const std::string& law, const PressRecord& record,
                                      const PressModelOptions& options, std::string& why);

}  // namespace pliant
