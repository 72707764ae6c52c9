#include "systems/soft/fem/tissue_memory.h"

#include <cmath>

namespace pliant {
namespace {

// a_i of a step of T.
double arm_slope(double T, double time) {
  const double steps = T / time;
  return steps > 0.0 ? -std::expm1(-steps) / steps : 1.0;
}

}  // namespace

void TissueMemory::set(const Prony& prony, std::size_t entries, std::vector<double> factor) {
  prony_ = prony;
  if (empty()) entries = 0;
  factor_ = entries == 0 ? std::vector<double>() : std::move(factor);
  before_.assign(entries, 0.0), history_.assign(entries, 0.0);
  for (std::size_t i = 0; i < Prony::kMost; ++i) arm_[i].assign(i < prony.count ? entries : 0, 0.0);
  lost_ = 0.0;
}

void TissueMemory::rest(const std::vector<double>& stress) {
  before_ = stress;
  for (std::vector<double>& arm : arm_) arm.assign(arm.size(), 0.0);
  begin(0.0);
}

void TissueMemory::begin(double T) {
  lost_ = 0.0;
  double now = 0.0;
  std::array<double, Prony::kMost> stays{};
  for (std::size_t i = 0; i < prony_.count; ++i) {
    const Prony::Arm& arm = prony_.arms[i];
    const double slope = arm_slope(T, arm.time);
    lost_ += arm.share * (1.0 - slope);
    now += arm.share * slope;
    stays[i] = std::exp(-T / arm.time);
  }
  for (std::size_t n = 0; n < history_.size(); ++n) history_[n] = -factor(n) * now * before_[n];
  for (std::size_t i = 0; i < prony_.count; ++i)
    for (std::size_t n = 0; n < history_.size(); ++n) history_[n] += stays[i] * arm_[i][n];
}

void TissueMemory::begin_relaxed() {
  lost_ = 1.0 - prony_.remains();
  history_.assign(history_.size(), 0.0);
}

void TissueMemory::end(const std::vector<double>& stress, double T) {
  for (std::size_t i = 0; i < prony_.count; ++i) {
    const Prony::Arm& arm = prony_.arms[i];
    const double stays = std::exp(-T / arm.time), gain = arm.share * arm_slope(T, arm.time);
    for (std::size_t n = 0; n < stress.size(); ++n)
      arm_[i][n] = stays * arm_[i][n] + gain * factor(n) * (stress[n] - before_[n]);
  }
  before_ = stress;
  begin(0.0);
}

}  // namespace pliant
