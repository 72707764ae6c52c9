#include "systems/soft/linear/panel_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

// Every kernel is compiled for plain x86-64, for AVX2 and for AVX-512, and selects the version at each call. GCC's
// function multiversioning works only for callers that see all versions; others get the plain one. Without fused
// multiply-add AVX-512 is as fast as AVX2 on a Xeon (19 Gflop/s: two ports instead of three), and twice as fast on a
// Zen 5. Sanitizers get the plain version.
#if defined(__x86_64__) && !defined(PLIANT_SANITIZED) && !defined(__clang__)
#define PLIANT_KERNEL(returns, name, parameters, arguments, body)                          \
  returns plain::name parameters {                                                         \
    return body(16);                                                                       \
  }                                                                                        \
  __attribute__((target("avx2"))) static returns wide_##name parameters {                  \
    return body(32);                                                                       \
  }                                                                                        \
  __attribute__((target("avx512f,avx512dq"))) static returns widest_##name parameters {    \
    return body(64);                                                                       \
  }                                                                                        \
  returns name parameters {                                                                \
    if (has_avx512()) return widest_##name arguments;                                      \
    return __builtin_cpu_supports("avx2") ? wide_##name arguments : plain::name arguments; \
  }
#else
#define PLIANT_KERNEL(returns, name, parameters, arguments, body) \
  returns plain::name parameters {                                \
    return body(16);                                              \
  }                                                               \
  returns name parameters {                                       \
    return plain::name arguments;                                 \
  }
#endif
#define PLIANT_INLINE inline __attribute__((always_inline))

