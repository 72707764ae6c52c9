#include "devices/drivers/network_device.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "devices/ports/udp_port.h"
#include "devices/servo/local_force.h"
#include "runtime/clock.h"

namespace pliant {
namespace {

constexpr double kModelRadius = 0.010;  // [m] of a model without a limit: farther a tick cannot take a hand
constexpr double kReopen = 0.1;         // [s] between two tries to open
constexpr double kOpenFor = 2.0;        // [s] that open() waits: a device that was left alone listens anew after 1 s
constexpr double kClockDrift = 2e-4;    // [1] two quartz clocks differ by less
constexpr int kMostAtOnce = 64;         // frames that one read() takes

std::uint32_t random_session() {
  std::random_device random;
  const std::uint32_t session = random();
  return session != 0 ? session : 1;
}

Result<std::unique_ptr<PacketPort>> open_udp(const std::string& id) {
  const auto address = parse_udp_address(id.empty() ? kNetworkPort : id);
  if (!address) return address.error();
  auto port = UdpPort::connect(*address);
  if (!port) return port.error();
  return std::unique_ptr<PacketPort>(std::move(*port));
}

std::string shown(const std::string& id) {
  return "network device `" + (id.empty() ? std::string("127.0.0.1:") + kNetworkPort : id) + "`";
}

}  // namespace

NetworkDevice::NetworkDevice() : NetworkDevice(open_udp) {}
NetworkDevice::NetworkDevice(PortOpener opener, SecondsClock clock)
    : opener_(std::move(opener)), clock_(std::move(clock)) {}

Status NetworkDevice::open(const std::string& id) {
  auto port = opener_(id);
  if (!port) return port.error();
  *this = NetworkDevice(opener_, clock_);
  port_ = std::move(*port);
  own_ = random_session();
  const double begin = clock_();
  for (double now = begin; now - begin < kOpenFor && device_ == 0; now = clock_()) {
    NetworkFrame frame;
    frame.kind = FrameKind::kOpen;
    opened_at_ = now;
    send(frame, now);
    FrameBytes bytes;
    for (double until = now + kReopen; (now = clock_()) < until && device_ == 0;) {
      const auto got = port_->receive(bytes, until - now);
      if (!got) return got.error();
      NetworkFrame answer;
      if (*got == 0 || parse_frame(std::span(bytes).first(*got), answer) != FrameFault::kNone) continue;
      if (accept(answer, clock_())) can_.latency = clock_() - opened_at_;
    }
  }
  if (device_ == 0) {
    port_.reset();
    return Error{shown(id), "does not answer; start the device, or give its own PORT or ADDRESS:PORT"};
  }
  return Done{};
}

void NetworkDevice::send(NetworkFrame& frame, double now) {
  frame.session = own_;
  frame.sequence = sent_.next(now);
  frame.time_us = static_cast<std::uint64_t>(now * 1e6);
  FrameBytes bytes;
  const std::size_t length = write_frame(frame, bytes);
  (void)port_->send(std::span(bytes).first(length));  // a frame that cannot leave is lost, as on the way
}

// Of the device that was opened, and of nobody else.
bool NetworkDevice::accept(const NetworkFrame& frame, double now) {
  const bool answers = frame.kind == FrameKind::kDescription && frame.peer == own_ && frame.session != 0;
  const bool anew = frame.session != device_ || comes_after(frame.sequence, heard_sequence_);
  if (answers && (device_ == 0 || (silent(now) && anew))) {
    device_ = frame.session;  // it has been started again, or its clock has been set
    can_ = frame.description.can;
    name_ = frame.description.name;
    heard_sequence_ = frame.sequence;
    heard_time_us_ = frame.time_us;
    clock_offset_ = now - static_cast<double>(frame.time_us) * 1e-6;
    heard_ = false;
    ++counts_.accepted;
    return true;
  }
  if (device_ == 0 || frame.peer != own_ || frame.session != device_) {
    ++counts_.foreign;
    return false;
  }
  return frame.kind == FrameKind::kState ? accept_state(frame, now) : answers;
}

bool NetworkDevice::accept_state(const NetworkFrame& frame, double now) {
  // A frame that was held up for longer than silence lasts is as good as lost: its time says so.
  const double sensed = static_cast<double>(frame.time_us) * 1e-6;
  const double offset = clock_offset_ + kClockDrift * (heard_ ? now - heard_at_ : 0.0);
  if (!comes_after(frame.sequence, heard_sequence_) || frame.time_us < heard_time_us_ ||
      now - (sensed + offset) > kFrameSilence) {
    ++counts_.late;
    return false;
  }
  // The least delay that was ever seen is taken for none; clocks that drift apart are followed.
  clock_offset_ = std::min(offset, now - sensed);
  counts_.lost += frame.sequence - heard_sequence_ - 1;
  ++counts_.accepted;
  heard_sequence_ = frame.sequence;
  heard_time_us_ = frame.time_us;
  heard_ = true;
  heard_at_ = now;
  state_ = frame.state;
  state_.sample.time = std::min(now, sensed + clock_offset_);
  if (frame.state.low) state_.sample.warnings |= kDeviceBatteryLow;
  state_.sample.ready = frame.state.sample.ready && !frame.state.stopped && !frame.state.hot &&
                        sent_.unanswered(frame.state.heard, now) < kFrameAnswer;
  if (const double age = sent_.age(frame.state.heard, now); std::isfinite(age)) round_trip_ = age;
  return true;
}

void NetworkDevice::hear(double now) {
  FrameBytes bytes;
  for (int i = 0; i < kMostAtOnce; ++i) {
    const auto got = port_->receive(bytes, 0.0);
    if (!got || *got == 0) return;
    NetworkFrame frame;
    const FrameFault fault = parse_frame(std::span(bytes).first(*got), frame);
    if (fault != FrameFault::kNone)
      ++(fault == FrameFault::kForeign ? counts_.foreign : counts_.damaged);
    else if (accept(frame, now) && frame.kind == FrameKind::kState)
      fresh_ = true;
  }
}

bool NetworkDevice::read(DeviceSample& sample) {
  if (!port_) return false;
  const double now = clock_();
  hear(now);
  if (!fresh_) return false;
  fresh_ = false;
  sample = state_.sample;
  return true;
}

void NetworkDevice::send_force(ForceFrame& force) {
  const double now = clock_();
  const bool quiet = silent(now);
  NetworkFrame frame;
  if (quiet && now - opened_at_ >= kReopen) {
    opened_at_ = now;
    frame.kind = FrameKind::kOpen;
    send(frame, now);
  }
  frame.kind = FrameKind::kForce;
  frame.peer = device_;
  frame.force = quiet ? ForceFrame{} : force;
  frame.force.heard = heard_sequence_;
  send(frame, now);
}

void NetworkDevice::write(const DeviceWrench& wrench) {
  if (!port_) return;
  ForceFrame force;
  force.wrench = wrench;
  send_force(force);
}

bool NetworkDevice::write_model(const DeviceModel& model, const DeviceWrench& wrench) {
  if (!port_) return false;
  ForceFrame force;
  force.wrench = wrench;
  force.has_model = true;
  force.model = model;
  force.radius = model.max_force > 0.0 ? model_radius(model, model.max_force)
                                       : std::min(kModelRadius, model_radius(model, can_.max_force));
  send_force(force);
  return true;
}

void NetworkDevice::close() {
  if (!port_) return;
  write({});
  NetworkFrame frame;
  frame.kind = FrameKind::kClose;
  frame.peer = device_;
  send(frame, clock_());
  port_.reset();
}

std::vector<DeviceInfo> list_network_devices() {
  DeviceInfo info{.driver = "network", .name = "network device"};
  info.missing = std::string("nothing answers on port ") + kNetworkPort +
                 " of this machine; start the device there, or open it as network:ADDRESS:PORT";
  auto port = open_udp("");
  if (!port) return {info};
  NetworkFrame frame;
  frame.session = random_session();
  frame.sequence = 1;
  FrameBytes bytes;
  const std::size_t length = write_frame(frame, bytes);
  if (!(*port)->send(std::span(bytes).first(length))) return {info};
  const auto got = (*port)->receive(bytes, 0.05);
  if (!got || *got == 0 || parse_frame(std::span(bytes).first(*got), frame) != FrameFault::kNone) return {info};
  if (frame.kind != FrameKind::kDescription) return {info};
  info.id = std::string("127.0.0.1:") + kNetworkPort;
  info.missing.clear();
  if (frame.description.name[0] != 0) info.name = frame.description.name.data();
  info.can = frame.description.can;
  return {info};
}

}  // namespace pliant
