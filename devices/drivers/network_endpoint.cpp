#include "devices/drivers/network_endpoint.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr double kForget = 1.0;  // [s] without a frame: the engine has ended, and another one may connect

dvec3 shortened(const dvec3& v, double most) {
  const double size = glm::length(v);
  return size > most ? v * (most / size) : v;
}

// The shortest rotation vector of a unit quaternion. [rad]
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
                                 std::function<double()> clock, std::optional<FrameKey> key)
    : port_(std::move(port)), can_(can), clock_(std::move(clock)), key_(std::move(key)), own_(random_session()) {
  name.copy(name_.data(), name_.size() - 1);
}

std::size_t NetworkEndpoint::pack(NetworkFrame& frame, double now, FrameBytes& into) {
  frame.session = own_;
  frame.sequence = sent_.next(now);
  frame.time_us = static_cast<std::uint64_t>(now * 1e6);
  return write_frame(frame, into, key());
}

void NetworkEndpoint::send(NetworkFrame& frame, double now) {
  FrameBytes bytes;
  const std::size_t length = pack(frame, now, bytes);
  (void)port_->send(std::span(bytes).first(length));
}

// With a key each engine gets a new session, so that a replayed open frame has no effect.
void NetworkEndpoint::forget() {
  engine_ = 0;
  has_force_ = false;
  if (key_) own_ = random_session();
  port_->free_peer();
}

void NetworkEndpoint::describe_to(const NetworkFrame& frame, double now) {
  ++counts_.accepted;
  NetworkFrame answer;
  answer.kind = FrameKind::kDescription;
  answer.peer = frame.session;
  answer.description = {can_, name_};
  send(answer, now);
}

void NetworkEndpoint::reply_busy(const NetworkFrame& frame, bool stranger, double now) {
  ++counts_.foreign;
  NetworkFrame answer;
  answer.kind = FrameKind::kBusy;
  answer.peer = frame.session;
  port_->peer().copy(answer.busy.by.data(), answer.busy.by.size() - 1);
  FrameBytes bytes;
  const std::size_t length = pack(answer, now, bytes);
  const auto packet = std::span<const std::uint8_t>(bytes).first(length);
  if (stranger)
    port_->answer(packet);
  else
    (void)port_->send(packet);
}

// Answers a request from another address while an engine uses the device.
void NetworkEndpoint::answer_stranger(double now) {
  FrameBytes bytes;
  const std::size_t size = port_->stranger(bytes);
  NetworkFrame frame;
  if (size == 0 || parse_frame(std::span(bytes).first(size), frame, key()) != FrameFault::kNone) return;
  if (frame.kind == FrameKind::kOpen || frame.kind == FrameKind::kAsk) reply_busy(frame, true, now);
}

void NetworkEndpoint::accept(const NetworkFrame& frame, double now) {
  if (frame.kind == FrameKind::kAsk) {
    const bool other = key_ && engine_ != 0 && frame.session != engine_;  // with a key, only an engine allowed to open
                                                                          // it may ask
    return other ? reply_busy(frame, false, now) : describe_to(frame, now);
  }
  if (frame.kind == FrameKind::kOpen) {
    // A second engine waits until the first has closed or timed out (one second).
    if (engine_ != 0 && frame.session != engine_) return reply_busy(frame, false, now);
    if (key_ && frame.peer != own_) {
      ++counts_.foreign;
      return;
    }
    if (engine_ == 0) {
      port_->take_peer();
      engine_ = frame.session;
      closed_ = false;
      heard_sequence_ = frame.sequence;
      heard_time_us_ = frame.time_us;
      has_force_ = false;
    } else if (comes_after(frame.sequence, heard_sequence_)) {
      heard_sequence_ = frame.sequence;
    } else {  // a replayed or duplicated frame
      ++counts_.late;
      return;
    }
    heard_at_ = now;
    return describe_to(frame, now);
  }
  if (engine_ == 0 || frame.session != engine_ || frame.peer != own_) {
    ++counts_.foreign;
  } else if (frame.kind == FrameKind::kClose) {
    forget();
    closed_ = true;
  } else if (frame.kind == FrameKind::kForce) {
    if (!comes_after(frame.sequence, heard_sequence_) || frame.time_us < heard_time_us_) {
      ++counts_.late;
      return;
    }
    counts_.lost += frame.sequence - heard_sequence_ - 1;
    ++counts_.accepted;
    heard_sequence_ = frame.sequence;
    heard_time_us_ = frame.time_us;
    force_ = frame.force;
    has_force_ = true;
    force_at_ = heard_at_ = now;
  }
}

void NetworkEndpoint::hear(double now) {
  FrameBytes bytes;
  for (int i = 0; i < 64; ++i) {
    const auto got = port_->receive(bytes, 0.0);
    if (!got || *got == 0) break;
    NetworkFrame frame;
    const FrameFault fault = parse_frame(std::span(bytes).first(*got), frame, key());
    count_fault(counts_, fault);
    if (fault == FrameFault::kNone) accept(frame, now);
  }
  answer_stranger(now);
}

DeviceWrench NetworkEndpoint::tick(StateFrame state) {
  const double now = clock_();
  hear(now);
  if (engine_ != 0 && now - heard_at_ > kForget) forget();
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
