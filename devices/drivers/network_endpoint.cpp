#include "devices/drivers/network_endpoint.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace pliant {
namespace {

constexpr double kForget = 1.0;  // [s] without a frame: the engine has ended, and another one may come

dvec3 shortened(const dvec3& v, double most) {
  const double size = glm::length(v);
  return size > most ? v * (most / size) : v;
}

// The rotation vector of a unit quaternion, the short way round. [rad]
dvec3 rotation_vector(dquat q) {
  if (q.w < 0.0) q = -q;
  const dvec3 axis(q.x, q.y, q.z);
  const double sine = glm::length(axis);
  return sine < 1e-12 ? 2.0 * axis : axis * (2.0 * std::atan2(sine, q.w) / sine);
}

}  // namespace

DeviceWrench model_wrench(const DeviceModel& model, double radius, const StateFrame& at) {
  const dvec3 dx = shortened(at.sample.position - model.position, radius);
  const dvec3 turn = rotation_vector(at.sample.rotation * glm::conjugate(model.rotation));
  DeviceWrench wrench = model.wrench;
  wrench.force += model.force_by_position * dx + model.force_by_turn * turn + model.force_by_velocity * at.velocity;
  wrench.torque += model.torque_by_position * dx + model.torque_by_turn * turn + model.torque_by_spin * at.spin;
  return wrench;
}

NetworkEndpoint::NetworkEndpoint(std::unique_ptr<ListeningPort> port, DeviceCapabilities can, const std::string& name,
                                 std::function<double()> clock)
    : port_(std::move(port)), can_(can), clock_(std::move(clock)) {
  name.copy(name_.data(), name_.size() - 1);
  std::random_device random;
  while (own_ == 0) own_ = random();
}

void NetworkEndpoint::send(NetworkFrame& frame, double now) {
  frame.session = own_;
  frame.sequence = sent_.next(now);
  frame.time_us = static_cast<std::uint64_t>(now * 1e6);
  FrameBytes bytes;
  const std::size_t length = write_frame(frame, bytes);
  (void)port_->send(std::span(bytes).first(length));
}

void NetworkEndpoint::accept(const NetworkFrame& frame, double now) {
  if (frame.kind == FrameKind::kAsk || frame.kind == FrameKind::kOpen) {
    // A second engine waits until the first has closed or has been silent for a second.
    if (frame.kind == FrameKind::kOpen && (engine_ == 0 || frame.session == engine_)) {
      if (engine_ == 0) {
        port_->take_peer();
        engine_ = frame.session;
        heard_sequence_ = frame.sequence;
        has_force_ = false;
      } else if (comes_after(frame.sequence, heard_sequence_)) {
        heard_sequence_ = frame.sequence;
      }
      heard_at_ = now;
    }
    if (frame.kind == FrameKind::kOpen && frame.session != engine_) {
      ++counts_.foreign;
      return;
    }
    ++counts_.accepted;
    NetworkFrame answer;
    answer.kind = FrameKind::kDescription;
    answer.peer = frame.session;
    answer.description = {can_, name_};
    send(answer, now);
    return;
  }
  if (engine_ == 0 || frame.session != engine_ || frame.peer != own_) {
    ++counts_.foreign;
  } else if (frame.kind == FrameKind::kClose) {
    engine_ = 0;
    has_force_ = false;
    port_->free_peer();
  } else if (frame.kind == FrameKind::kForce) {
    if (!comes_after(frame.sequence, heard_sequence_)) {
      ++counts_.late;
      return;
    }
    counts_.lost += frame.sequence - heard_sequence_ - 1;
    ++counts_.accepted;
    heard_sequence_ = frame.sequence;
    force_ = frame.force;
    has_force_ = true;
    force_at_ = heard_at_ = now;
  }
}

void NetworkEndpoint::hear(double now) {
  FrameBytes bytes;
  for (int i = 0; i < 64; ++i) {
    const auto got = port_->receive(bytes, 0.0);
    if (!got || *got == 0) return;
    NetworkFrame frame;
    const FrameFault fault = parse_frame(std::span(bytes).first(*got), frame);
    if (fault != FrameFault::kNone)
      ++(fault == FrameFault::kForeign ? counts_.foreign : counts_.damaged);
    else
      accept(frame, now);
  }
}

DeviceWrench NetworkEndpoint::tick(StateFrame state) {
  const double now = clock_();
  hear(now);
  if (engine_ != 0 && now - heard_at_ > kForget) {
    engine_ = 0;
    has_force_ = false;
    port_->free_peer();
  }
  if (engine_ != 0) {
    NetworkFrame frame;
    frame.kind = FrameKind::kState;
    frame.peer = engine_;
    frame.state = state;
    frame.state.heard = heard_sequence_;
    send(frame, now);
  }
  const bool stale = now - force_at_ > kFrameSilence || sent_.unanswered(force_.heard, now) > kFrameAnswer;
  if (!has_force_ || stale || !state.sample.ready || state.stopped || state.hot) return {};
  DeviceWrench wrench = force_.has_model ? model_wrench(force_.model, force_.radius, state) : force_.wrench;
  if (can_.max_force > 0.0) wrench.force = shortened(wrench.force, can_.max_force);
  if (can_.max_torque > 0.0) wrench.torque = shortened(wrench.torque, can_.max_torque);
  return wrench;
}

}  // namespace pliant
