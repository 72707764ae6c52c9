#include "devices/simulated/axis.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr double kLongestAxisStep = 1e-4;  // [s] events are detected at its end: two stops within one are missed
constexpr double kEventTime = 1e-9;        // [s]
constexpr int kTerms = 30;
constexpr double kTiny = 1e-17;  // [1] of the state: smaller terms of the series are dropped

}  // namespace

Axis::Axis(const AxisParameters& parameters) : parameters_(parameters) {
  const HandImpedance& hand = parameters.hand;
  const double lighter = hand.holds() ? std::min(parameters.mass, hand.mass) : parameters.mass;
  const double stop_damping = parameters.reach > 0.0 ? parameters.stop_damping : 0.0;
  const double stop_stiffness = parameters.reach > 0.0 ? parameters.stop_stiffness : 0.0;
  const double fastest = std::max({(parameters.damping + stop_damping + hand.grip_damping + hand.arm_damping) / lighter,
                                   std::sqrt((stop_stiffness + hand.grip_stiffness + hand.arm_stiffness) / lighter),
                                   parameters.lag > 0.0 ? 1.0 / parameters.lag : 0.0});
  sub_step_ = fastest > 0.0 ? std::min(kLongestAxisStep, 0.5 / fastest) : kLongestAxisStep;
}

void Axis::place(double position) {
  state_ = {position, 0.0, position, 0.0, 0.0};
  command_ = 0.0;
  sliding_ = 0;
  stop_ = stop_of(state_);
}

void Axis::kick(double velocity) {
  state_[1] = velocity;
  sliding_ = side(velocity);
  stop_ = stop_of(state_);
}

int Axis::stop_of(const State& s) const {
  const AxisParameters& p = parameters_;
  if (!(p.reach > 0.0) || !(std::abs(s[0]) > p.reach)) return 0;
  const int at = side(s[0]);
  return p.stop_stiffness * (std::abs(s[0]) - p.reach) + p.stop_damping * at * s[1] > 0.0 ? at : 0;
}

void Axis::command(double force) {
  command_ = force;
  if (!(parameters_.lag > 0.0)) state_[4] = force;
}

double Axis::energy() const {
  const HandImpedance& hand = parameters_.hand;
  const double stretch = state_[2] - state_[0];
  return 0.5 * (parameters_.mass * state_[1] * state_[1] + hand.mass * state_[3] * state_[3] +
                (hand.holds() ? hand.grip_stiffness * stretch * stretch : 0.0));
}

double Axis::pull(const State& s) const {
  const HandImpedance& hand = parameters_.hand;
  const double stop = stop_ != 0 ? -parameters_.stop_stiffness * (s[0] - stop_ * parameters_.reach) : 0.0;
  return s[4] + stop + (hand.holds() ? hand.grip_stiffness * (s[2] - s[0]) + hand.grip_damping * s[3] : push_);
}

// A s + inputs; `constant`: 1 for the state itself, 0 for its derivatives, where constants vanish.
Axis::State Axis::slope(const State& s, double w, double w_speed, double push, double constant) const {
  const HandImpedance& hand = parameters_.hand;
  State d{};
  double grip = push;  // the hand's force on the device
  if (hand.holds()) {
    grip = hand.grip_stiffness * (s[2] - s[0]) + hand.grip_damping * (s[3] - s[1]);
    d[2] = s[3];
    d[3] = (-grip + hand.arm_stiffness * (w - s[2]) + hand.arm_damping * (w_speed - s[3]) + push) / hand.mass;
  }
  if (!has_friction() || sliding_ != 0) {
    double stop = 0.0;
    if (stop_ != 0)
      stop =
          -parameters_.stop_stiffness * (s[0] - constant * stop_ * parameters_.reach) - parameters_.stop_damping * s[1];
    d[0] = s[1];
    d[1] = (s[4] + stop + grip - parameters_.damping * s[1] - constant * sliding_ * parameters_.friction) /
           parameters_.mass;
  }
  if (parameters_.lag > 0.0) d[4] = (constant * command_ - s[4]) / parameters_.lag;
  return d;
}

Axis::State Axis::solve(const State& s, const Input& input, double dt) const {
  State sum = s, term = slope(s, input.at, input.speed, input.push, 1.0);
  double factor = dt;
  for (int k = 1; k <= kTerms; ++k) {
    bool matters = false;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double add = factor * term[i];
      matters = matters || std::abs(add) > kTiny * std::abs(sum[i]);
      sum[i] += add;
    }
    if (!matters && k > 2) break;
    term = slope(term, k == 1 ? input.speed : 0.0, 0.0, 0.0, 0.0);
    factor *= dt / (k + 1);
  }
  return sum;
}

double Axis::past(const State& s) const {
  return sliding_ != 0 ? -sliding_ * s[1] : std::abs(pull(s)) - parameters_.friction;
}

// The device is at rest: it starts to slide if the force on it exceeds friction.
void Axis::settle_mode() {
  const double now = pull(state_);
  sliding_ = std::abs(now) > parameters_.friction ? side(now) : 0;
}

bool Axis::event(const State& s) const {
  return (has_friction() && past(s) > 0.0) || (parameters_.reach > 0.0 && stop_of(s) != stop_);
}

void Axis::advance(double dt, const AxisWill& will) {
  push_ = will.push;
  Input input{will.from, dt > 0.0 ? (will.to - will.from) / dt : 0.0, will.push};
  if (has_friction() && sliding_ == 0) settle_mode();  // the motor force may have jumped
  for (double left = dt; left > 0.0;) {
    double step = left > 1.5 * sub_step_ ? sub_step_ : left;
    State next = solve(state_, input, step);
    if (event(next)) {
      double before = 0.0, after = step;
      while (after - before > kEventTime) {
        const double middle = 0.5 * (before + after);
        (event(solve(state_, input, middle)) ? after : before) = middle;
      }
      step = after;
      state_ = solve(state_, input, step);
      if (has_friction() && past(state_) > 0.0) {
        state_[1] = 0.0;
        settle_mode();
      }
      stop_ = stop_of(state_);
    } else {
      state_ = next;
    }
    input.at += input.speed * step;
    left -= step;
  }
}

}  // namespace pliant
