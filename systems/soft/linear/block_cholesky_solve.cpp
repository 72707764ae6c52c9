// Solutions by the factor of block_cholesky.cpp: for one right-hand side (Lane: a number) or packs of eight (Lane: a
// strip). Subtrees add their part for the rows above them to sums of their own, which are added up in their order.
#include <algorithm>
#include <type_traits>

#include "systems/soft/linear/block_cholesky.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNoFront = 0xffffffff;
constexpr std::size_t kMostPacks = 16;  // solved together
constexpr std::size_t kGramTasks = 4;   // each passes over all packs

template <class Task>
void for_each_task(bool shared, std::size_t count, const Task& task) {
  if (shared)
    run_tasks(count, task);
  else
    for (std::size_t i = 0; i < count; ++i) task(i, 0u);
}

void add_lane(double& to, double x) {
  to += x;
}
template <class Strip>
void add_lane(Strip& to, const Strip& x) {
  for (int l = 0; l < kStrip; ++l) to.lane[l] += x.lane[l];
}

}  // namespace

// One front's forward substitution: its rows of x, and its update of the rows below.
template <class Lane>
void BlockCholesky::forward_front(const Front& f, Lane* x, Lane* above, Scratch& scratch) const {
  Lane* const local = reinterpret_cast<Lane*>(scratch.local.data());
  std::copy_n(x + f.first, f.columns, local);
  std::fill(local + f.columns, local + f.strips * kStrip, Lane{});
  const double* const reciprocal = reciprocal_.data() + f.first;
  if constexpr (std::is_same_v<Lane, double>)
    forward(panel(f), reciprocal, local);
  else
    forward_many(panel(f), reciprocal, local->lane);
  std::copy_n(local, f.columns, x + f.first);
  const Lane* const update = local + f.columns;
  for (std::size_t i = 0; i < f.inside; ++i) add_lane(x[f.below[i]], update[i]);
  for (std::size_t i = f.inside; i < f.below.size(); ++i) add_lane(above[f.in_root[i - f.inside]], update[i]);
}

template <class Lane>
void BlockCholesky::backward_front(const Front& f, Lane* x, Scratch& scratch) const {
  Lane* const local = reinterpret_cast<Lane*>(scratch.local.data());
  std::copy_n(x + f.first, f.columns, local);
  for (std::size_t i = 0; i < f.below.size(); ++i) local[static_cast<std::size_t>(f.columns) + i] = x[f.below[i]];
  std::fill(local + f.columns + f.below.size(), local + f.strips * kStrip, Lane{});
  const double* const reciprocal = reciprocal_.data() + f.first;
  if constexpr (std::is_same_v<Lane, double>)
    backward(panel(f), reciprocal, local, scratch.sums.front().lane);
  else
    backward_many(panel(f), reciprocal, local->lane);
  std::copy_n(local, f.columns, x + f.first);
}

// A front's update touches the fronts above it.
void BlockCholesky::touch_above(Columns& columns) const {
  const std::size_t packs = columns.packs;
  for (std::size_t s = 0; s < fronts_.size(); ++s)
    for (std::size_t p = 0; p < packs && fronts_[s].parent != kNoFront; ++p)
      if (columns.touched[s * packs + p]) columns.touched[fronts_[s].parent * packs + p] = 1;
}