namespace pliant {
namespace {

#if defined(__x86_64__) && !defined(PLIANT_SANITIZED) && !defined(__clang__)
bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
}
#endif

template <int kBytes>
struct Machine {
  typedef double Pack __attribute__((vector_size(kBytes), may_alias));
  static constexpr int kLanes = kBytes / 8;
  static constexpr int kPacks = kStrip / kLanes;  // packs in a strip
  static constexpr int kGroup = kBytes / 8;       // columns of a tile summed at a time: the limit of the registers
};

// tile[j] = (kSum: +=) sum over p of a[p] * scalar(p, j), j < width <= 8 (and some beyond), p < length. a: strips of 8,
// `step` apart. The scalars are numbers of the panel:
//   kRow:    at b[8 p + j], one strip of the panel: its rows j, columns p;
//   kColumn: at b[(p / 8) * stride + 8 j + p % 8], strip after strip: rows p, columns j.
enum class Read { kRow, kColumn };
template <int kBytes, Read kRead, bool kSum = false>
PLIANT_INLINE void find_products(const double* a, const double* b, int length, int stride, double* tile,
                                 int width = kStrip, int step = kStrip) {
  using M = Machine<kBytes>;
  using Pack = typename M::Pack;
  constexpr int kRun = kRead == Read::kRow ? 1 : kStrip, kNext = kRead == Read::kRow ? 1 : kStrip;
  for (int group = 0; group < width; group += M::kGroup) {
    Pack sum[M::kGroup][M::kPacks];
    for (int j = 0; j < M::kGroup; ++j)
      for (int l = 0; l < M::kPacks; ++l)
        sum[j][l] = kSum ? *reinterpret_cast<const Pack*>(tile + (group + j) * kStrip + l * M::kLanes) : Pack{};
    const double* scalar = b + group * kNext;
    for (int p = 0; p < length; p += kRun, scalar += stride)
      for (int run = 0; run < kRun; ++run)
        for (int l = 0; l < M::kPacks; ++l) {
          Pack strip;  // unaligned
          std::memcpy(&strip, a + (p + run) * step + l * M::kLanes, sizeof strip);
          for (int j = 0; j < M::kGroup; ++j) sum[j][l] += strip * scalar[j * kNext + run];
        }
    for (int j = 0; j < M::kGroup; ++j)
      for (int l = 0; l < M::kPacks; ++l)
        *reinterpret_cast<Pack*>(tile + (group + j) * kStrip + l * M::kLanes) = sum[j][l];
  }
}

// y[lane] += s * x[lane] over a strip.
template <int kBytes>
PLIANT_INLINE void add_scaled(double* y, const double* x, double s) {
  using M = Machine<kBytes>;
  using Pack = typename M::Pack;
  for (int l = 0; l < kStrip; l += M::kLanes)
    *reinterpret_cast<Pack*>(y + l) += *reinterpret_cast<const Pack*>(x + l) * s;
}

PLIANT_INLINE void scale(double* x, double s) {
  for (int l = 0; l < kStrip; ++l) x[l] *= s;
}

// Right-looking, column by column: the triangle of a diagonal tile and the rows that share its strip.
template <int kBytes>
PLIANT_INLINE bool factorise_tile(double* tile, int width, double* reciprocal) {
  for (int j = 0; j < width; ++j) {
    double* column = tile + j * kStrip;
    const double pivot = column[j];
    if (!(pivot > 0 && pivot < HUGE_VAL)) return false;
    reciprocal[j] = 1 / std::sqrt(pivot);
    std::fill(column, column + j, 0.0);
    scale(column, reciprocal[j]);
    for (int q = j + 1; q < width; ++q) add_scaled<kBytes>(tile + q * kStrip, column, -column[q]);
  }
  return true;
}

// out = (out - sums) L^-T, L the triangle of the columns' own tile: eight columns stay in registers.
template <int kBytes>
PLIANT_INLINE void solve_strip(double* out, const double* sums, const double* L, int width, const double* reciprocal) {
  using M = Machine<kBytes>;
  using Pack = typename M::Pack;
  for (int l = 0; l < kStrip; l += M::kLanes) {
    Pack y[kStrip];
#pragma GCC unroll 8
    for (int j = 0; j < kStrip; ++j) {
      if (j >= width) break;
      y[j] =
          *reinterpret_cast<const Pack*>(out + j * kStrip + l) - *reinterpret_cast<const Pack*>(sums + j * kStrip + l);
#pragma GCC unroll 8
      for (int q = 0; q < j; ++q) y[j] -= y[q] * L[q * kStrip + j];
      y[j] *= reciprocal[j];
      *reinterpret_cast<Pack*>(out + j * kStrip + l) = y[j];
    }
  }
}

// Eight columns of one strip: subtracts the columns already factorised, then divides by the diagonal block's triangle,
// or factorises that.
template <int kBytes>
PLIANT_INLINE bool factorise_strip(double* strip, const double* pivots, int begin, int width, double* reciprocal) {
  alignas(64) double tile[kStrip * kStrip];
  double* const out = strip + begin * kStrip;
  find_products<kBytes, Read::kRow>(strip, pivots, begin, kStrip, tile, width);
  if (strip != pivots) {
    solve_strip<kBytes>(out, tile, pivots + begin * kStrip, width, reciprocal + begin);
    return true;
  }
  for (int c = 0; c < width * kStrip; ++c) tile[c] = out[c] - tile[c];
  if (!factorise_tile<kBytes>(tile, width, reciprocal + begin)) return false;
  std::copy(tile, tile + width * kStrip, out);
  return true;
}

// Strip by strip: a strip stays in the cache while its columns are done.
template <int kBytes>
PLIANT_INLINE bool factorise_part_for(double* data, FactorPanel panel, double* reciprocal, PanelPart part) {
  const auto stride = static_cast<std::ptrdiff_t>(kStrip) * panel.columns;
  for (int i = part.from; i < part.to; ++i)
    for (int begin = part.first; begin < part.last && begin <= i * kStrip; begin += kStrip)
      if (!factorise_strip<kBytes>(data + i * stride, data + begin / kStrip * stride, begin,
                                   std::min(kStrip, part.last - begin), reciprocal))
        return false;
  return true;
}

// Eight strips of rows at a time, which share every strip of columns in the cache.
template <int kBytes>
PLIANT_INLINE void update_triangle_for(FactorPanel panel, double* triangle, int from, int to) {
  alignas(64) double tile[kStrip * kStrip];
  const auto stride = static_cast<std::ptrdiff_t>(kStrip) * panel.columns;
  const int above = panel.columns / kStrip;
  for (int begin = from; begin < to; begin += kStrip)
    for (int j = above; j < std::min(begin + kStrip, to); ++j)
      for (int i = std::max(begin, j); i < std::min(begin + kStrip, to); ++i) {
        find_products<kBytes, Read::kRow>(panel.data + i * stride, panel.data + j * stride, panel.columns, kStrip,
                                          tile);
        double* const out = triangle + triangle_size(i - above) + static_cast<std::ptrdiff_t>(j - above) * 64;
        for (int c = 0; c < kStrip * kStrip; ++c) out[c] -= tile[c];
      }
}

template <int kBytes>
PLIANT_INLINE void forward_for(FactorPanel panel, const double* reciprocal, double* x) {
  const int stride = kStrip * panel.columns;
  for (int i = 0; i < panel.strips; ++i) {
    const double* const strip = panel.data + static_cast<std::ptrdiff_t>(i) * stride;
    alignas(64) double sum[kStrip] = {};
    const int begin = std::min(i * kStrip, panel.columns);
    for (int p = 0; p < begin; ++p) add_scaled<kBytes>(sum, strip + p * kStrip, x[p]);
    for (int l = 0; l < kStrip; ++l) x[i * kStrip + l] -= sum[l];
    for (int p = begin; p < std::min(begin + kStrip, panel.columns); ++p) {
      x[p] *= reciprocal[p];
      for (int r = p + 1; r < (i + 1) * kStrip; ++r) x[r] -= strip[p * kStrip + r % kStrip] * x[p];
    }
  }
}

template <int kBytes>
PLIANT_INLINE void backward_for(FactorPanel panel, const double* reciprocal, double* x, double* sums) {
  const int stride = kStrip * panel.columns;
  std::fill(sums, sums + stride, 0.0);
  for (int i = panel.strips - 1; i >= 0; --i) {
    const double* const strip = panel.data + static_cast<std::ptrdiff_t>(i) * stride;
    const int begin = std::min(i * kStrip, panel.columns), end = std::min(begin + kStrip, panel.columns);
    for (int p = end - 1; p >= begin; --p) {
      const double* const s = sums + p * kStrip;
      double sum = ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
      for (int r = p + 1; r < (i + 1) * kStrip; ++r) sum += strip[p * kStrip + r % kStrip] * x[r];
      x[p] = (x[p] - sum) * reciprocal[p];
    }
    using M = Machine<kBytes>;
    using Pack = typename M::Pack;
    Pack y[M::kPacks];
    for (int l = 0; l < M::kPacks; ++l) y[l] = *reinterpret_cast<const Pack*>(x + i * kStrip + l * M::kLanes);
    for (int p = 0; p < begin; ++p)
      for (int l = 0; l < M::kPacks; ++l)
        *reinterpret_cast<Pack*>(sums + p * kStrip + l * M::kLanes) +=
            *reinterpret_cast<const Pack*>(strip + p * kStrip + l * M::kLanes) * y[l];
  }
}

// Eight rows of right-hand sides in registers: rows - sums, of which the first `width` belong to the triangle L.
template <int kBytes>
PLIANT_INLINE void substitute_forward(double* rows, const double* sums, const double* L, int width,
                                      const double* reciprocal) {
  using M = Machine<kBytes>;
  using Pack = typename M::Pack;
  for (int l = 0; l < kStrip; l += M::kLanes) {
    Pack y[kStrip];
#pragma GCC unroll 8
    for (int r = 0; r < kStrip; ++r)
      y[r] =
          *reinterpret_cast<const Pack*>(rows + r * kStrip + l) - *reinterpret_cast<const Pack*>(sums + r * kStrip + l);
#pragma GCC unroll 8
    for (int p = 0; p < kStrip; ++p) {
      if (p >= width) break;
      y[p] *= reciprocal[p];
#pragma GCC unroll 8
      for (int r = p + 1; r < kStrip; ++r) y[r] -= y[p] * L[p * kStrip + r];
    }
#pragma GCC unroll 8
    for (int r = 0; r < kStrip; ++r) *reinterpret_cast<Pack*>(rows + r * kStrip + l) = y[r];
  }
}

// The same backwards: rows = (rows - sums) L^-1 for the first `width`; the others are solutions already.
template <int kBytes>
PLIANT_INLINE void substitute_backward(double* rows, const double* sums, const double* L, int width,
                                       const double* reciprocal) {
  using M = Machine<kBytes>;
  using Pack = typename M::Pack;
  for (int l = 0; l < kStrip; l += M::kLanes) {
    Pack y[kStrip];
#pragma GCC unroll 8
    for (int r = 0; r < kStrip; ++r) y[r] = *reinterpret_cast<const Pack*>(rows + r * kStrip + l);
#pragma GCC unroll 8
    for (int p = kStrip - 1; p >= 0; --p) {
      if (p >= width) continue;
      Pack sum = *reinterpret_cast<const Pack*>(sums + p * kStrip + l);
#pragma GCC unroll 8
      for (int r = p + 1; r < kStrip; ++r) sum += y[r] * L[p * kStrip + r];
      y[p] = (y[p] - sum) * reciprocal[p];
      *reinterpret_cast<Pack*>(rows + p * kStrip + l) = y[p];
    }
  }
}

template <int kBytes>
PLIANT_INLINE void forward_many_for(FactorPanel panel, const double* reciprocal, double* x) {
  alignas(64) double tile[kStrip * kStrip];
  const int stride = kStrip * panel.columns;
  for (int i = 0; i < panel.strips; ++i) {
    const double* const strip = panel.data + static_cast<std::ptrdiff_t>(i) * stride;
    double* const rows = x + i * kStrip * kStrip;
    const int begin = std::min(i * kStrip, panel.columns);
    find_products<kBytes, Read::kRow>(x, strip, begin, kStrip, tile);
    if (begin == panel.columns)
      for (int c = 0; c < kStrip * kStrip; ++c) rows[c] -= tile[c];
    else
      substitute_forward<kBytes>(rows, tile, strip + begin * kStrip, std::min(kStrip, panel.columns - begin),
                                 reciprocal + begin);
  }
}

template <int kBytes>
PLIANT_INLINE void backward_many_for(FactorPanel panel, const double* reciprocal, double* x) {
  alignas(64) double tile[kStrip * kStrip];
  const int stride = kStrip * panel.columns;
  for (int begin = (panel.columns - 1) / kStrip * kStrip; begin >= 0; begin -= kStrip) {
    const int end = std::min(begin + kStrip, panel.columns), own = begin / kStrip;
    find_products<kBytes, Read::kColumn>(x + (own + 1) * kStrip * kStrip,
                                         panel.data + static_cast<std::ptrdiff_t>(own + 1) * stride + begin * kStrip,
                                         (panel.strips - own - 1) * kStrip, stride, tile, end - begin);
    const double* const strip = panel.data + static_cast<std::ptrdiff_t>(own) * stride;
    substitute_backward<kBytes>(x + begin * kStrip, tile, strip + begin * kStrip, end - begin, reciprocal + begin);
  }
}

template <int kBytes>
PLIANT_INLINE void add_gram_for(const double* x, int x_step, const double* y, int y_step, int rows, double* tile) {
  find_products<kBytes, Read::kRow, true>(x, y, rows, y_step, tile, kStrip, x_step);
}

}  // namespace

