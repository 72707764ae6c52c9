// A contact problem of random contacts that has an answer.
#pragma once

#include <random>

#include "systems/soft/contact/contact_problem.h"

namespace pliant {

inline void set_friction(ContactProblem& p, double mu_static, double mu_sliding) {
  std::fill(p.mu_static.begin(), p.mu_static.end(), mu_static);
  std::fill(p.mu_sliding.begin(), p.mu_sliding.end(), mu_sliding);
}

// W = J J^T of `contacts` random contacts on something with `freedoms` degrees of freedom, approaching or not.
inline ContactProblem random_problem(int contacts, int freedoms, double mu, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  ContactProblem p;
  p.resize(contacts);
  Eigen::MatrixXd J(3 * contacts, freedoms);
  for (double& x : J.reshaped()) x = normal(random) / std::sqrt(double(freedoms));
  p.W = J * J.transpose();
  Vector v(freedoms);  // free motion of the bodies: in J's range, so that a solution exists even if W is singular
  for (double& x : v) x = normal(random);
  p.bias = J * v;
  p.impulse.setZero();
  set_friction(p, mu, mu);
  return p;
}

}  // namespace pliant
