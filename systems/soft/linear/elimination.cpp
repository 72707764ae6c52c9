#include "systems/soft/linear/elimination.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

#include "systems/soft/linear/nested_dissection.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNoParent = 0xffffffff;
constexpr std::uint32_t kLeastDissected = 100;  // block rows; smaller: minimum degree is as good

std::vector<std::uint32_t> minimum_degree(const BlockMatrix& a) {
  const int n = static_cast<int>(a.size);
  std::vector<Eigen::Triplet<char>> entries;
  for (std::uint32_t row = 0; row < a.size; ++row)
    for (std::uint32_t k = a.first[row]; k < a.first[row + 1]; ++k) entries.emplace_back(row, a.column[k], 1);
  Eigen::SparseMatrix<char> graph(n, n);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);
  return {order.indices().begin(), order.indices().end()};
}

std::vector<std::uint32_t> inverse(const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> out(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) out[order[i]] = i;
  return out;
}

// Liu's elimination tree with path compression: parent of each column.
std::vector<std::uint32_t> elimination_tree(const BlockMatrix& a, const std::vector<std::uint32_t>& old_of_new,
                                            const std::vector<std::uint32_t>& new_of_old) {
  std::vector<std::uint32_t> parent(a.size, kNoParent), ancestor(a.size, kNoParent);
  for (std::uint32_t row = 0; row < a.size; ++row) {
    const std::uint32_t old = old_of_new[row];
    for (std::uint32_t k = a.first[old]; k < a.first[old + 1]; ++k)
      for (std::uint32_t c = new_of_old[a.column[k]]; c < row;) {
        const std::uint32_t next = ancestor[c];
        ancestor[c] = row;
        if (next == kNoParent) {
          parent[c] = row;
          break;
        }
        c = next;
      }
  }
  return parent;
}

std::vector<std::uint32_t> postorder(const std::vector<std::uint32_t>& parent) {
  const auto n = static_cast<std::uint32_t>(parent.size());
  std::vector<std::uint32_t> child(n, kNoParent), sibling(n, kNoParent), roots, order;
  for (std::uint32_t c = n; c-- > 0;) {
    if (parent[c] == kNoParent) {
      roots.push_back(c);
    } else {
      sibling[c] = child[parent[c]];
      child[parent[c]] = c;
    }
  }
  order.reserve(n);
  std::vector<std::uint32_t> path;
  for (const std::uint32_t root : roots) {
    path.push_back(root);
    while (!path.empty()) {
      const std::uint32_t top = path.back();
      if (child[top] != kNoParent) {
        path.push_back(child[top]);
        child[top] = sibling[path.back()];
      } else {
        order.push_back(top);
        path.pop_back();
      }
    }
  }
  return order;
}

// Block rows under the diagonal of each column of the factor.
std::vector<std::vector<std::uint32_t>> column_rows(const BlockMatrix& a, const Elimination& e,
                                                    const std::vector<std::uint32_t>& parent) {
  std::vector<std::vector<std::uint32_t>> rows(a.size);
  for (std::uint32_t c = 0; c < a.size; ++c) {
    const std::uint32_t old = e.old_of_new[c];
    for (std::uint32_t k = a.first[old]; k < a.first[old + 1]; ++k)
      if (const std::uint32_t r = e.new_of_old[a.column[k]]; r > c) rows[c].push_back(r);
    std::sort(rows[c].begin(), rows[c].end());
    rows[c].erase(std::unique(rows[c].begin(), rows[c].end()), rows[c].end());
    if (parent[c] == kNoParent) continue;
    auto& up = rows[parent[c]];  // children's rows are added before the parent's are made unique
    up.insert(up.end(), rows[c].begin() + 1, rows[c].end());
  }
  return rows;
}

struct Candidate {
  Supernode node;
  double entries = 0;  // blocks of the factor without the explicit zeros
};

double panel_blocks(double count, double below) {
  return count * (count + 1) / 2 + count * below;
}

// Whether to merge a supernode with its parent, which directly follows it: fewer fronts for more zeros. On beams of 500
// to 2,100 nodes, twice these shares of zeros cost 5 to 10 % more, and so did none at all.
bool worth_merging(const Candidate& s, const Candidate& parent) {
  const double count = s.node.count + parent.node.count;
  const double blocks = panel_blocks(count, static_cast<double>(parent.node.below.size()));
  const double zeros = 1 - (s.entries + parent.entries) / blocks;
  if (count <= 2) return true;
  if (count <= 4) return zeros < 0.2;
  if (count <= 8) return zeros < 0.08;
  return zeros < 0.02;
}

std::vector<Supernode> merge_columns(std::vector<std::vector<std::uint32_t>> rows) {
  std::vector<Candidate> stack;
  for (std::uint32_t c = 0; c < rows.size(); ++c) {
    Candidate top{{c, 1, std::move(rows[c]), kNoParent}, 0};
    top.entries = 1.0 + static_cast<double>(top.node.below.size());
    while (!stack.empty()) {
      const Candidate& last = stack.back();
      const bool is_child = !last.node.below.empty() && last.node.below.front() < top.node.first + top.node.count;
      if (!is_child || !worth_merging(last, top)) break;
      top.node.first = last.node.first;
      top.node.count += last.node.count;
      top.entries += last.entries;
      stack.pop_back();
    }
    stack.push_back(std::move(top));
  }
  std::vector<Supernode> out;
  out.reserve(stack.size());
  for (Candidate& s : stack) out.push_back(std::move(s.node));
  return out;
}

Elimination plan(const BlockMatrix& a, const std::vector<std::uint32_t>& fill_reducing) {
  Elimination e;
  const auto tree = elimination_tree(a, fill_reducing, inverse(fill_reducing));
  for (const std::uint32_t c : postorder(tree)) e.old_of_new.push_back(fill_reducing[c]);
  e.new_of_old = inverse(e.old_of_new);
  e.supernodes = merge_columns(column_rows(a, e, elimination_tree(a, e.old_of_new, e.new_of_old)));
  for (const Supernode& s : e.supernodes) e.flops += flops_of(s);
  return e;
}

}  // namespace

double flops_of(const Supernode& s) {
  const double rows = 3.0 * (s.count + static_cast<double>(s.below.size()));
  double sum = 0;
  for (std::uint32_t c = 0; c < 3 * s.count; ++c) sum += (rows - c) * (rows - c);
  return sum;
}

Elimination plan_elimination(const BlockMatrix& a) {
  Elimination e = plan(a, minimum_degree(a));
  if (a.size >= kLeastDissected)
    if (Elimination dissected = plan(a, nested_dissection(a)); dissected.flops < e.flops) e = std::move(dissected);

  std::vector<std::uint32_t> owner(a.size);
  for (std::uint32_t s = 0; s < e.supernodes.size(); ++s)
    for (std::uint32_t c = 0; c < e.supernodes[s].count; ++c) owner[e.supernodes[s].first + c] = s;
  for (Supernode& s : e.supernodes)
    if (!s.below.empty()) s.parent = owner[s.below.front()];
  return e;
}

}  // namespace pliant