// x = L^-1 x. Fronts that a pack does not touch are skipped.
template <class Lane>
void BlockCholesky::forward_all(Lane* x, const Columns& columns) const {
  const bool shared = !top_.empty();
  const std::size_t packs = columns.packs;
  const char* const touched = columns.touched.data();
  sums_above_.resize(std::max<std::size_t>(packs * above_, 1));
  const auto above_of = [&](const Subtree& tree, std::size_t pack) {
    return reinterpret_cast<Lane*>(sums_above_.data()) + packs * tree.above + pack * fronts_[tree.root].below.size();
  };
  for_each_task(shared, subtrees_.size(), [&](std::size_t i, unsigned thread) {
    const Subtree& tree = subtrees_[i];
    std::fill_n(above_of(tree, 0), packs * fronts_[tree.root].below.size(), Lane{});
    Scratch& own = scratch(thread);
    for (std::uint32_t s = tree.first; s <= tree.root; ++s)
      for (std::size_t p = 0; p < packs; ++p)
        if (touched[s * packs + p]) forward_front(fronts_[s], x + p * rows_, above_of(tree, p), own);
  });
  for_each_task(shared, packs, [&](std::size_t p, unsigned thread) {
    for (const Subtree& tree : subtrees_) {
      const Front& root = fronts_[tree.root];
      if (!touched[tree.root * packs + p]) continue;
      const Lane* const sums = above_of(tree, p);
      for (std::size_t i = 0; i < root.below.size(); ++i) add_lane(x[p * rows_ + root.below[i]], sums[i]);
    }
    Scratch& own = scratch(thread);
    for (const std::uint32_t s : top_)
      if (touched[s * packs + p]) forward_front<Lane>(fronts_[s], x + p * rows_, nullptr, own);
  });
}

// x = L^-T x.
template <class Lane>
void BlockCholesky::backward_all(Lane* x, std::size_t packs) const {
  const bool shared = !top_.empty();
  for_each_task(shared, packs, [&](std::size_t p, unsigned thread) {
    Scratch& own = scratch(thread);
    for (std::size_t i = top_.size(); i-- > 0;) backward_front(fronts_[top_[i]], x + p * rows_, own);
  });
  for_each_task(shared, subtrees_.size(), [&](std::size_t i, unsigned thread) {
    const Subtree& tree = subtrees_[i];
    Scratch& own = scratch(thread);
    for (std::uint32_t s = tree.root + 1; s-- > tree.first;)
      for (std::size_t p = 0; p < packs; ++p) backward_front(fronts_[s], x + p * rows_, own);
  });
}

void BlockCholesky::solve(const Vector& b, Vector& x) const {
  now_.packs = 1;
  now_.x.resize(rows_ / kStrip + 1);
  now_.touched.assign(fronts_.size(), 1);
  double* const w = now_.x.front().lane;
  for (std::uint32_t i = 0; i < old_of_new_.size(); ++i)
    for (std::uint32_t d = 0; d < 3; ++d) w[3 * i + d] = b[3 * old_of_new_[i] + d];
  forward_all(w, now_);
  backward_all(w, 1);
  x.resize(b.size());
  for (std::uint32_t i = 0; i < old_of_new_.size(); ++i)
    for (std::uint32_t d = 0; d < 3; ++d) x[3 * old_of_new_[i] + d] = w[3 * i + d];
}

void BlockCholesky::solve_many(Eigen::Ref<Rows> columns) const {
  if (columns.cols() != 1) return solve_packs(columns);  // none: nothing to do
  Vector x;
  solve(columns.col(0), x);
  columns.col(0) = x;
}

void BlockCholesky::solve_packs(Eigen::Ref<Rows> columns) const {
  constexpr auto kMost = static_cast<Eigen::Index>(kMostPacks) * kStrip;
  for (Eigen::Index from = 0; from < columns.cols(); from += kMost) {
    auto some = columns.middleCols(from, std::min<Eigen::Index>(kMost, columns.cols() - from));
    start_packs(now_, some.cols());
    for_each_task(!top_.empty(), now_.packs, [&](std::size_t p, unsigned) { take_columns(some, p); });
    touch_above(now_);
    forward_all(now_.x.data(), now_);
    backward_all(now_.x.data(), now_.packs);
    for_each_task(!top_.empty(), now_.packs, [&](std::size_t p, unsigned) { give_columns(some, p); });
  }
}

void BlockCholesky::start_packs(Columns& columns, Eigen::Index count) const {
  columns.packs = static_cast<std::size_t>((count + kStrip - 1) / kStrip);
  columns.x.resize(columns.packs * rows_);
  columns.touched.assign(columns.packs * fronts_.size(), 0);
}

