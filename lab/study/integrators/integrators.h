// Time steps of one vertex's equation, m h'' = -b h' - k F(h) - q (methods.md 1.1, 1.2), in double: textbook schemes
// and the engine's. Only the standard linear solid has an arm:
//   q' = k1 h' - q / tau.
// Legend: h height [m], v = h' [m/s], q force of the arm [N], T step [s], d = h1 - h0 [m].
#pragma once

#include <array>
#include <vector>

#include "components/height_field.h"
#include "systems/touch/model/local_model.h"

namespace pliant {

enum class Integrator {
  kExplicit,          // forward Euler
  kSemiImplicit,      // symplectic Euler: the new velocity moves the height
  kImplicit,          // backward Euler
  kRungeKutta,        // classic, of order 4
  kMidpoint,          // implicit
  kDiscreteGradient,  // passive for any step
  kExact,             // matrix exponential: of the linear laws, or of a nonlinear law's tangent at h0 (Rosenbrock)
  kEngine,            // the engine's zone kernel: exact, or discrete gradient and backward Euler; single precision
};
// The laws whose vertex the integrators step: no table, none that stiffens and relaxes.
inline constexpr std::array kIntegratedLaws{SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential,
                                            SpringLaw::kStandardLinearSolid};
inline constexpr std::array kIntegrators{
    Integrator::kExplicit, Integrator::kSemiImplicit,     Integrator::kImplicit, Integrator::kRungeKutta,
    Integrator::kMidpoint, Integrator::kDiscreteGradient, Integrator::kExact,    Integrator::kEngine};
const char* name_of(Integrator integrator);

struct VertexState {
  double h = 0.0, v = 0.0, q = 0.0;
};

struct VertexProblem {
  RestoringLaw law;
  double m = 1e-3, b = 0.0, k = 1.0;  // [kg] [N s/m] [N/m]
  double k1 = 0.0, tau = 1.0;         // [N/m] [s] of the arm; k1 0: no arm
  bool solid() const { return law.kind == SpringLaw::kStandardLinearSolid; }
};
// This law with a Deformable's default parameters, stiffness k and damping ratio zeta.
VertexProblem vertex_problem(SpringLaw law, double k, double zeta);

// Steps of T [s] for vertices in the same state; with kEngine, for a whole zone.
class VertexStepper {
 public:
  VertexStepper(Integrator integrator, const VertexProblem& problem, double T, std::size_t vertices = 1);
  void begin(VertexState state);
  void step(int steps = 1);
  VertexState state() const { return states_[0]; }  // kEngine: h only
  std::size_t vertices() const { return states_.size(); }

 private:
  Integrator integrator_;
  VertexProblem problem_;
  double T_;
  std::array<std::array<double, 3>, 3> solid_{};
  StepCoefficients linear_;
  std::vector<VertexState> states_;
  Motion motion_;
  HeightField field_;
};

// Heights at 0, dt, 2 dt, ...: `count` of them after the first, released from rest at `height`. By the closed form for
// linear laws, else by Runge-Kutta with steps short enough to be exact.
std::vector<double> true_heights(const VertexProblem& problem, double height, double dt, int count);

}  // namespace pliant
