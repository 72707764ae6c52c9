// Least squares within a box: min sum r_i(p)^2 over low <= p <= high. Levenberg-Marquardt (Marquardt 1963; damping as
// Nielsen 1999), with the parameters that stand on a bound and want beyond it taken out of each step, and the rest
// projected onto the box. Eigen's own is in its `unsupported` part and knows no box.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace pliant {

struct FitParameter {
  double start = 1.0, low = 0.0, high = 1.0;
  double scale = 1.0;  // a usual size: steps and differences are measured in it
};

struct LeastSquares {
  Eigen::VectorXd p;
  double sum = 0.0;            // of squares, at p
  Eigen::MatrixXd covariance;  // of p, from the Jacobian there; rows of parameters on a bound are zero
  std::vector<bool> on_bound;
  bool converged = false;
  bool singular = false;  // the data do not tell the parameters apart: the covariance is not to be used
  int iterations = 0;
};

// `residuals` fills r, which has `count` rows. The same bits every time.
using Residuals = std::function<void(const Eigen::VectorXd& p, Eigen::VectorXd& r)>;
LeastSquares least_squares(const std::vector<FitParameter>& parameters, Eigen::Index count, const Residuals& residuals);

// The t of Student's distribution that a share [1] of it lies within (-t, t) of.
double student_t(double share, double degrees);

}  // namespace pliant
