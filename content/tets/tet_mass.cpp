#include "content/tets/tet_mass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "content/tets/tet_parts.h"
#include "content/tets/tet_quality.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr double kMassSamples = 10000;  // points in the box
constexpr double kSameVolume = 0.02;         // [1] volume by triangles and by samples
constexpr double kMatched = 1e-12;      // [1] moments that are equal
constexpr double kLeastStep = 1e-3;     // [1] of Newton's
constexpr double kMostPower = 30.0;     // [1] of a factor: no node takes so much
constexpr int kMostSteps = 60;
constexpr std::size_t kTerms = 10;  // 1, x, y, z, xx, yy, zz, yz, zx, xy

using Terms = std::array<double, kTerms>;

Terms terms_of(dvec3 x) {
  return {1.0, x.x, x.y, x.z, x.x * x.x, x.y * x.y, x.z * x.z, x.y * x.z, x.z * x.x, x.x * x.y};
}

// By a regular grid.
MassProperties sampled(const FillRegion& region) {
  const Box box = region.box();
  const dvec3 low(box.min), size(box.size());
  MassProperties out;
  const double step = std::cbrt(size.x * size.y * size.z / kMassSamples);
  if (!(step > 0.0)) return out;
  const glm::ivec3 count = glm::max(glm::ivec3(glm::ceil(glm::min(size / step, dvec3(1e3)))), glm::ivec3(1));
  struct Layer {
    double count = 0.0;
    dvec3 first{0};
    dmat3 second{0.0};
  };
  std::vector<Layer> layers(static_cast<std::size_t>(count.z));
  parallel_for(layers.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z)
      for (int y = 0; y < count.y; ++y)
        for (int x = 0; x < count.x; ++x) {
          const dvec3 p = size * (dvec3(x, y, static_cast<double>(z)) + 0.5) / dvec3(count);
          if (!region(low + p)) continue;
          layers[z].count += 1.0;
          layers[z].first += p;
          layers[z].second += glm::outerProduct(p, p);
        }
  });
  Layer sum;
  for (const Layer& each : layers) sum.count += each.count, sum.first += each.first, sum.second += each.second;
  if (!(sum.count > 0.0)) return out;
  const double each = size.x * size.y * size.z / (static_cast<double>(count.x) * count.y * count.z);
  const dvec3 middle = sum.first / sum.count;
  out.volume = sum.count * each;
  out.centre = low + middle;
  const dmat3 second = each * (sum.second - sum.count * glm::outerProduct(middle, middle));
  out.inertia = dmat3(second[0][0] + second[1][1] + second[2][2]) - second;
  return out;
}

// Gauss elimination with pivots on the diagonal's rows; false: singular.
bool solve(std::array<Terms, kTerms> A, Terms& b, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(A[i][k]) > std::abs(A[best][k])) best = i;
    if (!(std::abs(A[best][k]) > 1e-12 * std::abs(A[0][0]))) return false;
    std::swap(A[k], A[best]);
    std::swap(b[k], b[best]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = A[i][k] / A[k][k];
      for (std::size_t j = k; j < n; ++j) A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
  return true;
}

// Volumes times exp(a . terms), with the a at which their first n moments are `wanted`: the minimum of the convex
// D(a) = sum volume exp(a . terms) - a . wanted, by Newton's method. False: not found, and nothing has changed.
bool match(const std::vector<Terms>& terms, const Terms& wanted, std::size_t n, double whole,
           std::vector<double>& volume) {
  const auto factor = [&](const Terms& at, std::size_t i) {
    double power = 0.0;
    for (std::size_t k = 0; k < n; ++k) power += at[k] * terms[i][k];
    return std::exp(std::min(power, kMostPower));
  };
  const auto value = [&](const Terms& at) {
    double sum = 0.0;
    for (std::size_t i = 0; i < volume.size(); ++i) sum += volume[i] / whole * factor(at, i);
    for (std::size_t k = 0; k < n; ++k) sum -= at[k] * wanted[k];
    return sum;
  };
  Terms a{};
  double now = value(a);
  for (int step = 0; step < kMostSteps; ++step) {
    std::array<Terms, kTerms> A{};
    Terms b{};
    for (std::size_t k = 0; k < n; ++k) b[k] = wanted[k];
    for (std::size_t i = 0; i < volume.size(); ++i) {
      const double w = volume[i] / whole * factor(a, i);
      for (std::size_t k = 0; k < n; ++k) {
        b[k] -= w * terms[i][k];
        for (std::size_t j = 0; j < n; ++j) A[k][j] += w * terms[i][k] * terms[i][j];
      }
    }
    double off = 0.0;
    for (std::size_t k = 0; k < n; ++k) off = std::max(off, std::abs(b[k]));
    if (off < kMatched) {
      for (std::size_t i = 0; i < volume.size(); ++i) volume[i] *= factor(a, i);
      return true;
    }
    if (!solve(A, b, n)) return false;
    Terms next = a;
    double share = 1.0, then = now;
    for (; share > kLeastStep; share *= 0.5) {
      for (std::size_t k = 0; k < n; ++k) next[k] = a[k] + share * b[k];
      if (then = value(next); then <= now) break;
    }
    a = next;
    now = then;
  }
  return false;
}

}  // namespace

MassProperties mass_of(const Mesh& surface, const FillRegion& region, bool enclosed) {
  const MassProperties exact = mass_properties(surface);
  if (enclosed && surface.closed && count_parts(surface) == 1 && exact.volume > 0.0) return exact;
  const MassProperties by_samples = sampled(region);
  const bool agree = std::abs(exact.volume - by_samples.volume) < kSameVolume * by_samples.volume;
  return enclosed && agree ? exact : by_samples;
}

void match_mass(const MassProperties& whole, TetMesh& mesh) {
  std::vector<double>& volume = mesh.volume;
  if (volume.empty()) {
    volume.assign(mesh.nodes.size(), 0.0);
    for (const Tet& tet : mesh.tets)
      for (const std::uint32_t node : tet) volume[node] += 0.25 * tet_volume(mesh.nodes, tet);
  }
  const double sum = std::accumulate(volume.begin(), volume.end(), 0.0);
  if (!(whole.volume > 0.0) || !(sum > 0.0)) return;
  const dmat3 I = whole.inertia / whole.volume;
  const double trace = 0.5 * (I[0][0] + I[1][1] + I[2][2]), radius = std::sqrt(std::max(trace, 1e-300));
  const dmat3 second = (dmat3(trace) - I) / (radius * radius);
  const Terms wanted{1.0,          0.0,          0.0,          0.0,          second[0][0],
                     second[1][1], second[2][2], second[1][2], second[2][0], second[0][1]};
  std::vector<Terms> terms;
  for (const dvec3 x : mesh.nodes) terms.push_back(terms_of((x - whole.centre) / radius));
  for (const std::size_t n : {kTerms, std::size_t{4}, std::size_t{1}})
    if (match(terms, wanted, n, whole.volume, volume)) return;
}

}  // namespace pliant
