#include "systems/touch/model/contact_energy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "components/registered.h"
#include "systems/touch/model/shape.h"

namespace pliant {
namespace {

double wendland(double q) {
  if (q >= 1) return 0.0;
  const double w = 1 - q, w2 = w * w;
  return w2 * w2 * (4 * q + 1);
}

// (dc/dr) / r for c(r / a), without dividing by r: dc/dq = -20 q (1-q)^3.
double wendland_slope(double r, double a) {
  const double w = std::max(0.0, 1 - r / a);
  return -20 * w * w * w / (a * a);
}

// Regularisation of the diagonal for overlapping contacts: equal ones share the load evenly, at a millionth of the
// force.
constexpr double kEven = 1e-6;
constexpr int kMostPivots = 60;

// A of two contacts in one dent and its derivatives, by m and by the kernel's q (SharedDent).
struct DentOverlap {
  double value, by_m, by_q;
};
DentOverlap dent_overlap(double m, double q) {
  const double a = 1 - m, b = 1 - q, below = a + b - a * b;
  if (!(below > 1e-12)) return {1.0, 0.0, 0.0};
  return {1 - a * b / below, (b / below) * (b / below), (a / below) * (a / below)};
}

// The linear complementarity problem A l >= e, l >= 0 by block principal pivoting (Judice & Pires 1994). Exact; needs
// one factorisation if the active set is the last tick's. Falls back to single pivots, which always terminate.
class Loads {
 public:
  Loads(std::span<LoadedContact> contacts, const ShareKernel& kernel, std::span<const SharedDent> dents)
      : contacts_(contacts), n_(contacts.size()) {
    const double outer2 = kernel.outer * kernel.outer;
    std::array<dvec3, kMaxLoaded> p;
    for (std::size_t i = 0; i < n_; ++i) {
      e_[i] = std::sqrt(2 * contacts[i].energy);
      p[i] = contacts[i].p;
      if (contacts[i].load > 0) pressing_ |= bit(i);
      for (std::size_t j = 0; j < i; ++j) {
        const dvec3 d = p[i] - p[j];
        const double r2 = dot(d, d);
        double a = 0.0;
        if (!(r2 >= outer2)) {
          const double facing = dot(contacts[i].normal, contacts[j].normal);
          if (facing > 0) a = kernel.at(r2) * facing;
        }
        A_[i][j] = A_[j][i] = a;
        if (a != 0.0) couple(i, j);
      }
      A_[i][i] = 1.0;
    }
    for (const SharedDent& dent : dents) {
      const double q = A_[dent.a][dent.b];
      A_[dent.a][dent.b] = A_[dent.b][dent.a] = dent_overlap(dent.part, q).value;
      couple(dent.a, dent.b);
    }
    for (std::size_t i = 0; i < n_; ++i)
      for_coupled(i, [&](std::size_t j) { even_[i] = std::max(even_[i], kEven * A_[i][j] * A_[i][j]); });
    if (pressing_ == 0) pressing_ = n_ == 64 ? ~std::uint64_t{0} : bit(n_) - 1;
  }

  void solve() {
    std::size_t fewest = n_ + 1;
    int patience = 8;
    for (int pivot = 0; pivot < kMostPivots; ++pivot) {
      factor_and_solve();
      std::uint64_t wrong = 0;
      for (std::size_t i = 0; i < n_; ++i) {
        const bool presses = pressing_ & bit(i);
        if (presses ? l_[i] < 0 : shortfall(i) > 1e-12 * e_[i]) wrong |= bit(i);
      }
      if (wrong == 0) break;
      const auto count = static_cast<std::size_t>(std::popcount(wrong));
      if (count < fewest) {
        fewest = count;
        patience = 8;
      } else if (--patience < 0) {
        wrong = std::bit_floor(wrong);  // Murty: flip only the last wrong one
      }
      pressing_ ^= wrong;
      if (pressing_ == 0) pressing_ = std::bit_floor(wrong);
    }
    // A load is at most e, since no entry of A is negative; where a pivot was clamped it would be more. NaN stays NaN.
    for (std::size_t i = 0; i < n_; ++i) contacts_[i].load = l_[i] < 0.0 ? 0.0 : l_[i] > e_[i] ? e_[i] : l_[i];
  }

