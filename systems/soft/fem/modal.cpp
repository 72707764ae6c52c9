#include "systems/soft/fem/modal.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "systems/soft/linear/symmetric_product.h"

namespace pliant {

PivotedFactor factor_pivoted(const Eigen::MatrixXd& gram, int most, double share) {
  const Eigen::Index rows = gram.rows();
  PivotedFactor out;
  out.lower.setZero(rows, std::min<Eigen::Index>(most, rows));
  Vector left = gram.diagonal();
  const double enough = share * (rows ? left.maxCoeff() : 0.0);
  while (static_cast<Eigen::Index>(out.picks.size()) < out.lower.cols()) {
    Eigen::Index pick = 0;
    if (!(left.maxCoeff(&pick) > enough)) break;
    const auto done = static_cast<Eigen::Index>(out.picks.size());
    auto column = out.lower.col(done);
    column = gram.col(pick);
    column.noalias() -= out.lower.leftCols(done) * out.lower.row(pick).head(done).transpose();
    column /= std::sqrt(left[pick]);
    for (const int earlier : out.picks) column[earlier] = 0.0;
    left -= column.cwiseAbs2();
    left[pick] = 0.0;
    out.picks.push_back(static_cast<int>(pick));
  }
  out.lower.conservativeResize(rows, static_cast<Eigen::Index>(out.picks.size()));
  return out;
}

Modes find_modes(const PivotedFactor& factor, const Eigen::MatrixXd& mass, const StepSplit& split, int most,
                 double highest) {
  const auto size = static_cast<Eigen::Index>(factor.picks.size());
  Modes out;
  if (size == 0) {
    out.at_contacts.setZero(factor.lower.rows(), 0);
    return out;
  }
  Eigen::MatrixXd square(size, size);  // L(picks, :), lower triangular
  for (Eigen::Index i = 0; i < size; ++i) square.row(i) = factor.lower.row(factor.picks[static_cast<std::size_t>(i)]);
  const auto triangle = square.triangularView<Eigen::Lower>();
  Eigen::MatrixXd inertia = triangle.solve(mass);
  inertia = triangle.solve(inertia.transpose().eval());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inertia);

  // Largest mass, that is slowest, first; m above 1 / inertia() is rounding.
  Eigen::Index kept = 0;
  out.frequency2.resize(size);
  out.step_share.resize(size);
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(size, most); ++k) {
    const double m = std::min(eigen.eigenvalues()[size - 1 - k], 1.0 / split.inertia());
    if (!(m > 0.0)) break;
    const double frequency2 = std::max(0.0, (1.0 / m - split.inertia()) / split.elastic());
    if (frequency2 > highest * highest) break;
    out.frequency2[kept] = frequency2;
    out.step_share[kept++] = m;
  }
  out.frequency2.conservativeResize(kept);
  out.step_share.conservativeResize(kept);
  const Eigen::MatrixXd shapes =
      eigen.eigenvectors().rowwise().reverse().leftCols(kept) * out.step_share.cwiseSqrt().cwiseInverse().asDiagonal();
  out.transform = square.transpose().triangularView<Eigen::Upper>().solve(shapes);
  out.at_contacts = factor.lower * shapes;
  return out;
}

Eigen::MatrixXd left_flexibility(const Eigen::MatrixXd& gram, const Modes& modes, const StepSplit& split) {
  const Rows share = (modes.at_contacts * modes.step_share.cwiseSqrt().asDiagonal()).transpose();
  return split.elastic() * (gram - symmetric_product(share, share));
}

}  // namespace pliant
