// Relaxation of tissue: quasi-linear viscoelasticity with a Prony series (Simo, Computer Methods in Applied Mechanics
// and Engineering 60 (1987); Taylor, Pister and Goudreau 1970). S: the stress of the elastic law, in axes that turn
// with the element. Arm i with share g_i and time tau_i has
//   q_i' = g_i S' - q_i / tau_i,   stress = (1 - sum g_i) S + sum q_i.
// A step of T in which S changes linearly is exact for any T:
//   q_i <- e_i q_i + g_i a_i (S_1 - S_0),   e_i = exp(-T / tau_i),   a_i = (1 - e_i) tau_i / T.
// So the stress at its end is share S_1 + history with
//   share = 1 - sum g_i (1 - a_i),   history = sum e_i q_i - g_i a_i S_0.
// Numbers are stored one by one, whatever component of whatever element they are.
#pragma once

#include <vector>

#include "pliant/parameters.h"

namespace pliant {

class TissueMemory {
 public:
  // `entries` numbers; `factor`: on the shares, of each; empty: 1.
  void set(const Prony& prony, std::size_t entries, std::vector<double> factor);
  const Prony& prony() const { return prony_; }
  bool empty() const { return prony_.count == 0; }

  // S has been this for long.
  void rest(const std::vector<double>& stress);
  // S is this by another law: the arms keep their stress.
  void replace(const std::vector<double>& stress) { before_ = stress; }
  // Prepares share() and history() of a step of T [s]. 0: of the stress now.
  void begin(double T);
  // The same for a load that stays for ever; arms are left out.
  void begin_relaxed();
  double share(std::size_t entry) const { return factor_.empty() ? 1.0 - lost_ : 1.0 - factor_[entry] * lost_; }
  const double* history(std::size_t first) const { return history_.data() + first; }
  // Ends a step of T [s], S now being this; then begin(0).
  void end(const std::vector<double>& stress, double T);

 private:
  double factor(std::size_t entry) const { return factor_.empty() ? 1.0 : factor_[entry]; }

  Prony prony_;
  std::vector<double> factor_;
  std::vector<double> before_, history_;               // [Pa] S_0
  std::array<std::vector<double>, Prony::kMost> arm_;  // [Pa] q_i
  double lost_ = 0.0;                                  // [1] 1 - share, where the factor is 1
};

}  // namespace pliant
