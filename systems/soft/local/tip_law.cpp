#include "systems/soft/local/tip_law.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr int kTipSteps = 40;        // of Newton's method: quadratic, from below
constexpr double kTipExact = 1e-12;  // [1]
constexpr double kLeastTip = 1e-3;   // [1] of R: contact radius of an unloaded tip
constexpr double kPositive = 1e-9;   // [1] of the largest compliance: negative eigenvalues that are rounding
constexpr double kAt[4] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
constexpr double kWeight[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};

}  // namespace

double hertz_radius(double force, double tip_radius, double reduced) {
  return std::cbrt(0.75 * std::max(0.0, force) * tip_radius / reduced);
}

TipState tip_law(const SmearedLoad& tip, double force, const LocalElasticity& tissue, const LayerKernel& layer) {
  if (tip.spring.of) {
    const double depth = tip.spring.depth(force);
    return {depth, 1 / tip.spring.slope(depth), 0.0};
  }
  const LocalPlace& at = tip.place;
  const double reduced = tissue.reduced(),
               widest = std::min(tip.pair_radius, kWidestTip * at.smeared / at.lattice.normal);
  const bool thin = at.thickness > 0.0;
  const double share = at.lattice.normal * (thin ? layer.share(at.smeared, at.thickness) : 1.0) / at.smeared;
  const double own = hertz_radius(force, tip.tip_radius, reduced), a = std::min(own, widest);
  double depth = a * a / tip.tip_radius, factor = 1.0;  // D(F(a)) = int 2 a / (R_s kappa) da
  if (thin && a > 0.0) {
    depth = 0.0;
    for (int i = 0; i < 4; ++i)
      depth += kWeight[i] * 2 * kAt[i] * a * a / (tip.tip_radius * layer.punch(kAt[i] * a / at.thickness));
    factor = layer.punch(a / at.thickness);
  }
  const double until = 4.0 / 3.0 * reduced * a * a * a / tip.tip_radius;
  const double slope = a > 0.0 ? 1 / (2 * reduced * a * factor) : 1e300;
  TipState out;
  out.radius = a;
  out.depth = depth - share * force / (2 * reduced);
  if (own > widest) out.depth += slope * (force - until);
  out.slope = slope - share / (2 * reduced);
  return out;
}

namespace {

// The place of a contact's own part: a tip's at its tip_force.
LocalPlace own_place(const SmearedLoad& load, const LocalElasticity& tissue, const LayerKernel& layer) {
  LocalPlace out = load.place;
  if (load.tip_radius > 0.0)
    out.own = std::max(tip_law(load, load.tip_force, tissue, layer).radius, kLeastTip * out.smeared);
  return out;
}

}  // namespace

namespace {

// [m/N] Along the normal, of a DentSpring.
double spring_compliance(const SmearedLoad& load) {
  if (!(load.tip_radius > 0.0)) return load.spring.secant_compliance();
  return 1 / load.spring.slope(load.spring.depth(load.tip_force));
}

// Along the surfaces by Cerruti's ratio of a half-space's compliances, of the law at small depth.
Block block_of_spring(dvec3 at_i, dvec3 at_j, double normal, double first, double poisson) {
  const auto vector = [](dvec3 n) { return Eigen::Vector3d(n.x, n.y, n.z); };
  const Eigen::Vector3d i = vector(at_i), j = vector(at_j);
  const Block flat_i = Block::Identity() - i * i.transpose(), flat_j = Block::Identity() - j * j.transpose();
  return normal * i * j.transpose() + (2 - poisson) / (2 * (1 - poisson)) * first * flat_i * flat_j;
}

LocalPlace pair_place(const SmearedLoad& load) {
  LocalPlace out = load.place;
  out.own = load.pair_radius;
  return out;
}

}  // namespace

Block self_compliance(const SmearedLoad& load, const LocalElasticity& tissue, const LayerKernel& layer) {
  if (load.spring.of)
    return block_of_spring(load.place.normal, load.place.normal, spring_compliance(load),
                           load.spring.first_compliance(), tissue.poisson);
  return local_self_compliance(own_place(load, tissue, layer), tissue, &layer);
}

Block pair_compliance(const SmearedLoad& i, const SmearedLoad& j, const LocalElasticity& tissue,
                      const LayerKernel& layer) {
  if (!i.spring.of || !j.spring.of) return local_compliance(pair_place(i), pair_place(j), tissue, &layer);
  const dvec3 apart = i.place.at - j.place.at;
  const double shared = i.spring.of->shared.at(dot(apart, apart)) * std::max(0.0, dot(i.place.normal, j.place.normal));
  return block_of_spring(i.place.normal, j.place.normal,
                         shared * std::sqrt(spring_compliance(i) * spring_compliance(j)),
                         shared * std::sqrt(i.spring.first_compliance() * j.spring.first_compliance()), tissue.poisson);
}

double tip_offset(const SmearedLoad& load, const LocalElasticity& tissue, const LayerKernel& layer) {
  if (!(load.tip_radius > 0.0)) return 0.0;
  const TipState at = tip_law(load, load.tip_force, tissue, layer);
  const double slope =
      load.spring.of ? at.slope : local_normal_compliance(own_place(load, tissue, layer), tissue, &layer);
  return at.depth - slope * load.tip_force;
}

void make_positive(Eigen::MatrixXd& compliance) {
  Eigen::MatrixXd lifted = compliance;
  lifted.diagonal().array() += kPositive * compliance.diagonal().maxCoeff();
  if (Eigen::LLT<Eigen::MatrixXd>(lifted).info() == Eigen::Success) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(compliance);
  compliance = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
}

namespace {

// By the spring's own depth, which a law that flattens has at every force.
double spring_force(const DentSpringAt& spring, double compliance, double depth) {
  double low = 0.0, high = depth, at = depth;
  for (int i = 0; i < kTipSteps && compliance > 0.0; ++i) {
    const double over = at + compliance * spring.force(at) - depth;
    (over > 0.0 ? high : low) = at;
    const double next = at - over / (1 + compliance * spring.slope(at)), last = at;
    at = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(at - last) <= kTipExact * depth) break;
  }
  return std::max(0.0, spring.force(at));
}

}  // namespace

double tip_force(const SmearedLoad& tip, double compliance, double depth, const LocalElasticity& tissue,
                 const LayerKernel& layer) {
  if (tip.spring.of) return spring_force(tip.spring, compliance, depth);
  // delta is concave: from any start the next iterate is below the root, from there on they ascend.
  double force = 4.0 / 3.0 * tissue.reduced() * std::sqrt(tip.tip_radius) * std::pow(depth, 1.5);
  for (int i = 0; i < kTipSteps; ++i) {
    const TipState at = tip_law(tip, force, tissue, layer);
    const double by = (depth - at.depth - compliance * force) / (at.slope + compliance);
    const double next = std::max(force + by, 1e-3 * force);
    if (std::abs(next - force) <= kTipExact * force) return next;
    force = next;
  }
  return force;
}

}  // namespace pliant
