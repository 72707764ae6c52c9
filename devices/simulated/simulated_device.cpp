#include "devices/simulated/simulated_device.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "runtime/clock.h"

namespace pliant {
namespace {

constexpr double kLongestCatchUp = 0.5;  // [s] of motion simulated after a pause of the reader; the rest is skipped
constexpr double kSameInstant = 1e-9;    // [s]

double wall() {
  return static_cast<double>(now_ns()) * 1e-9;
}

// A rotation vector as a rotation.
dquat turned(dvec3 by) {
  const double angle = length(by);
  return angle > 0.0 ? glm::angleAxis(angle, by / angle) : dquat(1, 0, 0, 0);
}

// Saturates the norm, so that the direction is kept. A non-finite value gives zero.
dvec3 saturated(dvec3 wanted, double most) {
  const double size = length(wanted);
  if (!std::isfinite(size)) return dvec3(0);
  return size > most ? wanted * (most / size) : wanted;
}

dvec3 in_counts(dvec3 v, double count) {
  return count > 0.0 ? glm::round(v / count) * count : v;
}

}  // namespace

SimulatedDevice::SimulatedDevice(SimulatedOptions options) : options_(std::move(options)), configured_(true) {}

Status SimulatedDevice::open(const std::string& id) {
  if (!configured_) {
    Result<SimulatedOptions> options = parse_simulated(id);
    if (!options) return options.error();
    options_ = std::move(options).value();
  }
  begin();
  return Done{};
}

void SimulatedDevice::begin() {
  const DeviceProfile& profile = options_.profile;
  AxisParameters axis;
  axis.mass = profile.mass;
  axis.damping = profile.damping;
  axis.friction = profile.friction;
  axis.lag = profile.lag;
  axis.hand = options_.hand;
  axis.stop_stiffness = kStopStiffness;
  axis.stop_damping = 2.0 * kStopDampingRatio * std::sqrt(kStopStiffness * profile.mass);
  axes_.clear();
  for (int i = 0; i < 3; ++i) {
    axis.reach = options_.stops ? profile.workspace[i] : 0.0;
    axes_.emplace_back(axis);
  }
  AxisParameters turn;
  turn.mass = profile.inertia;
  turn.damping = profile.turn_damping;
  turn.friction = profile.turn_friction;
  turn.lag = profile.lag;
  turn.hand = turning(options_.hand);
  turns_.assign(profile.max_torque > 0.0 ? 3 : 0, Axis(turn));
  cursor_.reset();
  if (!options_.will.path.rows.empty()) cursor_.emplace(options_.will.path);
  start_ = wanted_ = wants(0.0, rotation_);
  for (int i = 0; i < 3; ++i) {
    const double reach = options_.stops ? profile.workspace[i] : INFINITY;
    axes_[static_cast<std::size_t>(i)].place(std::clamp(start_[i], -reach, reach));
  }
  line_.assign(static_cast<std::size_t>(profile.delay * profile.rate) + 4, {});
  first_ = waiting_ = 0;
  time_ = 0.0;
  index_ = 0;
  open_ = true;
}

dvec3 SimulatedDevice::wants(double time, dquat& rotation) {
  if (!cursor_) return start_;
  const PathRow row = cursor_->at(time);
  rotation = row.rotation;
  return row.position;
}

// Applies the commands that have arrived by then.
void SimulatedDevice::apply_commands(double until) {
  while (waiting_ > 0 && line_[first_].from <= until + kSameInstant) {
    for (int i = 0; i < 3; ++i) axes_[static_cast<std::size_t>(i)].command(line_[first_].force[i]);
    for (std::size_t i = 0; i < turns_.size(); ++i) turns_[i].command(line_[first_].torque[static_cast<int>(i)]);
    first_ = (first_ + 1) % line_.size();
    --waiting_;
  }
}

void SimulatedDevice::advance_to(double time) {
  while (time_ < time - kSameInstant) {
    apply_commands(time_);
    const double next = waiting_ > 0 ? std::min(time, line_[first_].from) : time;
    const dvec3 to = wants(next, rotation_);
    for (int i = 0; i < 3; ++i)
      axes_[static_cast<std::size_t>(i)].advance(next - time_, {wanted_[i], to[i], options_.will.push[i]});
    for (Axis& turn : turns_) turn.advance(next - time_);
    wanted_ = to;
    time_ = next;
  }
  apply_commands(time_);
}

bool SimulatedDevice::read(DeviceSample& sample) {
  if (!open_) return false;
  const double rate = options_.profile.rate;
  std::uint64_t due = index_ + 1;
  if (options_.clock == DeviceClock::kWall) {
    if (index_ == 0) began_ = wall();
    const double now = wall() - began_;
    due = static_cast<std::uint64_t>(std::max(0.0, now) * rate) + 1;
    if (due <= index_) return false;
    const auto most = static_cast<std::uint64_t>(kLongestCatchUp * rate);
    if (due > index_ + most) {  // skips time without motion
      began_ += static_cast<double>(due - index_ - most) / rate;
      due = index_ + most;
    }
  }
  index_ = due;  // the first sample is at time 0
  advance_to(static_cast<double>(index_ - 1) / rate);
  sample = {};
  sample.position = in_counts(true_position(), options_.profile.encoder);
  sample.rotation = rotation_;
  if (!turns_.empty())
    sample.rotation = glm::normalize(turned(in_counts(true_turn(), options_.profile.turn_encoder)) * rotation_);
  sample.time = options_.clock == DeviceClock::kWall ? began_ + time_ : 0.0;
  return true;
}

void SimulatedDevice::write(const DeviceWrench& wrench) {
  if (!open_) return;
  if (waiting_ == line_.size()) {  // written faster than sampled: the newest replaces the last
    --waiting_;
  }
  const DeviceProfile& profile = options_.profile;
  line_[(first_ + waiting_) % line_.size()] = {
      time_ + profile.delay, in_counts(saturated(wrench.force, profile.max_force), profile.force_step),
      saturated(wrench.torque, profile.max_torque)};
  ++waiting_;
  apply_commands(time_);
}

dvec3 SimulatedDevice::true_position() const {
  return {axes_[0].position(), axes_[1].position(), axes_[2].position()};
}
dvec3 SimulatedDevice::true_velocity() const {
  return {axes_[0].velocity(), axes_[1].velocity(), axes_[2].velocity()};
}
dvec3 SimulatedDevice::motor_force() const {
  return {axes_[0].motor(), axes_[1].motor(), axes_[2].motor()};
}

dvec3 SimulatedDevice::true_turn() const {
  return turns_.empty() ? dvec3(0) : dvec3(turns_[0].position(), turns_[1].position(), turns_[2].position());
}
dvec3 SimulatedDevice::motor_torque() const {
  return turns_.empty() ? dvec3(0) : dvec3(turns_[0].motor(), turns_[1].motor(), turns_[2].motor());
}

void register_simulated() {
  static std::once_flag once;
  std::call_once(once, [] {
    static_cast<void>(register_driver(
        "simulated", [] { return std::make_unique<SimulatedDevice>(); },
        [] {
          std::vector<DeviceInfo> found;
          for (const DeviceProfile& profile : device_profiles())
            found.push_back({"simulated", profile.name, std::string(profile.title) + ", simulated, in a simulated hand",
                             "", capabilities_of(profile)});
          return found;
        }));
  });
}

}  // namespace pliant
