#include "systems/soft/linear/block_cholesky.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace pliant {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr double kTaskShare = 0.15;   // [1] of the factor's work: the largest subtree that is one task
constexpr double kSharedWork = 5e7;   // [1] multiplications and additions: less, some 3,000 tetrahedra, gains nothing
constexpr double kSharedFront = 6e6;  // the same of one front
constexpr int kBlockColumns = 64;   // columns of a panel whose diagonal block is factorised before the strips below it
constexpr int kStripsTogether = 4;  // of a task
constexpr int kUpdateColumns = 48;  // the same of an update

int strips_of(std::size_t rows) {
  return static_cast<int>((rows + kStrip - 1) / kStrip);
}
std::size_t triangle_strips(int strips) {
  return static_cast<std::size_t>(triangle_size(strips)) / kStrip;
}

}  // namespace

void BlockCholesky::analyse(const BlockMatrix& a) {
  Elimination e = plan_elimination(a);
  flops_ = e.flops;
  rows_ = 3 * static_cast<std::size_t>(a.size);
  place_fronts(e);
  share_tree(e);
  place_updates();
  place_sources(a, e);
  factor_.clear(), stack_.clear();
  reciprocal_.resize(rows_);
  scratch_.fill({});
  front_of_.clear();
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) front_of_.insert(front_of_.end(), e.supernodes[s].count, s);
  old_of_new_ = std::move(e.old_of_new), new_of_old_ = std::move(e.new_of_old);
}

void BlockCholesky::place_fronts(const Elimination& e) {
  fronts_.assign(e.supernodes.size(), {});
  factor_strips_ = most_rows_ = most_columns_ = 0;
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) {
    const Supernode& node = e.supernodes[s];
    Front& f = fronts_[s];
    f.first = 3 * node.first;
    f.columns = static_cast<int>(3 * node.count);
    f.strips = strips_of(3 * (node.count + node.below.size()));
    f.panel = factor_strips_;
    f.parent = node.parent;
    for (const std::uint32_t row : node.below)
      for (std::uint32_t i = 0; i < 3; ++i) f.below.push_back(3 * row + i);
    factor_strips_ += static_cast<std::size_t>(f.columns) * static_cast<std::size_t>(f.strips);
    most_rows_ = std::max(most_rows_, static_cast<std::size_t>(f.strips) * kStrip);
    most_columns_ = std::max(most_columns_, static_cast<std::size_t>(f.columns));
    if (f.parent == kNone) continue;
    const Supernode& up = e.supernodes[f.parent];
    for (const std::uint32_t row : f.below) {
      const std::uint32_t block = row / 3, end = up.first + up.count;
      const auto under = std::lower_bound(up.below.begin(), up.below.end(), block) - up.below.begin();
      const auto at = block < end ? block - up.first : up.count + static_cast<std::uint32_t>(under);
      f.in_parent.push_back(static_cast<int>(3 * at + row % 3));
    }
  }
}

// The largest subtrees within a share of the work are tasks; top_ has what is above them.
void BlockCholesky::share_tree(const Elimination& e) {
  std::vector<double> work(fronts_.size());  // of the subtree
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) fronts_[s].descendant = s;
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) {
    work[s] += flops_of(e.supernodes[s]);
    if (const std::uint32_t parent = fronts_[s].parent; parent != kNone) {
      work[parent] += work[s];
      fronts_[parent].descendant = std::min(fronts_[parent].descendant, fronts_[s].descendant);
    }
  }
  const auto small = [&](std::uint32_t s) { return work[s] <= kTaskShare * flops_ || flops_ < kSharedWork; };
  subtrees_.clear(), top_.clear();
  for (std::uint32_t s = 0; s < fronts_.size(); ++s) {
    Front& f = fronts_[s];
    f.inside = f.below.size();
    if (!small(s))
      top_.push_back(s);
    else if (f.parent == kNone || !small(f.parent))
      subtrees_.push_back({f.descendant, s, 0, 0});
  }
  above_ = 0;
  for (Subtree& tree : subtrees_) {
    const std::vector<std::uint32_t>& outside = fronts_[tree.root].below;
    tree.above = above_;
    above_ += outside.size();
    for (std::uint32_t s = tree.first; s <= tree.root; ++s) {
      Front& f = fronts_[s];
      const std::uint32_t end = fronts_[tree.root].first + static_cast<std::uint32_t>(fronts_[tree.root].columns);
      f.inside = static_cast<std::size_t>(std::lower_bound(f.below.begin(), f.below.end(), end) - f.below.begin());
      for (std::size_t i = f.inside; i < f.below.size(); ++i)
        f.in_root.push_back(
            static_cast<std::uint32_t>(std::lower_bound(outside.begin(), outside.end(), f.below[i]) - outside.begin()));
    }
  }
}

