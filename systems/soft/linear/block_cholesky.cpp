#include "systems/soft/linear/block_cholesky.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

int strips_of(std::size_t rows) {
  return static_cast<int>((rows + kStrip - 1) / kStrip);
}
std::size_t triangle_strips(int strips) {
  return static_cast<std::size_t>(triangle_size(strips)) / kStrip;
}

}  // namespace

void BlockCholesky::analyse(const BlockMatrix& a) {
  Elimination e = plan_elimination(a);
  fronts_.assign(e.supernodes.size(), {});
  std::size_t factor = 0, top = 0, highest = 0;
  flops_ = 0;
  int most_rows = 0, most_columns = 0;
  std::vector<std::size_t> waiting;  // strips of updates on the stack, as in factorise()
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) {
    const Supernode& node = e.supernodes[s];
    Front& f = fronts_[s];
    f.first = 3 * node.first;
    f.columns = static_cast<int>(3 * node.count);
    f.strips = strips_of(3 * (node.count + node.below.size()));
    f.panel = factor;
    f.parent = node.parent;
    for (const std::uint32_t row : node.below)
      for (std::uint32_t i = 0; i < 3; ++i) f.below.push_back(3 * row + i);
    factor += static_cast<std::size_t>(f.columns) * static_cast<std::size_t>(f.strips);
    for (int c = 0; c < f.columns; ++c) flops_ += std::pow(f.columns + static_cast<double>(f.below.size()) - c, 2);
    most_rows = std::max(most_rows, f.strips * kStrip);
    most_columns = std::max(most_columns, f.columns);
    if (f.parent != kNone) {
      ++fronts_[f.parent].children;
      const Supernode& up = e.supernodes[f.parent];
      for (const std::uint32_t row : f.below) {
        const std::uint32_t block = row / 3, end = up.first + up.count;
        const auto under = std::lower_bound(up.below.begin(), up.below.end(), block) - up.below.begin();
        const auto at = block < end ? block - up.first : up.count + static_cast<std::uint32_t>(under);
        f.in_parent.push_back(static_cast<int>(3 * at + row % 3));
      }
    }
    highest = std::max(highest, top + triangle_strips(f.rest()));
    for (std::uint32_t c = 0; c < f.children; ++c) {
      top -= waiting.back();
      waiting.pop_back();
    }
    waiting.push_back(triangle_strips(f.rest()));
    top += waiting.back();
  }
  factor_strips_ = factor, stack_strips_ = highest + 1;
  factor_.clear(), stack_.clear();
  reciprocal_.resize(3 * a.size);
  const auto rows = static_cast<std::size_t>(most_rows);
  row_from_.resize(rows), row_panel_.resize(rows), row_triangle_.resize(rows);
  x_.resize(3 * a.size + 1), local_.resize(rows + 1), sums_.resize(static_cast<std::size_t>(most_columns) + 1);
  place_sources(a, e);
  front_of_.clear();
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) front_of_.insert(front_of_.end(), e.supernodes[s].count, s);
  old_of_new_ = std::move(e.old_of_new), new_of_old_ = std::move(e.new_of_old);
}

void BlockCholesky::place_sources(const BlockMatrix& a, const Elimination& e) {
  sources_.clear();
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) {
    const Supernode& node = e.supernodes[s];
    fronts_[s].sources_begin = static_cast<std::uint32_t>(sources_.size());
    for (std::uint32_t c = node.first; c < node.first + node.count; ++c) {
      const std::uint32_t old = e.old_of_new[c];
      for (std::uint32_t k = a.first[old]; k < a.first[old + 1]; ++k) {
        const std::uint32_t row = e.new_of_old[a.column[k]];
        if (row < c) continue;
        const auto under = std::lower_bound(node.below.begin(), node.below.end(), row) - node.below.begin();
        const auto at =
            row < node.first + node.count ? row - node.first : node.count + static_cast<std::uint32_t>(under);
        sources_.push_back({k, 3 * at, 3 * (c - node.first)});
      }
    }
    fronts_[s].sources_end = static_cast<std::uint32_t>(sources_.size());
  }
}

