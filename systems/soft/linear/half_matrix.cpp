#include "systems/soft/linear/half_matrix.h"

#include <algorithm>
#include <cstring>

#include "runtime/kernel.h"

namespace pliant {
namespace {

// Breadth first from a node of smallest degree, neighbours by degree; one tree after the other.
std::vector<std::uint32_t> cuthill_mckee(const BlockMatrix& a) {
  const auto degree = [&](std::uint32_t v) { return a.first[v + 1] - a.first[v]; };
  const auto fewer = [&](std::uint32_t u, std::uint32_t v) {
    return degree(u) != degree(v) ? degree(u) < degree(v) : u < v;
  };
  std::vector<std::uint32_t> seeds(a.size), order;
  for (std::uint32_t v = 0; v < a.size; ++v) seeds[v] = v;
  std::sort(seeds.begin(), seeds.end(), fewer);
  std::vector<char> seen(a.size, 0);
  order.reserve(a.size);
  for (const std::uint32_t seed : seeds) {
    if (seen[seed]) continue;
    seen[seed] = 1;
    order.push_back(seed);
    for (std::size_t head = order.size() - 1; head < order.size(); ++head) {
      const std::size_t begin = order.size();
      for (std::uint32_t k = a.first[order[head]]; k < a.first[order[head] + 1]; ++k)
        if (!seen[a.column[k]]) seen[a.column[k]] = 1, order.push_back(a.column[k]);
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin), order.end(), fewer);
    }
  }
  return order;
}

template <class Scalar>
inline __attribute__((always_inline)) void multiply_half(const HalfPattern& pattern, const HalfMatrix<Scalar>& a,
                                                         const Scalar* x, Scalar* y) {
  typedef Scalar Pack __attribute__((vector_size(4 * sizeof(Scalar))));
  const auto load = [](Pack& four, const Scalar* p) { std::memcpy(&four, p, sizeof four); };  // from any address
  for (std::uint32_t row = 0; row < pattern.size(); ++row) {
    Pack own, d0, d1, d2;
    load(own, x + 4 * row);
    const Scalar* d = a.diagonal.data() + 9 * row;
    load(d0, d), load(d1, d + 3), load(d2, d + 6);
    Pack sum0 = d0 * own, sum1 = d1 * own, sum2 = d2 * own;
    for (std::uint32_t k = pattern.first[row]; k < pattern.first[row + 1]; ++k) {
      const Scalar* const b = a.block.data() + 9 * k;
      Pack b0, b1, b2, other, there;
      load(b0, b), load(b1, b + 3), load(b2, b + 6), load(other, x + 4 * pattern.column[k]);
      sum0 += b0 * other, sum1 += b1 * other, sum2 += b2 * other;
      load(there, y + 4 * pattern.column[k]);
      there += (b0 * own[0] + b1 * own[1]) + b2 * own[2];
      std::memcpy(y + 4 * pattern.column[k], &there, sizeof there);
    }
    Scalar* const out = y + 4 * row;
    out[0] = (sum0[0] + sum0[1]) + sum0[2];
    out[1] = (sum1[0] + sum1[1]) + sum1[2];
    out[2] = (sum2[0] + sum2[1]) + sum2[2];
  }
  for (std::uint32_t row = 0; row < pattern.size(); ++row) y[4 * row + 3] = 0;
}

}  // namespace

HalfPattern half_pattern(const BlockMatrix& a) {
  HalfPattern p;
  p.old_of_new = cuthill_mckee(a);
  std::vector<std::uint32_t> new_of_old(a.size);
  for (std::uint32_t i = 0; i < a.size; ++i) new_of_old[p.old_of_new[i]] = i;
  p.first.push_back(0);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> row;
  for (std::uint32_t i = 0; i < a.size; ++i) {
    const std::uint32_t old = p.old_of_new[i];
    row.clear();
    for (std::uint32_t k = a.first[old]; k < a.first[old + 1]; ++k)
      if (new_of_old[a.column[k]] < i) row.emplace_back(new_of_old[a.column[k]], k);
    std::sort(row.begin(), row.end());
    for (const auto& [column, source] : row) p.column.push_back(column), p.source.push_back(source);
    p.first.push_back(static_cast<std::uint32_t>(p.column.size()));
    p.diagonal.push_back(a.diagonal[old]);
  }
  return p;
}

template <class Scalar>
void HalfMatrix<Scalar>::take(const HalfPattern& pattern, const BlockMatrix& a) {
  block.resize(9 * pattern.source.size() + 1), diagonal.resize(9 * pattern.diagonal.size() + 1);
  const auto copy = [&](const std::vector<std::uint32_t>& from, std::vector<Scalar>& to) {
    for (std::size_t k = 0; k < from.size(); ++k)
      for (std::size_t i = 0; i < 9; ++i) to[9 * k + i] = static_cast<Scalar>(a.value[from[k]].data()[i]);
  };
  copy(pattern.source, block);
  copy(pattern.diagonal, diagonal);
}
template struct HalfMatrix<float>;
template struct HalfMatrix<double>;

PLIANT_KERNEL void multiply(const HalfPattern& pattern, const HalfMatrix<double>& a, const double* x, double* y) {
  multiply_half<double>(pattern, a, x, y);
}
void multiply(const HalfPattern& pattern, const HalfMatrix<float>& a, const float* x, float* y) {
  multiply_half<float>(pattern, a, x, y);
}

}  // namespace pliant
