// The nearest passive matrix.
#pragma once

#include <Eigen/Eigenvalues>

#include "systems/soft/body/handle.h"

namespace pliant {

// Symmetric, eigenvalues >= 0.
inline Matrix6 passive(const Matrix6& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(0.5 * (m + m.transpose()));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace pliant
