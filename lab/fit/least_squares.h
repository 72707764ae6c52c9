// Least squares within a box: min sum r_i(p)^2 over low <= p <= high. Levenberg-Marquardt (Marquardt 1963; damping as
// in Nielsen 1999). Parameters at a bound whose step points outward are removed from the step; the rest is projected
// onto the box. Eigen's solver is in its `unsupported` part and has no bounds.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace pliant {

struct FitParameter {
  double start = 1.0, low = 0.0, high = 1.0;
  double scale = 1.0;  // typical size: unit of steps and differences
};

struct LeastSquares {
  Eigen::VectorXd p;
  double sum = 0.0;            // sum of squares at p
  Eigen::MatrixXd covariance;  // of p, from the Jacobian there; zero rows for parameters on a bound
  std::vector<bool> on_bound;
  bool converged = false;
  bool singular = false;  // the data cannot distinguish the parameters: do not use the covariance
  int iterations = 0;
};

// `residuals` fills r, which has `count` rows. Deterministic to the bit.
using Residuals = std::function<void(const Eigen::VectorXd& p, Eigen::VectorXd& r)>;
LeastSquares least_squares(const std::vector<FitParameter>& parameters, Eigen::Index count, const Residuals& residuals);

// The t for which a share [1] of Student's distribution lies within (-t, t).
double student_t(double share, double degrees);

}  // namespace pliant