  double overlap(std::size_t i, std::size_t j) const { return A_[i][j]; }
  // The other contacts whose dents overlap with that of i, ascending.
  template <class Visit>
  void for_coupled(std::size_t i, Visit visit) const {
    for (std::uint64_t bits = coupled_[i]; bits; bits &= bits - 1)
      visit(static_cast<std::size_t>(std::countr_zero(bits)));
  }
  double strength(std::size_t i) const { return e_[i]; }

 private:
  static std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << i; }

  void couple(std::size_t i, std::size_t j) {
    coupled_[i] |= bit(j);
    coupled_[j] |= bit(i);
  }

  double shortfall(std::size_t i) const {  // of one that does not press
    double r = e_[i];
    for_coupled(i, [&](std::size_t j) { r -= A_[i][j] * l_[j]; });
    return r;
  }

  // A l = e over the pressing contacts, by Cholesky within the envelope: distant contacts are not coupled.
  void factor_and_solve() {
    std::array<std::size_t, kMaxLoaded> at;
    std::size_t m = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      l_[i] = 0.0;
      if (pressing_ & bit(i)) at[m++] = i;
    }
    std::array<std::size_t, kMaxLoaded> first;  // column of each row's first entry
    for (std::size_t i = 0; i < m; ++i) {
      first[i] = 0;
      while (first[i] < i && !(coupled_[at[i]] & bit(at[first[i]]))) ++first[i];
      for (std::size_t j = first[i]; j <= i; ++j) {
        double sum = A_[at[i]][at[j]] + (i == j ? even_[at[i]] : 0.0);
        for (std::size_t k = std::max(first[i], first[j]); k < j; ++k) sum -= L_[i][k] * L_[j][k];
        // Normals that differ much can make A slightly indefinite: the pivot of such a contact is clamped.
        L_[i][j] = i == j ? std::sqrt(std::max(sum, kEven)) : sum / L_[j][j];
      }
    }
    std::array<double, kMaxLoaded> y;
    for (std::size_t i = 0; i < m; ++i) {
      double sum = e_[at[i]];
      for (std::size_t k = first[i]; k < i; ++k) sum -= L_[i][k] * y[k];
      y[i] = sum / L_[i][i];
    }
    for (std::size_t i = m; i-- > 0;) {
      y[i] /= L_[i][i];
      for (std::size_t k = first[i]; k < i; ++k) y[k] -= L_[i][k] * y[i];
      l_[at[i]] = y[i];
    }
  }

  std::span<LoadedContact> contacts_;
  std::size_t n_;
  std::uint64_t pressing_ = 0;
  std::array<std::array<double, kMaxLoaded>, kMaxLoaded> A_, L_;
  std::array<double, kMaxLoaded> e_, l_{}, even_{};
  std::array<std::uint64_t, kMaxLoaded> coupled_{};
};

}  // namespace

double ShareKernel::at(double r2) const {
  if (r2 >= outer * outer) return 0.0;
  const double r = std::sqrt(r2);
  return weight * wendland(r / inner) + (1 - weight) * wendland(r / outer);
}

double ShareKernel::slope(double r2) const {
  if (r2 >= outer * outer) return 0.0;
  const double r = std::sqrt(r2);
  return weight * wendland_slope(r, inner) + (1 - weight) * wendland_slope(r, outer);
}