// A is symmetric: block (row, column) is the transpose of the block found in A's row `column`.
void BlockCholesky::assemble(const Front& f, const BlockMatrix& a, double* panel) const {
  for (std::uint32_t i = f.sources_begin; i < f.sources_end; ++i) {
    const Source& source = sources_[i];
    const Block& value = a.value[source.value];
    for (std::uint32_t r = 0; r < 3; ++r) {
      const std::uint32_t row = source.row + r;
      double* const out =
          panel + (row / kStrip * static_cast<std::uint32_t>(f.columns) + source.column) * kStrip + row % kStrip;
      for (std::uint32_t c = 0; c < 3; ++c) out[c * kStrip] = value(c, r);
    }
  }
}

// Adds a child's update to its parent's panel and triangle, column by column.
void BlockCholesky::add_update(const Front& child, const double* update, const Front& parent, double* panel,
                               double* triangle) {
  const int above = child.columns / kStrip, parent_above = parent.columns / kStrip;
  const int rows = static_cast<int>(child.below.size());
  for (int i = 0; i < rows; ++i) {
    const int r = child.columns + i, to = child.in_parent[static_cast<std::size_t>(i)];
    const auto at = static_cast<std::size_t>(i);
    row_from_[at] = static_cast<std::size_t>(triangle_size(r / kStrip - above) + r % kStrip);
    row_panel_[at] = static_cast<std::size_t>(to / kStrip * kStrip * parent.columns + to % kStrip);
    row_triangle_[at] =
        static_cast<std::size_t>(to < parent.columns ? 0 : triangle_size(to / kStrip - parent_above) + to % kStrip);
  }
  for (int i = 0; i < rows; ++i) {
    const double* const from = update + (child.columns + i - above * kStrip) * kStrip;
    const int to = child.in_parent[static_cast<std::size_t>(i)];
    const bool in_panel = to < parent.columns;
    double* const out = in_panel ? panel + to * kStrip : triangle + (to - parent_above * kStrip) * kStrip;
    const std::size_t* const row_to = in_panel ? row_panel_.data() : row_triangle_.data();
    for (int j = i; j < rows; ++j) out[row_to[j]] += from[row_from_[static_cast<std::size_t>(j)]];
  }
}

bool BlockCholesky::factorise(const BlockMatrix& a) {
  factor_.resize(factor_strips_), stack_.resize(stack_strips_);
  std::vector<std::uint32_t> waiting;
  Strip* top = stack_.data();
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) {
    const Front& f = fronts_[s];
    double* const own = factor_[f.panel].lane;
    std::fill_n(own, f.columns * f.strips * kStrip, 0.0);
    assemble(f, a, own);
    double* const triangle = top->lane;
    const std::size_t size = triangle_strips(f.rest());
    std::fill_n(triangle, size * kStrip, 0.0);
    Strip* below = top;
    for (std::uint32_t c = 0; c < f.children; ++c) {
      const Front& child = fronts_[waiting.back()];
      waiting.pop_back();
      below -= triangle_strips(child.rest());
      add_update(child, below->lane, f, own, triangle);
    }
    if (!factorise_panel(own, panel(f), reciprocal_.data() + f.first)) return false;
    update_triangle(panel(f), triangle);
    std::copy(top, top + size, below);
    top = below + size;
    waiting.push_back(s);
  }
  return true;
}

