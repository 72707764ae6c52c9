// One axis of a device in a hand, in continuous time:
//   m x'' = F - b x' - c sign(x') + k_g (y - x) + b_g (y' - x')                the device; F its motor's force
//   m_h y'' = k_g (x - y) + b_g (x' - y') + k_a (w - y) + b_a (w' - y') + p    the hand; w, p: its intention
//   tau F' = u - F                                                             the amplifier; u constant between calls
// At an end stop, |x| > l, a spring and a damper push the device back, and never pull: k_s (|x| - l) + b_s |x|' > 0.
// Between events this is linear; its exact solution is summed as a Taylor series over sub-steps, to rounding. Coulomb
// friction switches it. Events are: the device stops; the force on a resting device exceeds c; a stop begins or ceases
// to push. They are found by bisection to a nanosecond, so that stiction is exact. The alternative, a steep viscous law
// with a smoothed sign, creeps where a device should rest, and hides limit cycles.
#pragma once

#include <array>

#include "devices/simulated/hand.h"

namespace pliant {

struct AxisParameters {
  double mass = 0.1;                                // [kg] of the effector, reflected
  double damping = 0.0;                             // [N s/m] its own
  double friction = 0.0;                            // [N] Coulomb's, kinetic = static
  double lag = 0.0;                                 // [s] time constant of the amplifier; 0: none
  double reach = 0.0;                               // [m] l: end stops on both sides of zero; 0: none
  double stop_stiffness = 0.0, stop_damping = 0.0;  // [N/m], [N s/m]
  HandImpedance hand;
};

// The hand's intention while an axis advances.
struct AxisWill {
  double from = 0.0, to = 0.0;  // [m] target of the arm's spring at the start and end; linear in between
  double push = 0.0;            // [N] on the hand; without a hand, on the device
};

class Axis {
 public:
  explicit Axis(const AxisParameters& parameters);

  // At rest at `position`, including the hand; zero force.
  void place(double position);
  void kick(double velocity);
  // `force` [N] is the motor command from now on, through the amplifier.
  void command(double force);
  void advance(double dt, const AxisWill& will = {});

  double position() const { return state_[0]; }
  double velocity() const { return state_[1]; }
  double hand_position() const { return state_[2]; }
  double motor() const { return state_[4]; }   // [N] current motor force
  bool stopped() const { return stop_ != 0; }  // in contact with an end stop
  bool sticks() const { return has_friction() && sliding_ == 0; }
  double energy() const;  // [J] kinetic energy, and that of the grip's spring

 private:
  using State = std::array<double, 5>;  // x, x', y, y', F
  struct Input {
    double at = 0.0, speed = 0.0, push = 0.0;  // w = at + speed t
  };

  static int side(double v) { return v > 0.0 ? 1 : v < 0.0 ? -1 : 0; }
  bool has_friction() const { return parameters_.friction > 0.0; }
  State slope(const State& s, double w, double w_speed, double push, double constant) const;
  State solve(const State& s, const Input& input, double dt) const;
  double pull(const State& s) const;  // [N] on a device at rest, without friction
  // > 0: the mode has ended before this state.
  double past(const State& s) const;
  void settle_mode();
  int stop_of(const State& s) const;  // the side of the active stop; 0: none
  bool event(const State& s) const;   // a mode has ended before this state

  AxisParameters parameters_;
  double sub_step_;  // [s] short relative to every time constant
  State state_{};
  double command_ = 0.0;  // [N]
  double push_ = 0.0;     // [N] during advance()
  int stop_ = 0;          // the side of the active stop; 0: none
  int sliding_ = 0;       // sign of the velocity; 0: at rest, or no friction
};

}  // namespace pliant
