// Sparse Cholesky factor A = L L^T of 3x3 blocks by the multifrontal method (Duff and Reid 1983; Liu 1992). Each
// supernode of the elimination tree assembles its columns of A and its children's updates, factorises its dense panel
// and leaves an update for its parent. All arithmetic is dense (panel_kernels.h). Chosen over the left-looking method
// for its simpler memory traffic. The pattern fixes the order of operations, so results repeat to the bit. One thread
// at a time: solving uses scratch memory of the solver.
#pragma once

#include <vector>

#include "systems/soft/linear/elimination.h"
#include "systems/soft/linear/linear_solver.h"
#include "systems/soft/linear/panel_kernels.h"

namespace pliant {

class BlockCholesky final : public LinearSolver {
 public:
  std::string_view name() const override { return "block-cholesky"; }
  void analyse(const BlockMatrix& a) override;
  bool factorise(const BlockMatrix& a) override;
  void solve(const Vector& b, Vector& x) const override;
  void solve_many(Eigen::Ref<Rows> columns) const override;
  void solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const override;

  double flops() const { return flops_; }  // additions and multiplications of a factorise()

 private:
  struct alignas(64) Strip {
    double lane[kStrip];
  };
  // A block of A on or below the diagonal, and its place in its panel.
  struct Source {
    std::uint32_t value, row, column;
  };
  struct Front {
    std::uint32_t first = 0;      // its first column
    int columns = 0, strips = 0;  // of the panel; in scalars, not blocks
    std::size_t panel = 0;        // index in factor_
    std::uint32_t sources_begin = 0, sources_end = 0;
    std::vector<std::uint32_t> below;  // rows under the diagonal block, three a block row
    std::vector<int> in_parent;        // index of those rows in the parent's front
    std::uint32_t parent = 0xffffffff;
    std::uint32_t children = 0;
    int rest() const { return strips - columns / kStrip; }  // strips of the update
  };

  FactorPanel panel(const Front& f) const { return {factor_[f.panel].lane, f.columns, f.strips}; }
  void place_sources(const BlockMatrix& a, const Elimination& e);
  void assemble(const Front& f, const BlockMatrix& a, double* panel) const;
  void add_update(const Front& child, const double* update, const Front& parent, double* panel, double* triangle);
  void forward_pack(const Front& f, Strip* x) const;
  std::vector<Eigen::Index> place_columns(const BlockColumns& b) const;
  void take_columns(Eigen::Ref<const Rows> some) const;
  void give_columns(Eigen::Ref<Rows> some) const;

  std::vector<std::uint32_t> old_of_new_;
  std::vector<std::uint32_t> new_of_old_, front_of_;  // of block rows; front_of_ by their new number
  std::vector<Front> fronts_;
  std::vector<Source> sources_;
  std::size_t factor_strips_ = 0, stack_strips_ = 0;
  double flops_ = 0;
  std::vector<Strip> factor_;       // allocated by the first factorise()
  std::vector<double> reciprocal_;  // of L's diagonal
  std::vector<Strip> stack_;        // updates waiting for their parents
  std::vector<std::size_t> row_from_, row_panel_, row_triangle_;
  mutable std::vector<Strip> x_, local_, sums_, packs_, tiles_;
  mutable std::vector<char> touched_;
};

}  // namespace pliant