void BlockCholesky::solve(const Vector& b, Vector& x) const {
  double* const w = x_.front().lane;
  double* const local = local_.front().lane;
  for (std::uint32_t i = 0; i < old_of_new_.size(); ++i)
    for (std::uint32_t d = 0; d < 3; ++d) w[3 * i + d] = b[3 * old_of_new_[i] + d];
  for (const Front& f : fronts_) {
    std::copy_n(w + f.first, f.columns, local);
    std::fill(local + f.columns, local + f.strips * kStrip, 0.0);
    forward(panel(f), reciprocal_.data() + f.first, local);
    std::copy_n(local, f.columns, w + f.first);
    for (std::size_t i = 0; i < f.below.size(); ++i) w[f.below[i]] += local[f.columns + static_cast<int>(i)];
  }
  for (std::size_t s = fronts_.size(); s-- > 0;) {
    const Front& f = fronts_[s];
    std::copy_n(w + f.first, f.columns, local);
    std::fill(local + f.columns, local + f.strips * kStrip, 0.0);
    for (std::size_t i = 0; i < f.below.size(); ++i) local[f.columns + static_cast<int>(i)] = w[f.below[i]];
    backward(panel(f), reciprocal_.data() + f.first, local, sums_.front().lane);
    std::copy_n(local, f.columns, w + f.first);
  }
  x.resize(b.size());
  for (std::uint32_t i = 0; i < old_of_new_.size(); ++i)
    for (std::uint32_t d = 0; d < 3; ++d) x[3 * old_of_new_[i] + d] = w[3 * i + d];
}

// Eight columns at a time. Subtrees without non-zero right-hand sides are skipped in the forward substitution.
void BlockCholesky::solve_many(Eigen::Ref<Rows> columns) const {
  if (columns.cols() == 1) {
    Vector x;
    solve(columns.col(0), x);
    columns.col(0) = x;
    return;
  }
  for (Eigen::Index from = 0; from < columns.cols(); from += kStrip) {
    auto some = columns.middleCols(from, std::min<Eigen::Index>(kStrip, columns.cols() - from));
    take_columns(some);
    for (std::uint32_t s = 0; s < fronts_.size(); ++s) {
      const Front& f = fronts_[s];
      if (!touched_[s]) continue;
      if (f.parent != kNone) touched_[f.parent] = 1;
      forward_pack(f, x_.data());
    }
    for (std::size_t s = fronts_.size(); s-- > 0;) {
      const Front& f = fronts_[s];
      std::copy_n(&x_[f.first], f.columns, local_.data());
      for (std::size_t i = 0; i < f.below.size(); ++i) local_[static_cast<std::size_t>(f.columns) + i] = x_[f.below[i]];
      std::fill(local_.data() + f.columns + f.below.size(), local_.data() + f.strips * kStrip, Strip{});
      backward_many(panel(f), reciprocal_.data() + f.first, local_.front().lane);
      std::copy_n(local_.data(), f.columns, &x_[f.first]);
    }
    give_columns(some);
  }
}

// One front's forward substitution for a pack of eight right-hand sides: its rows of x, and its update of the rows
// below.
void BlockCholesky::forward_pack(const Front& f, Strip* x) const {
  std::copy_n(x + f.first, f.columns, local_.data());
  std::fill(local_.data() + f.columns, local_.data() + f.strips * kStrip, Strip{});
  forward_many(panel(f), reciprocal_.data() + f.first, local_.front().lane);
  std::copy_n(local_.data(), f.columns, x + f.first);
  for (std::size_t i = 0; i < f.below.size(); ++i)
    for (int l = 0; l < kStrip; ++l) x[f.below[i]].lane[l] += local_[static_cast<std::size_t>(f.columns) + i].lane[l];
}