// A^-1 B mix = L^-T (Y mix), Y of the last solve_gram.
bool BlockCholesky::solve_kept(const ColumnMix& mix, Eigen::Ref<Rows> out) const {
  if (kept_.packs == 0) return false;
  if (mix.count() == 0) return true;
  start_packs(now_, mix.count());
  for_each_task(!top_.empty(), now_.packs, [&](std::size_t p, unsigned) { mix_columns(mix, p); });
  backward_all(now_.x.data(), now_.packs);
  for_each_task(!top_.empty(), now_.packs, [&](std::size_t p, unsigned) { give_columns(out, p); });
  return true;
}

// One pack of now_: combinations of kept_'s columns.
void BlockCholesky::mix_columns(const ColumnMix& mix, std::size_t pack) const {
  const Eigen::Index from = static_cast<Eigen::Index>(pack) * kStrip;
  const auto count = static_cast<int>(std::min<Eigen::Index>(kStrip, mix.count() - from));
  Strip* const to = &now_.x[pack * rows_];
  std::fill_n(to, rows_, Strip{});
  for (int lane = 0; lane < count; ++lane)
    for (const ColumnMix::Part& part : mix.of(from + lane)) {
      const auto column = static_cast<std::size_t>(place_[static_cast<std::size_t>(part.column / 3)] + part.column % 3);
      const std::size_t p = column / kStrip, l = column % kStrip;
      for (std::size_t s = 0; s < fronts_.size(); ++s) {
        if (!kept_.touched[s * kept_.packs + p]) continue;
        const Front& f = fronts_[s];
        const Strip* const y = &kept_.x[p * rows_];
        for (std::uint32_t r = f.first; r < f.first + static_cast<std::uint32_t>(f.columns); ++r)
          to[r].lane[lane] += part.factor * y[r].lane[l];
      }
    }
}

// B^T A^-1 B = Y^T Y with Y = L^-1 B. It needs no backward substitution, and Y is non-zero only on the paths from B's
// rows to the roots of the elimination tree. Triples are sorted by the elimination order of their first rows, so that
// few packs of eight columns share a front far from the roots.
void BlockCholesky::solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const {
  place_ = place_columns(b);
  start_packs(kept_, 3 * b.count());
  const std::size_t packs = kept_.packs;
  for (Eigen::Index three = 0; three < b.count(); ++three)
    for (const BlockColumns::Entry& entry : b.of(three))
      for (int c = 0; c < 3; ++c)
        kept_.touched[front_of_[new_of_old_[entry.row]] * packs +
                      static_cast<std::size_t>(place_[static_cast<std::size_t>(three)] + c) / kStrip] = 1;
  touch_above(kept_);
  for_each_task(!top_.empty(), packs, [&](std::size_t p, unsigned) {
    for (std::size_t s = 0; s < fronts_.size(); ++s)
      if (kept_.touched[s * packs + p])
        std::fill_n(&kept_.x[p * rows_ + fronts_[s].first], fronts_[s].columns, Strip{});
  });
  for (Eigen::Index three = 0; three < b.count(); ++three)
    for (const BlockColumns::Entry& entry : b.of(three))
      for (int c = 0; c < 3; ++c) {
        const auto column = static_cast<std::size_t>(place_[static_cast<std::size_t>(three)] + c);
        Strip* const x = &kept_.x[column / kStrip * rows_ + 3 * new_of_old_[entry.row]];
        for (int r = 0; r < 3; ++r) x[r].lane[column % kStrip] += entry.value(r, c);
      }
  forward_all(kept_.x.data(), kept_);
  add_grams();

  gram.resize(3 * b.count(), 3 * b.count());
  const auto of = [&](Eigen::Index i) {
    return static_cast<std::size_t>(place_[static_cast<std::size_t>(i / 3)] + i % 3);
  };
  for (Eigen::Index i = 0; i < gram.rows(); ++i)
    for (Eigen::Index j = 0; j < gram.cols(); ++j) {
      const std::size_t row = std::max(of(i), of(j)), column = std::min(of(i), of(j)), p = row / kStrip;
      gram(i, j) = tiles_[(p * (p + 1) / 2 + column / kStrip) * kStrip + column % kStrip].lane[row % kStrip];
    }
}

