#include "systems/soft/linear/registered_solver.h"

namespace pliant {
namespace {

BlockRows rows_of(const BlockMatrix& a) {
  static_assert(sizeof(Block) == 9 * sizeof(double));
  return {a.size, a.first, a.column, {a.value.empty() ? nullptr : a.value.front().data(), 9 * a.value.size()}};
}

class RegisteredSolver final : public LinearSolver {
 public:
  explicit RegisteredSolver(std::unique_ptr<BlackBoxSolver> box) : box_(std::move(box)) {}

  std::string_view name() const override { return "registered"; }
  void analyse(const BlockMatrix& a) override { box_->analyse(rows_of(a)); }
  bool factorise(const BlockMatrix& a) override { return box_->factorise(rows_of(a)); }
  void solve(const Vector& b, Vector& x) const override {
    box_->solve({b.data(), static_cast<std::size_t>(b.size())}, {x.data(), static_cast<std::size_t>(x.size())});
  }
  void solve_many(Eigen::Ref<Rows> columns) const override {
    Vector x;
    for (Eigen::Index c = 0; c < columns.cols(); ++c) {
      const Vector b = columns.col(c);
      x.setZero(b.size());
      solve(b, x);
      columns.col(c) = x;
    }
  }

 private:
  std::unique_ptr<BlackBoxSolver> box_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_registered(const SolverFactory& factory) {
  std::unique_ptr<BlackBoxSolver> box = factory();
  return box ? std::make_unique<RegisteredSolver>(std::move(box)) : nullptr;
}

}  // namespace pliant
