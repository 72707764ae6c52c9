#include "systems/soft/body/two_stages.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/soft/fem/passive_step.h"

namespace pliant {
namespace {

constexpr double kRoot2 = std::numbers::sqrt2;
constexpr double kMostCredit = 0.01;  // [1] of the energy: truncation errors of both signs
constexpr int kMostShortenings = 20;
constexpr double kEnergyRounding = 1e-9;  // [1] of the energy
// [1] of the velocity: bound of the motion by r. Linear stages are stable with contacts for any length of the step; a
// force from elements that the first stage would turn inside out is not.
constexpr double kBend = 0.3;

dvec3 node_of(const Vector& v, std::size_t node) {
  const Eigen::Index i = 3 * static_cast<Eigen::Index>(node);
  return {v[i], v[i + 1], v[i + 2]};
}

void set_node(Vector& v, std::size_t node, dvec3 to) {
  const Eigen::Index i = 3 * static_cast<Eigen::Index>(node);
  v[i] = to.x, v[i + 1] = to.y, v[i + 2] = to.z;
}

Vector node_masses(const Tissue& tissue) {
  Vector out(3 * tissue.moving());
  for (std::uint32_t i = 0; i < tissue.moving(); ++i) out.segment<3>(3 * i).setConstant(tissue.mass()[i]);
  return out;
}

Vector start_of(const Tissue& tissue) {
  Vector out(3 * tissue.moving());
  for (std::uint32_t i = 0; i < tissue.moving(); ++i) set_node(out, i, tissue.velocity()[i]);
  return out;
}

std::vector<dvec3> moved(const Tissue& tissue, const Vector& v, double T) {
  std::vector<dvec3> x = tissue.position();
  for (std::uint32_t i = 0; i < tissue.moving(); ++i) x[i] += T * node_of(v, i);
  return x;
}

Vector drift_of(const Tissue& tissue, const Vector& v) {
  double mass = 0.0;
  dvec3 momentum(0);
  for (std::uint32_t i = 0; i < tissue.moving(); ++i)
    mass += tissue.mass()[i], momentum += tissue.mass()[i] * node_of(v, i);
  Vector out(v.size());
  for (std::uint32_t i = 0; i < tissue.moving(); ++i) set_node(out, i, momentum / mass);
  return out;
}

// Sums over a free body about its centre of mass.
struct Whole {
  dvec3 centre{0}, spin_momentum{0};
  dmat3 inertia{0};
  dvec3 spin(dvec3 momentum) const {
    return glm::determinant(inertia) > 0.0 ? glm::inverse(inertia) * momentum : dvec3(0);
  }
};

Whole whole_of(const Tissue& tissue, const std::vector<dvec3>& x, const Vector& v) {
  Whole out;
  double mass = 0.0;
  for (std::uint32_t i = 0; i < tissue.moving(); ++i) {
    mass += tissue.mass()[i], out.centre += tissue.mass()[i] * x[i];
  }
  out.centre /= mass;
  for (std::uint32_t i = 0; i < tissue.moving(); ++i) {
    const double m = tissue.mass()[i];
    const dvec3 r = x[i] - out.centre;
    out.spin_momentum += m * cross(r, node_of(v, i));
    out.inertia += m * (dot(r, r) * dmat3(1) - glm::outerProduct(r, r));
  }
  return out;
}

}  // namespace

void TwoStages::begin(const Tissue& tissue, double T, dvec3 gravity, const Vector& V1) {
  T_ = T, h_ = kShare * T, gravity_ = gravity;
  begun_ = false;
  alone_ = first_ = free_mean_ = V1;
  loads_ = Vector::Zero(V1.size());
  begin_force_ = tissue.elastic_force().head(V1.size());
}

void TwoStages::restart(Vector& V1) {
  if (begun_) V1 = loaded_;
  loaded_ = V1;
  begun_ = true;
}

void TwoStages::turn(Tissue& tissue, const CoupledSolver& solver, Vector& v) {
  const Eigen::Index rows = v.size();
  first_ = v;
  const BlockMatrix& A = tissue.inner();
  Vector product(rows), contacts = Vector::Zero(rows);
  if (loaded_ != alone_) A.multiply(loaded_ - alone_, loads_);
  if (first_ != loaded_) A.multiply(first_ - loaded_, contacts);
  A.multiply(first_, product);  // M v0 + h f(x0) + loads and contacts

  const std::vector<dvec3> begin = tissue.position();
  tissue.position() = moved(tissue, first_, kRoot2 * h_);
  tissue.find_forces();
  const Vector change = tissue.elastic_force().head(rows) - begin_force_;
  tissue.position() = begin;

  const Vector mass = node_masses(tissue);
  const Vector m_v = mass.cwiseProduct(first_);
  Rows right(rows, 2);
  right.col(0) = product - 2.0 * contacts + kRoot2 * (m_v - mass.cwiseProduct(start_of(tissue)));
  const TissueMaterial& material = tissue.material();
  const Vector linear =  // - sqrt2 h K' V1
      -kRoot2 / h_ * (product - (1.0 + h_ * material.alpha) * m_v) / (1.0 + material.beta / h_);
  right.col(0) += h_ * linear;
  right.col(1) = h_ * (even_damping_ ? 1.0 + kRoot2 : 1.0) * (change - linear);
  solver.solve(right);
  const auto size = [&](const Vector& u) { return std::sqrt(mass.cwiseProduct(u).dot(u)); };
  const double bend = size(right.col(1)), most = kBend * (size(first_) + size(start_of(tissue)));
  free_mean_ = 0.5 * (first_ + right.col(0) + (bend > most ? most / bend : 1.0) * right.col(1));
  v = free_mean_;
}

Vector TwoStages::ending(const Vector& w) const {
  return (2.0 + kRoot2) * w - (1.0 + kRoot2) * first_;
}

// The mean elastic force of the stages is that at their mean place.
Vector TwoStages::force_lag(const Vector& w) const {
  return 0.5 * kShare * first_ + 0.25 * kRoot2 * (2.0 * w - first_);
}

Vector TwoStages::impulses(const Tissue& tissue, const Vector& w) const {
  Vector out(w.size());
  tissue.inner().multiply(w - free_mean_, out);
  out = (out + loads_) / kShare;
  for (std::uint32_t i = 0; i < tissue.moving(); ++i)
    set_node(out, i, node_of(out, i) + T_ * tissue.mass()[i] * gravity_);
  return out;
}

TwoStages::End TwoStages::finish(const Tissue& tissue, const Vector& w, double share, bool free) {
  const Vector mass = node_masses(tissue), v0 = start_of(tissue), push = impulses(tissue, w);
  const auto kinetic = [&](const Vector& v) { return 0.5 * mass.cwiseProduct(v).dot(v); };
  const double before = kinetic(v0) + tissue.elastic_energy();
  const double own_energy = free ? before - kinetic(drift_of(tissue, v0)) : before;
  const double spare = before + std::min(credit_, kMostCredit * own_energy);
  End end{w, ending(w)};

  // Motion into more elastic energy than there is is shortened, as in passive_step.h.
  const Vector drift = free ? drift_of(tissue, w) : Vector(Vector::Zero(w.size()));
  const double rounding = kEnergyRounding * before + energy_rounding(tissue);
  double left = 0.0, scale = 1.0;  // [J] for the end's velocity
  for (int i = 0; i < kMostShortenings; ++i) {
    left = spare + push.dot(end.motion) - tissue.elastic_energy(moved(tissue, end.motion, share * T_));
    if (left >= -rounding) break;
    scale *= 0.5;
    end.motion = drift + scale * (w - drift);
    end.shortened = true;
  }

  // Internal forces do not change the velocity of the centre of mass, and in free flight the spin's momentum.
  Vector kept = free ? drift_of(tissue, end.velocity) : drift;
  Vector own = end.velocity - kept;
  if (free && !end.shortened && share == 1.0 && w == free_mean_ && loaded_ == alone_) {
    const std::vector<dvec3> x1 = moved(tissue, w, T_);
    const Whole now = whole_of(tissue, x1, end.velocity);
    const double braked = T_ * tissue.material().alpha;  // by damping of mass
    const dvec3 momentum =
        (1.0 - braked * (1.0 - 0.5 * braked)) * whole_of(tissue, tissue.position(), v0).spin_momentum;
    const dvec3 was = now.spin(now.spin_momentum), spin = now.spin(momentum);
    Vector turning = kept;
    for (std::uint32_t i = 0; i < tissue.moving(); ++i) {
      const dvec3 arm = x1[i] - now.centre;
      set_node(turning, i, node_of(kept, i) + cross(spin, arm));
      set_node(own, i, node_of(own, i) - cross(was, arm));
    }
    if (kinetic(turning) <= left)
      kept = turning;
    else
      own = end.velocity - kept;
  }
  left = std::max(left, 0.0);
  if (const double energy = kinetic(kept); energy > left) kept *= std::sqrt(left / energy);
  const double rest = left - kinetic(kept), moving = kinetic(own);
  const double part = std::min(scale, moving > rest ? std::sqrt(std::max(rest, 0.0) / moving) : 1.0);
  end.velocity = kept + part * own;
  credit_ = std::clamp(rest - part * part * moving, 0.0, kMostCredit * own_energy);
  return end;
}

}  // namespace pliant