// B^T A^-1 B = Y^T Y with Y = L^-1 B. It needs no backward substitution, and Y is non-zero only on the paths from B's
// rows to the roots of the elimination tree. Triples are sorted by the elimination order of their first rows, so that
// few packs of eight columns share a front far from the roots.
void BlockCholesky::solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const {
  const std::vector<Eigen::Index> place = place_columns(b);
  const auto packs = static_cast<std::size_t>((3 * b.count() + kStrip - 1) / kStrip);
  const std::size_t rows = 3 * old_of_new_.size();
  packs_.assign(packs * rows, Strip{});
  tiles_.assign(packs * (packs + 1) / 2 * kStrip, Strip{});
  touched_.assign(fronts_.size() * packs, 0);
  for (Eigen::Index three = 0; three < b.count(); ++three)
    for (const BlockColumns::Entry& entry : b.of(three)) {
      const std::uint32_t row = new_of_old_[entry.row];
      for (int c = 0; c < 3; ++c) {
        const auto column = static_cast<std::size_t>(place[static_cast<std::size_t>(three)] + c);
        Strip* const x = &packs_[column / kStrip * rows + 3 * row];
        for (int r = 0; r < 3; ++r) x[r].lane[column % kStrip] += entry.value(r, c);
        touched_[front_of_[row] * packs + column / kStrip] = 1;
      }
    }

  std::vector<std::size_t> here;  // packs with non-zeros in this front
  for (std::size_t s = 0; s < fronts_.size(); ++s) {
    const Front& f = fronts_[s];
    here.clear();
    for (std::size_t p = 0; p < packs; ++p) {
      if (!touched_[s * packs + p]) continue;
      here.push_back(p);
      if (f.parent != kNone) touched_[f.parent * packs + p] = 1;
      forward_pack(f, &packs_[p * rows]);
    }
    for (const std::size_t p : here)
      for (const std::size_t q : here) {
        if (q > p) break;
        add_gram(packs_[p * rows + f.first].lane, kStrip, packs_[q * rows + f.first].lane, kStrip, f.columns,
                 tiles_[(p * (p + 1) / 2 + q) * kStrip].lane);
      }
  }

  gram.resize(3 * b.count(), 3 * b.count());
  const auto of = [&](Eigen::Index i) {
    return static_cast<std::size_t>(place[static_cast<std::size_t>(i / 3)] + i % 3);
  };
  for (Eigen::Index i = 0; i < gram.rows(); ++i)
    for (Eigen::Index j = 0; j < gram.cols(); ++j) {
      const std::size_t row = std::max(of(i), of(j)), column = std::min(of(i), of(j)), p = row / kStrip;
      gram(i, j) = tiles_[(p * (p + 1) / 2 + column / kStrip) * kStrip + column % kStrip].lane[row % kStrip];
    }
}

// Column index of each triple.
std::vector<Eigen::Index> BlockCholesky::place_columns(const BlockColumns& b) const {
  std::vector<std::pair<std::uint32_t, Eigen::Index>> order;  // first row, three
  for (Eigen::Index three = 0; three < b.count(); ++three) {
    std::uint32_t first = kNone;
    for (const BlockColumns::Entry& entry : b.of(three)) first = std::min(first, new_of_old_[entry.row]);
    order.emplace_back(first, three);
  }
  std::sort(order.begin(), order.end());
  std::vector<Eigen::Index> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    place[static_cast<std::size_t>(order[k].second)] = 3 * static_cast<Eigen::Index>(k);
  return place;
}

// x_ = up to eight columns in the factor's order; touched_: fronts in which one of them is non-zero.
void BlockCholesky::take_columns(Eigen::Ref<const Rows> some) const {
  touched_.resize(fronts_.size());
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) {
    const Front& f = fronts_[s];
    touched_[s] = 0;
    for (std::uint32_t r = f.first; r < f.first + static_cast<std::uint32_t>(f.columns); ++r) {
      const double* const from = some.data() + some.outerStride() * (3 * old_of_new_[r / 3] + r % 3);
      double* const to = x_[r].lane;
      if (some.cols() == kStrip) {
        std::copy_n(from, kStrip, to);
      } else {
        std::copy_n(from, some.cols(), to);
        std::fill(to + some.cols(), to + kStrip, 0.0);
      }
      for (int l = 0; l < kStrip; ++l) touched_[s] |= static_cast<char>(to[l] != 0);
    }
  }
}

void BlockCholesky::give_columns(Eigen::Ref<Rows> some) const {
  for (std::uint32_t i = 0; i < old_of_new_.size(); ++i)
    for (std::uint32_t d = 0; d < 3; ++d) {
      double* const to = some.data() + some.outerStride() * (3 * old_of_new_[i] + d);
      if (some.cols() == kStrip)
        std::copy_n(x_[3 * i + d].lane, kStrip, to);
      else
        std::copy_n(x_[3 * i + d].lane, some.cols(), to);
    }
}

std::unique_ptr<LinearSolver> make_block_cholesky(std::uint32_t) {
  return std::make_unique<BlockCholesky>();
}

}  // namespace pliant
