#include "systems/soft/linear/cholmod.h"

#include "systems/soft/linear/linear_solver.h"
#ifdef PLIANT_CHOLMOD

namespace pliant {

Cholmod::Cholmod() {
  cholmod_start(&common_);
  common_.supernodal = CHOLMOD_SUPERNODAL;
  common_.final_ll = 1;
  common_.print = 0;
}

Cholmod::~Cholmod() {
  release();
  cholmod_finish(&common_);
}

void Cholmod::release() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_free_sparse(&lower_, &common_);
}

// Columns 3c, 3c+1, 3c+2 of the lower half: blocks of row c from its diagonal on, since A is symmetric. Diagonal blocks
// are stored whole; CHOLMOD skips entries above the diagonal.
void Cholmod::analyse(const BlockMatrix& a) {
  release();
  std::size_t blocks = 0;
  for (std::uint32_t c = 0; c < a.size; ++c) blocks += a.first[c + 1] - a.diagonal[c];
  const std::size_t n = 3 * a.size;
  lower_ = cholmod_allocate_sparse(n, n, 9 * blocks, 1, 1, -1, CHOLMOD_REAL, &common_);
  int* const first = static_cast<int*>(lower_->p);
  int* row = static_cast<int*>(lower_->i);
  first[0] = 0;
  for (std::uint32_t c = 0; c < a.size; ++c)
    for (std::uint32_t j = 0; j < 3; ++j) {
      for (std::uint32_t k = a.diagonal[c]; k < a.first[c + 1]; ++k)
        for (std::uint32_t i = 0; i < 3; ++i) *row++ = static_cast<int>(3 * a.column[k] + i);
      first[3 * c + j + 1] = static_cast<int>(row - static_cast<int*>(lower_->i));
    }
  factor_ = cholmod_analyze(lower_, &common_);
}

bool Cholmod::factorise(const BlockMatrix& a) {
  double* value = static_cast<double*>(lower_->x);
  for (std::uint32_t c = 0; c < a.size; ++c)
    for (int j = 0; j < 3; ++j)
      for (std::uint32_t k = a.diagonal[c]; k < a.first[c + 1]; ++k)
        for (int i = 0; i < 3; ++i) *value++ = a.value[k](j, i);
  for (const Block& block : a.value)
    if (!block.allFinite()) return false;
  return cholmod_factorize(lower_, factor_, &common_) && common_.status == CHOLMOD_OK;
}

void Cholmod::solve(const Vector& b, Vector& x) const {
  Rows column = b;
  solve_many(column);
  x = column;
}

void Cholmod::solve_many(Eigen::Ref<Rows> columns) const {
  if (columns.size() == 0) return;
  Eigen::MatrixXd right = columns;
  cholmod_dense dense{};
  dense.nrow = dense.d = static_cast<std::size_t>(right.rows());
  dense.ncol = static_cast<std::size_t>(right.cols());
  dense.nzmax = static_cast<std::size_t>(right.size());
  dense.x = right.data();
  dense.xtype = CHOLMOD_REAL;
  cholmod_dense* solved = cholmod_solve(CHOLMOD_A, factor_, &dense, &common_);
  columns = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solved->x), right.rows(), right.cols());
  cholmod_free_dense(&solved, &common_);
}

std::unique_ptr<LinearSolver> make_cholmod(std::uint32_t) {
  return std::make_unique<Cholmod>();
}

}  // namespace pliant
#else

namespace pliant {

std::unique_ptr<LinearSolver> make_cholmod(std::uint32_t) {
  return nullptr;
}

}  // namespace pliant
#endif