// tiles_ = Y^T Y, pack by pack.
void BlockCholesky::add_grams() const {
  const std::size_t packs = kept_.packs;
  tiles_.assign(packs * (packs + 1) / 2 * kStrip, Strip{});
  for_each_task(!top_.empty(), std::min(packs, kGramTasks), [&](std::size_t task, unsigned) {
    std::vector<std::size_t> here;  // packs with non-zeros in this front
    for (std::size_t s = 0; s < fronts_.size(); ++s) {
      const Front& f = fronts_[s];
      here.clear();
      for (std::size_t p = 0; p < packs; ++p)
        if (kept_.touched[s * packs + p]) here.push_back(p);
      for (const std::size_t p : here) {
        if (p % kGramTasks != task) continue;
        for (const std::size_t q : here) {
          if (q > p) break;
          add_gram(kept_.x[p * rows_ + f.first].lane, kStrip, kept_.x[q * rows_ + f.first].lane, kStrip, f.columns,
                   tiles_[(p * (p + 1) / 2 + q) * kStrip].lane);
        }
      }
    }
  });
}

// Column index of each triple.
std::vector<Eigen::Index> BlockCholesky::place_columns(const BlockColumns& b) const {
  std::vector<std::pair<std::uint32_t, Eigen::Index>> order;  // first row, three
  for (Eigen::Index three = 0; three < b.count(); ++three) {
    std::uint32_t first = kNoFront;
    for (const BlockColumns::Entry& entry : b.of(three)) first = std::min(first, new_of_old_[entry.row]);
    order.emplace_back(first, three);
  }
  std::sort(order.begin(), order.end());
  std::vector<Eigen::Index> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    place[static_cast<std::size_t>(order[k].second)] = 3 * static_cast<Eigen::Index>(k);
  return place;
}

// One pack of now_ in the factor's order; touched: fronts in which one of its columns is non-zero.
void BlockCholesky::take_columns(Eigen::Ref<const Rows> columns, std::size_t pack) const {
  const auto from = static_cast<Eigen::Index>(pack) * kStrip;
  const Eigen::Index count = std::min<Eigen::Index>(kStrip, columns.cols() - from);
  for (std::size_t s = 0; s < fronts_.size(); ++s) {
    const Front& f = fronts_[s];
    bool any = false;
    for (std::uint32_t r = f.first; r < f.first + static_cast<std::uint32_t>(f.columns); ++r) {
      const double* const row = columns.data() + columns.outerStride() * (3 * old_of_new_[r / 3] + r % 3) + from;
      double* const to = now_.x[pack * rows_ + r].lane;
      std::copy_n(row, count, to);
      std::fill(to + count, to + kStrip, 0.0);
      for (int l = 0; l < kStrip; ++l) any |= to[l] != 0;
    }
    now_.touched[s * now_.packs + pack] = static_cast<char>(any);
  }
}

void BlockCholesky::give_columns(Eigen::Ref<Rows> columns, std::size_t pack) const {
  const auto from = static_cast<Eigen::Index>(pack) * kStrip;
  const Eigen::Index count = std::min<Eigen::Index>(kStrip, columns.cols() - from);
  for (std::uint32_t i = 0; i < old_of_new_.size(); ++i)
    for (std::uint32_t d = 0; d < 3; ++d)
      std::copy_n(now_.x[pack * rows_ + 3 * i + d].lane, count,
                  columns.data() + columns.outerStride() * (3 * old_of_new_[i] + d) + from);
}

}  // namespace pliant