namespace {

// The mixture with the smallest maximum error against the positive part of a shape, given as value over u = (r / R)^2 <
// 1.
template <class Value>
ShareKernel fitted_kernel(const Value& value) {
  constexpr int kPlaces = 64;
  std::array<double, kPlaces> wanted;
  const auto rho = [](int i) { return 1.5 * i / kPlaces; };
  for (int i = 0; i < kPlaces; ++i) wanted[i] = rho(i) < 1.0 ? std::max(0.0, value(rho(i) * rho(i))) : 0.0;
  ShareKernel best;
  double least = std::numeric_limits<double>::max();
  for (int a = 6; a <= 20; ++a)
    for (int b = a; b <= 30; ++b)
      for (int w = 0; w <= 20; ++w) {
        const ShareKernel kernel{0.05 * w, 0.05 * a, 0.05 * b};
        double most = 0.0;
        for (int i = 0; i < kPlaces && most < least; ++i)
          most = std::max(most, std::abs(kernel.at(rho(i) * rho(i)) - wanted[i]));
        if (most < least) least = most, best = kernel;
      }
  return best;
}

}  // namespace

ShareKernel share_kernel(Shape shape, double reach, double volume, double contact) {
  const auto fitted = [reach](const auto& value) {
    const ShareKernel found = fitted_kernel(value);
    return ShareKernel{found.weight, found.inner * reach, found.outer * reach};
  };
  if (const ShapeFunction* own = registered_shape(shape)) return fitted([own](double u) { return own->value(u); });
  const auto& [weight, inner, outer, weight_by, inner_by, outer_by] = row_of(shape).kernel;
  if (outer == 0.0 || (std::abs(contact - 0.2) > 1e-6 && depends_on_contact(shape))) {
    FieldSource source;
    source.amplitude = 1.0f;
    source.shape = shape;
    source.parameter = shape_parameter(shape, contact, 1.0, volume);
    return fitted([&source](double u) {
      return static_cast<double>(share_at(source, {static_cast<float>(std::sqrt(u)), 0, 0}, source.normal));
    });
  }
  return {weight + weight_by * volume, (inner + inner_by * volume) * reach, (outer + outer_by * volume) * reach};
}

double share_load(std::span<LoadedContact> contacts, const ShareKernel& kernel, std::span<SharedDent> dents) {
  if (contacts.size() == 1) {
    LoadedContact& only = contacts[0];
    only.load = std::sqrt(2 * only.energy);
    only.share = 1.0;
    only.force = only.pull;
    return only.energy;
  }
  Loads loads(contacts, kernel, dents);
  loads.solve();
  const auto by_kernel = [&](std::size_t i, std::size_t j, double q) {  // dA/dq
    for (const SharedDent& dent : dents)
      if ((dent.a == i && dent.b == j) || (dent.a == j && dent.b == i)) return dent_overlap(dent.part, q).by_q;
    return 1.0;
  };
  double energy = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    LoadedContact& a = contacts[i];
    if (!std::isfinite(a.load)) {
      a.load = 0.0;
      energy = std::numeric_limits<double>::quiet_NaN();
    }
    a.share = a.load > 0 ? a.load / loads.strength(i) : 0.0;
    a.force = a.share * a.pull;
    energy += loads.strength(i) * a.load - 0.5 * a.load * a.load;
    if (!(a.load > 0)) continue;
    loads.for_coupled(i, [&](std::size_t j) {
      const LoadedContact& b = contacts[j];
      if (!(b.load > 0) || loads.overlap(i, j) == 0.0) return;
      const double facing = dot(a.normal, b.normal);
      const dvec3 d = a.p - b.p;
      const double r2 = dot(d, d), phi = kernel.at(r2);
      if (j < i) energy -= a.load * b.load * loads.overlap(i, j);
      if (facing > 0)
        a.force +=
            a.load * b.load * by_kernel(i, j, phi * facing) *
            (facing * kernel.slope(r2) * (glm::transpose(a.moves) * d) + phi * (glm::transpose(a.turns) * b.normal));
    });
  }
  for (SharedDent& dent : dents) {
    LoadedContact &a = contacts[dent.a], &b = contacts[dent.b];
    const dvec3 d = a.p - b.p;
    const double q = std::max(0.0, dot(a.normal, b.normal)) * kernel.at(dot(d, d));
    dent.pull = a.load * b.load * dent_overlap(dent.part, q).by_m;
    const dvec3 force = 0.5 * dent.pull * dent.slope;
    a.force += force;
    b.force += force;
  }
  return energy;
}

}  // namespace pliant
