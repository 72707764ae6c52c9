// A hand on the vertical axis: a mass on a spring and a damper, integrated exactly for a constant force. Any chatter is
// then due to the force, not to the integration.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>

namespace pliant {

struct ExactHand {
  double mass = 0.15, damping = 5.0, stiffness = 300.0;  // [kg], [N s/m], [N/m]
  double y = 0.01, v = 0.0, work = 0.0;                  // [m], [m/s], [J] done by the force on it

  // `wants` [m]: equilibrium position without a force.
  void step(double force, double wants, double dt) {
    using Complex = std::complex<double>;
    const double rest = wants + force / stiffness, from = y;
    const Complex half = 0.5 * damping / mass, root = std::sqrt(half * half - stiffness / mass) + Complex(0, 1e-9);
    const Complex p = -half + root, q = -half - root;
    const Complex b = (v - p * (y - rest)) / (q - p), a = y - rest - b;
    const Complex at = a * std::exp(p * dt), bt = b * std::exp(q * dt);
    y = rest + (at + bt).real();
    v = (p * at + q * bt).real();
    work += force * (y - from);
  }
};

// Statistics of the forces written to a device over some time.
struct Written {
  int writes = 0, zeros = 0;
  double error = 0.0, step = 0.0;  // [N] largest: deviation from the wanted force, and change between writes
  double mean = 0.0, wanted = 0.0;

  // In contact. `almost` [1] of the wanted force: a smaller one counts as zero.
  void add(double force, double before, double desired, double almost = 0.0) {
    ++writes;
    zeros += force <= almost * desired;
    error = std::max(error, std::abs(force - desired));
    step = std::max(step, std::abs(force - before));
    mean += force, wanted += desired;
  }
};

}  // namespace pliant
