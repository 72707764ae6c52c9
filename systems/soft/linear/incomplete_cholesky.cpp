#include "systems/soft/linear/incomplete_cholesky.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cstring>

namespace pliant {
namespace {

// Four floats in a register. Their address may be unaligned: a reference would promise a multiple of 16.
typedef float Pack __attribute__((vector_size(16)));
Pack at(const float* p) {
  Pack four;
  std::memcpy(&four, p, sizeof four);
  return four;
}
void put(float* p, Pack four) {
  std::memcpy(p, &four, sizeof four);
}

// Inverse of a symmetric block; false unless it is positive definite and finite.
bool invert(const Block& d, Block& out) {
  if (!d.allFinite()) return false;
  const Eigen::LLT<Eigen::Matrix3d> factor(d);
  if (factor.info() != Eigen::Success) return false;
  out = d.inverse();
  return out.allFinite();
}

void to_single(const std::vector<Block>& from, std::vector<float>& to) {
  to.resize(9 * from.size() + 1);
  for (std::size_t k = 0; k < from.size(); ++k)
    for (std::size_t i = 0; i < 9; ++i) to[9 * k + i] = static_cast<float>(from[k].data()[i]);
}

}  // namespace

bool IncompleteCholesky::factorise(const HalfPattern& pattern, const HalfMatrix<double>& a) {
  Block unused;
  for (std::uint32_t i = 0; i < pattern.size(); ++i)
    if (!invert(Eigen::Map<const Block>(a.diagonal.data() + 9 * i), unused)) return false;
  for (double lift = 0; lift < 10; lift = std::max(4 * lift, 1e-3))
    if (try_factorise(pattern, a, lift)) {
      to_single(w_, block_);
      to_single(inverse_d_, inverse_);
      return true;
    }
  return false;
}

// Row by row: W_ij = A_ij - sum_{k<j} W_ik D_k^-1 W_jk^T over k in both rows, D_i = A_ii - sum_j W_ij D_j^-1 W_ij^T.
bool IncompleteCholesky::try_factorise(const HalfPattern& pattern, const HalfMatrix<double>& a, double lift) {
  w_.resize(pattern.column.size());
  inverse_d_.resize(pattern.size());
  for (std::uint32_t i = 0; i < pattern.size(); ++i) {
    const std::uint32_t begin = pattern.first[i], end = pattern.first[i + 1];
    row_.resize(end - begin);  // W_ij D_j^-1
    Block d = (1 + lift) * Eigen::Map<const Block>(a.diagonal.data() + 9 * i);
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t j = pattern.column[k];
      Block w = Eigen::Map<const Block>(a.block.data() + 9 * k);
      for (std::uint32_t p = begin, q = pattern.first[j]; p < k && q < pattern.first[j + 1];) {
        const std::uint32_t left = pattern.column[p], right = pattern.column[q];
        if (left == right) w.noalias() -= row_[p - begin].lazyProduct(w_[q].transpose());
        p += left <= right, q += right <= left;
      }
      w_[k] = w;
      row_[k - begin].noalias() = w.lazyProduct(inverse_d_[j]);
      d.noalias() -= row_[k - begin].lazyProduct(w.transpose());
    }
    if (!invert(d, inverse_d_[i])) return false;
  }
  return true;
}

void IncompleteCholesky::apply(const HalfPattern& pattern, const float* r, float* z) const {
  const auto times = [](const float* b, float* v, Pack x) {  // v = B x
    const Pack b0 = at(b) * x, b1 = at(b + 3) * x, b2 = at(b + 6) * x;
    v[0] = (b0[0] + b0[1]) + b0[2], v[1] = (b1[0] + b1[1]) + b1[2], v[2] = (b2[0] + b2[1]) + b2[2];
  };
  // s_i = D_i^-1 (r_i - sum_j W_ij s_j)
  for (std::uint32_t i = 0; i < pattern.size(); ++i) {
    Pack sum0{}, sum1{}, sum2{};
    for (std::uint32_t k = pattern.first[i]; k < pattern.first[i + 1]; ++k) {
      const float* const b = block_.data() + 9 * k;
      const Pack s = at(z + 4 * pattern.column[k]);
      sum0 += at(b) * s, sum1 += at(b + 3) * s, sum2 += at(b + 6) * s;
    }
    const Pack rest{r[4 * i] - ((sum0[0] + sum0[1]) + sum0[2]), r[4 * i + 1] - ((sum1[0] + sum1[1]) + sum1[2]),
                    r[4 * i + 2] - ((sum2[0] + sum2[1]) + sum2[2]), 0};
    times(inverse_.data() + 9 * i, z + 4 * i, rest);
    z[4 * i + 3] = 0;
  }
  // z_i = s_i - D_i^-1 u_i, u_j = sum_i W_ij^T z_i
  std::vector<float>& u = rest_;
  u.assign(4 * pattern.size(), 0.0f);
  for (std::uint32_t i = pattern.size(); i-- > 0;) {
    float change[4] = {};
    times(inverse_.data() + 9 * i, change, at(u.data() + 4 * i));
    Pack own = at(z + 4 * i) - at(change);
    own[3] = 0;
    put(z + 4 * i, own);
    for (std::uint32_t k = pattern.first[i]; k < pattern.first[i + 1]; ++k) {
      const float* const b = block_.data() + 9 * k;
      float* const there = u.data() + 4 * pattern.column[k];
      put(there, at(there) + ((at(b) * own[0] + at(b + 3) * own[1]) + at(b + 6) * own[2]));
    }
  }
}

}  // namespace pliant
