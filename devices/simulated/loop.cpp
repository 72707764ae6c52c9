#include "devices/simulated/loop.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pliant {
namespace {

constexpr double kTooFar = 0.25;          // [m]
constexpr double kTooMuch = 1000.0;       // [1] times the start
constexpr double kAtRest = 1e-9;          // [m] smaller motion counts as rest
constexpr double kSettles = 0.98;         // [1] between quarters
constexpr double kSameTime = 1e-9;        // [s]
constexpr std::size_t kMostDelay = 4096;  // periods

double in_counts(double v, double count) {
  return count > 0.0 ? std::round(v / count) * count : v;
}

// A quarter of the run.
struct Window {
  double low = std::numeric_limits<double>::infinity(), high = -low, speed = 0.0;
  double amplitude() const { return high >= low ? 0.5 * (high - low) : 0.0; }
};

// The loop, one period per step.
class Loop {
 public:
  Loop(const WallLoop& loop, const WallStart& start, const ForceGuard& guard)
      : loop_(loop), guard_(guard), axis_(parameters(loop)) {
    axis_.place(-start.depth);
    axis_.kick(-start.speed);
    last_ = in_counts(-start.depth, loop.plant.encoder) + start.speed * loop.plant.period;
    const double periods = loop.plant.delay / loop.plant.period;
    whole_ = std::min(static_cast<std::size_t>(periods + 1e-9), kMostDelay);
    fraction_ = std::max(0.0, periods - static_cast<double>(whole_)) * loop.plant.period;
    line_.assign(whole_ + 1, 0.0);
  }

  void step() {
    const double T = loop_.plant.period, at = in_counts(axis_.position(), loop_.plant.encoder);
    const double speed = (at - last_) / T;
    last_ = at;
    double force = 0.0;
    if (loop_.both_ways || at < 0.0) force = -loop_.wall.stiffness * at - loop_.wall.damping * speed;
    if (!loop_.both_ways) force = std::max(0.0, force);
    if (guard_) force = guard_(at, force, time_);
    if (loop_.max_force > 0.0) force = std::clamp(force, -loop_.max_force, loop_.max_force);
    line_[next_] = in_counts(force, loop_.force_step);
    next_ = (next_ + 1) % line_.size();
    advance(fraction_);  // still the previous command
    axis_.command(line_[next_]);
    advance(T - fraction_);
    time_ += T;
  }

  const Axis& axis() const { return axis_; }
  double time() const { return time_; }
  double work() const { return work_; }

 private:
  static AxisParameters parameters(const WallLoop& loop) {
    return {.mass = loop.plant.mass,
            .damping = loop.plant.damping,
            .friction = loop.plant.friction,
            .lag = loop.lag,
            .hand = loop.hand};
  }
  // Work of the motor: exact for a constant force, trapezoidal with amplifier lag.
  void advance(double dt) {
    if (!(dt > kSameTime)) return;
    const double from = axis_.position(), force = axis_.motor();
    axis_.advance(dt, {0.0, 0.0, -loop_.push});
    work_ += 0.5 * (force + axis_.motor()) * (axis_.position() - from);
  }

  const WallLoop& loop_;
  const ForceGuard& guard_;
  Axis axis_;
  std::vector<double> line_;  // delayed commands: a ring, the oldest after the newest
  std::size_t next_ = 0, whole_ = 0;
  double fraction_ = 0.0, last_ = 0.0, time_ = 0.0, work_ = 0.0;
};

}  // namespace

const char* name_of(Verdict verdict) {
  return verdict == Verdict::kStable  ? "stable"
         : verdict == Verdict::kCycle ? "limit cycle"
         : verdict == Verdict::kOff   ? "off"
                                      : "divergent";
}

WallResult run_wall(const WallLoop& loop, const WallStart& start, double seconds, const ForceGuard& guard,
                    std::vector<WallSample>* trace) {
  Loop run(loop, start, guard);
  WallResult result;
  // A quarter contains two oscillations of the device on the wall.
  const double swing = 6.283185307179586 * std::sqrt(loop.plant.mass / std::max(loop.wall.stiffness, 1.0));
  const auto quarter =
      std::max<std::size_t>(8, static_cast<std::size_t>(std::max(0.25 * seconds, 2.0 * swing) / loop.plant.period));
  const double begin = std::abs(start.depth) + std::abs(start.speed) * 0.01;
  const double far = loop.both_ways ? kTooMuch * begin : kTooFar;
  Window before, now;
  for (int part = 0; part < 16; ++part) {
    before = now;
    now = {};
    for (std::size_t i = 0; i < quarter; ++i) {
      run.step();
      const double x = run.axis().position();
      now.low = std::min(now.low, x);
      now.high = std::max(now.high, x);
      now.speed = std::max(now.speed, std::abs(run.axis().velocity()));
      result.most_work = std::max(result.most_work, run.work());
      if (trace) trace->push_back({run.time(), x, run.axis().motor()});
      if (!(std::abs(x) < far)) {
        const bool off = guard && x < 0.0 && run.axis().motor() == 0.0;
        result = {off ? Verdict::kOff : Verdict::kDivergent, std::abs(x), now.speed, run.work(), result.most_work};
        return result;
      }
    }
    const double a = now.amplitude(), b = before.amplitude();
    const bool same = a <= b / kSettles && a >= kSettles * b;
    if (a <= kAtRest * (loop.both_ways ? begin * 1e3 : 1.0))
      result.verdict = Verdict::kStable;
    else if (part == 0 || a > b / kSettles)
      result.verdict = Verdict::kDivergent;
    else
      result.verdict = same ? Verdict::kCycle : Verdict::kStable;
    result.amplitude = a;
    result.speed = now.speed;
    if (part >= 3 && a <= kAtRest) break;
    if (part >= 3 && same) break;
    if (part >= 3 && a < 0.5 * b) break;
  }
  result.work = run.work();
  return result;
}

}  // namespace pliant
