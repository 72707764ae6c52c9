// Sparse Cholesky factor A = L L^T of 3x3 blocks by the multifrontal method (Duff and Reid 1983; Liu 1992). Each
// supernode of the elimination tree assembles its columns of A and its children's updates, factorises its dense panel
// and leaves an update for its parent. All arithmetic is dense (panel_kernels.h). Chosen over the left-looking method
// for its simpler memory traffic.
// Threads: disjoint subtrees of similar work are tasks; above them, one front after the other is shared strip by strip,
// or right-hand sides pack by pack. The pattern fixes tasks and the order of every sum, so results are the same to the
// bit for any number of threads. One caller at a time: solving uses scratch memory of the solver.
#pragma once

#include <array>
#include <vector>

#include "runtime/tasks.h"
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
  bool solve_kept(const ColumnMix& mix, Eigen::Ref<Rows> out) const override;

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
    std::size_t update = 0;       // index in stack_; of top fronts and subtrees' roots
    std::uint32_t sources_begin = 0, sources_end = 0;
    std::vector<std::uint32_t> below;    // rows under the diagonal block, three a block row
    std::vector<int> in_parent;          // index of those rows in the parent's front
    std::size_t inside = 0;              // of those rows: in its subtree; all of a top front
    std::vector<std::uint32_t> in_root;  // index of the others among the rows below the subtree's root
    std::uint32_t parent = 0xffffffff;
    std::uint32_t descendant = 0;                           // the first front below it, or itself
    int rest() const { return strips - columns / kStrip; }  // strips of the update
  };
  // A task: fronts first to root.
  struct Subtree {
    std::uint32_t first, root;
    std::size_t stack, above;  // its part of stack_; of sums for rows above it
  };
  struct Scratch {
    std::vector<std::size_t> from, panel, triangle;  // of an update's rows
    std::vector<Strip> local, sums;
  };

  // Right-hand sides, eight a pack, pack after pack. touched: of each front, the packs with non-zeros there.
  struct Columns {
    std::size_t packs = 0;
    std::vector<Strip> x;
    std::vector<char> touched;
  };

  FactorPanel panel(const Front& f) const { return {factor_[f.panel].lane, f.columns, f.strips}; }
  void place_fronts(const Elimination& e);
  void share_tree(const Elimination& e);
  void place_updates();
  void place_sources(const BlockMatrix& a, const Elimination& e);
  void assemble(const Front& f, const BlockMatrix& a, double* panel) const;
  template <class Use>
  void for_each_child(std::uint32_t front, Use use) const;
  void place_update(const Front& child, const Front& parent, Scratch& scratch) const;
  void add_update(const Front& child, const double* update, const Front& parent, double* panel, double* triangle,
                  const Scratch& scratch, int first, int last) const;
  bool factorise_subtree(const Subtree& tree, const BlockMatrix& a, Scratch& scratch);
  bool factorise_top(std::uint32_t front, const BlockMatrix& a);
  Scratch& scratch(unsigned thread) const;

  template <class Lane>
  void forward_front(const Front& f, Lane* x, Lane* above, Scratch& scratch) const;
  template <class Lane>
  void backward_front(const Front& f, Lane* x, Scratch& scratch) const;
  void start_packs(Columns& columns, Eigen::Index count) const;
  void solve_packs(Eigen::Ref<Rows> columns) const;
  void touch_above(Columns& columns) const;
  template <class Lane>
  void forward_all(Lane* x, const Columns& columns) const;
  template <class Lane>
  void backward_all(Lane* x, std::size_t packs) const;
  std::vector<Eigen::Index> place_columns(const BlockColumns& b) const;
  void add_grams() const;
  void take_columns(Eigen::Ref<const Rows> columns, std::size_t pack) const;
  void mix_columns(const ColumnMix& mix, std::size_t pack) const;
  void give_columns(Eigen::Ref<Rows> columns, std::size_t pack) const;

  std::vector<std::uint32_t> old_of_new_;
  std::vector<std::uint32_t> new_of_old_, front_of_;  // of block rows; front_of_ by their new number
  std::vector<Front> fronts_;
  std::vector<Subtree> subtrees_;
  std::vector<std::uint32_t> top_;  // fronts above the subtrees, ascending
  std::vector<Source> sources_;
  std::size_t rows_ = 0, most_rows_ = 0, most_columns_ = 0;
  std::size_t factor_strips_ = 0, stack_strips_ = 0, above_ = 0;
  double flops_ = 0;
  std::vector<Strip> factor_;                      // allocated by the first factorise()
  std::vector<double> reciprocal_;                 // of L's diagonal
  std::vector<Strip> stack_;                       // updates waiting for their parents
  mutable Columns now_, kept_;                     // being solved; L^-1 B of the last solve_gram
  mutable std::vector<Eigen::Index> place_;        // in kept_: column of each triple of B
  mutable std::vector<Strip> sums_above_, tiles_;  // sums of subtrees for rows above them; products
  mutable std::array<Scratch, kMostTaskThreads> scratch_;
};

}  // namespace pliant