#define FACTORISE(bytes) factorise_part_for<bytes>(data, panel, reciprocal, part)
#define UPDATE(bytes) update_triangle_for<bytes>(panel, triangle, from, to)
#define FORWARD(bytes) forward_for<bytes>(panel, reciprocal, x)
#define BACKWARD(bytes) backward_for<bytes>(panel, reciprocal, x, sums)
#define FORWARD_MANY(bytes) forward_many_for<bytes>(panel, reciprocal, x)
#define BACKWARD_MANY(bytes) backward_many_for<bytes>(panel, reciprocal, x)
#define GRAM(bytes) add_gram_for<bytes>(x, x_step, y, y_step, rows, tile)
#define BYTES(bytes) bytes

PLIANT_KERNEL(bool, factorise_part, (double* data, FactorPanel panel, double* reciprocal, PanelPart part),
              (data, panel, reciprocal, part), FACTORISE)
PLIANT_KERNEL(void, update_triangle, (FactorPanel panel, double* triangle, int from, int to),
              (panel, triangle, from, to), UPDATE)
PLIANT_KERNEL(void, forward, (FactorPanel panel, const double* reciprocal, double* x), (panel, reciprocal, x), FORWARD)
PLIANT_KERNEL(void, backward, (FactorPanel panel, const double* reciprocal, double* x, double* sums),
              (panel, reciprocal, x, sums), BACKWARD)
PLIANT_KERNEL(void, forward_many, (FactorPanel panel, const double* reciprocal, double* x), (panel, reciprocal, x),
              FORWARD_MANY)
PLIANT_KERNEL(void, backward_many, (FactorPanel panel, const double* reciprocal, double* x), (panel, reciprocal, x),
              BACKWARD_MANY)
PLIANT_KERNEL(void, add_gram, (const double* x, int x_step, const double* y, int y_step, int rows, double* tile),
              (x, x_step, y, y_step, rows, tile), GRAM)
PLIANT_KERNEL(int, panel_register_bytes, (), (), BYTES)

}  // namespace pliant