// Each subtree has a stack of its own, on which its root's update remains; each front above has a place.
void BlockCholesky::place_updates() {
  stack_strips_ = 0;
  for (Subtree& tree : subtrees_) {
    std::size_t top = 0, highest = 0;
    for (std::uint32_t s = tree.first; s <= tree.root; ++s) {
      const std::size_t size = triangle_strips(fronts_[s].rest());
      highest = std::max(highest, top + size);
      for_each_child(s, [&](const Front& child) { top -= triangle_strips(child.rest()); });
      top += size;
    }
    tree.stack = fronts_[tree.root].update = stack_strips_;
    stack_strips_ += highest;
  }
  for (const std::uint32_t s : top_) {
    fronts_[s].update = stack_strips_;
    stack_strips_ += triangle_strips(fronts_[s].rest());
  }
  ++stack_strips_;
}

// The last child first.
template <class Use>
void BlockCholesky::for_each_child(std::uint32_t front, Use use) const {
  const std::uint32_t begin = fronts_[front].descendant;
  for (std::uint32_t next = front; next > begin; next = fronts_[next - 1].descendant) use(fronts_[next - 1]);
}

BlockCholesky::Scratch& BlockCholesky::scratch(unsigned thread) const {
  Scratch& own = scratch_[thread];
  for (auto* rows : {&own.from, &own.panel, &own.triangle}) rows->resize(most_rows_);
  own.local.resize(most_rows_ + 1), own.sums.resize(most_columns_ + 1);
  return own;
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

// Where the rows of a child's update are, there and in its parent's panel and triangle.
void BlockCholesky::place_update(const Front& child, const Front& parent, Scratch& scratch) const {
  const int above = child.columns / kStrip, parent_above = parent.columns / kStrip;
  const int rows = static_cast<int>(child.below.size());
  for (int i = 0; i < rows; ++i) {
    const int r = child.columns + i, to = child.in_parent[static_cast<std::size_t>(i)];
    const auto at = static_cast<std::size_t>(i);
    scratch.from[at] = static_cast<std::size_t>(triangle_size(r / kStrip - above) + r % kStrip);
    scratch.panel[at] = static_cast<std::size_t>(to / kStrip * kStrip * parent.columns + to % kStrip);
    scratch.triangle[at] =
        static_cast<std::size_t>(to < parent.columns ? 0 : triangle_size(to / kStrip - parent_above) + to % kStrip);
  }
}

// Adds columns of a child's update to its parent's panel and triangle; after place_update.
void BlockCholesky::add_update(const Front& child, const double* update, const Front& parent, double* panel,
                               double* triangle, const Scratch& scratch, int first, int last) const {
  const int above = child.columns / kStrip, parent_above = parent.columns / kStrip;
  const int rows = static_cast<int>(child.below.size());
  for (int i = first; i < last; ++i) {
    const double* const from = update + (child.columns + i - above * kStrip) * kStrip;
    const int to = child.in_parent[static_cast<std::size_t>(i)];
    const bool in_panel = to < parent.columns;
    double* const out = in_panel ? panel + to * kStrip : triangle + (to - parent_above * kStrip) * kStrip;
    const std::size_t* const row_to = in_panel ? scratch.panel.data() : scratch.triangle.data();
    for (int j = i; j < rows; ++j) out[row_to[j]] += from[scratch.from[static_cast<std::size_t>(j)]];
  }
}

bool BlockCholesky::factorise(const BlockMatrix& a) {
  factor_.resize(factor_strips_), stack_.resize(stack_strips_);
  kept_.packs = 0;
  std::atomic<bool> positive{true};
  run_tasks(subtrees_.size(), [&](std::size_t i, unsigned thread) {
    if (positive && !factorise_subtree(subtrees_[i], a, scratch(thread))) positive = false;
  });
  for (const std::uint32_t s : top_)
    if (positive && !factorise_top(s, a)) positive = false;
  return positive;
}

bool BlockCholesky::factorise_subtree(const Subtree& tree, const BlockMatrix& a, Scratch& scratch) {
  Strip* top = stack_.data() + tree.stack;
  for (std::uint32_t s = tree.first; s <= tree.root; ++s) {
    const Front& f = fronts_[s];
    double* const own = factor_[f.panel].lane;
    std::fill_n(own, f.columns * f.strips * kStrip, 0.0);
    assemble(f, a, own);
    const std::size_t size = triangle_strips(f.rest());
    std::fill_n(top, size, Strip{});
    Strip* below = top;
    for_each_child(s, [&](const Front& child) {
      below -= triangle_strips(child.rest());
      place_update(child, f, scratch);
      add_update(child, below->lane, f, own, top->lane, scratch, 0, static_cast<int>(child.below.size()));
    });
    double* const reciprocal = reciprocal_.data() + f.first;
    for (int first = 0; first < f.columns; first += kBlockColumns)
      if (!factorise_part(own, panel(f), reciprocal,
                          {first, std::min(first + kBlockColumns, f.columns), first / kStrip, f.strips}))
        return false;
    update_triangle(panel(f), top->lane, f.columns / kStrip, f.strips);
    std::copy(top, top + size, below);
    top = below + size;
  }
  return true;
}

// All threads on one front: first the diagonal block of some columns, then the strips below it.
bool BlockCholesky::factorise_top(std::uint32_t front, const BlockMatrix& a) {
  const Front& f = fronts_[front];
  double* const own = factor_[f.panel].lane;
  Strip* const triangle = stack_.data() + f.update;
  const bool shared = static_cast<double>(f.strips) * f.strips * f.columns * kStrip * kStrip > kSharedFront;
  const auto share = [&](int from, const auto& part) {
    if (!shared) return part(from, f.strips);
    const auto tasks = static_cast<std::size_t>((f.strips - from + kStripsTogether - 1) / kStripsTogether);
    run_tasks(tasks, [&](std::size_t i, unsigned) {  // the longest strips first
      const int to = f.strips - static_cast<int>(i) * kStripsTogether;
      part(std::max(from, to - kStripsTogether), to);
    });
  };
  share(0, [&](int from, int to) {
    const auto width = static_cast<std::ptrdiff_t>(f.columns) * kStrip;
    std::fill(own + from * width, own + to * width, 0.0);
    const int above = f.columns / kStrip;
    if (to > above)
      std::fill(triangle + triangle_strips(std::max(from, above) - above), triangle + triangle_strips(to - above),
                Strip{});
  });
  assemble(f, a, own);
  for_each_child(front, [&](const Front& child) {
    place_update(child, f, scratch(0));
    const auto columns = static_cast<int>(child.below.size());
    const auto add = [&](int from, int to) {
      add_update(child, stack_[child.update].lane, f, own, triangle->lane, scratch(0), from, to);
    };
    if (!shared) return add(0, columns);
    run_tasks(static_cast<std::size_t>((columns + kUpdateColumns - 1) / kUpdateColumns), [&](std::size_t i, unsigned) {
      const int from = static_cast<int>(i) * kUpdateColumns;
      add(from, std::min(from + kUpdateColumns, columns));
    });
  });
  double* const reciprocal = reciprocal_.data() + f.first;
  for (int first = 0; first < f.columns; first += kBlockColumns) {
    const int last = std::min(first + kBlockColumns, f.columns), under = strips_of(static_cast<std::size_t>(last));
    if (!factorise_part(own, panel(f), reciprocal, {first, last, first / kStrip, under})) return false;
    share(under, [&](int from, int to) {
      [[maybe_unused]] const bool done = factorise_part(own, panel(f), reciprocal, {first, last, from, to});
    });
  }
  share(f.columns / kStrip, [&](int from, int to) { update_triangle(panel(f), triangle->lane, from, to); });
  return true;
}

std::unique_ptr<LinearSolver> make_block_cholesky(std::uint32_t) {
  return std::make_unique<BlockCholesky>();
}

}  // namespace pliant
