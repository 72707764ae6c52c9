#include "devices/drivers/network_device.h"

#include <algorithm>
#include <cmath>

#include "devices/believable.h"
#include "devices/ports/udp_port.h"
#include "devices/servo/local_force.h"
#include "devices/spec.h"
#include "runtime/clock.h"

namespace pliant {
namespace {

constexpr double kModelRadius = 0.010;  // [m] radius of a model without a limit: larger than a hand's motion in a tick
constexpr double kReopen = 0.1;         // [s] between two attempts to open
constexpr double kForgotten = 1.2;      // [s] a device accepts another session after 1 s without frames
constexpr double kOpenFor = 2.0;        // [s] that open() waits: an abandoned device accepts a new session after 1 s
constexpr double kClockDrift = 2e-4;    // [1] largest drift between two quartz clocks
constexpr int kMostAtOnce = 64;         // frames per read()

Result<std::unique_ptr<PacketPort>> open_udp(const std::string& id) {
  const std::string before = id.substr(0, id.find(','));
  const auto address = parse_udp_address(trimmed(before).empty() ? kNetworkPort : std::string(trimmed(before)));
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
  auto named = parse_keyed_address(id);
  if (!named) return named.error();
  auto port = opener_(id);
  if (!port) return port.error();
  *this = NetworkDevice(opener_, clock_);
  port_ = std::move(*port);
  key_ = std::move(named->key);
  const double begin = clock_();
  // A busy device is asked repeatedly: it drops a crashed engine after a second.
  for (double now = begin; now - begin < kOpenFor && device_ == 0; now = clock_()) {
    const double asked = now;
    ask(now);
    for (double until = now + kReopen; (now = clock_()) < until && device_ == 0;) {
      NetworkFrame answer;
      const auto got = receive(answer, until - now);
      if (!got) return got.error();
      if (*got != 0 && accept(answer, clock_())) can_.latency = clock_() - asked;
    }
  }
  if (device_ != 0) return Done{};
  port_.reset();
  if (busy_[0] != 0)
    return Error{shown(id),
                 "is in use by " + (busy_[0] == '?' ? "another engine" : std::string("the engine at ") + busy_.data()),
                 "end that one first"};
  if (const std::string frames = describe(counts_); !frames.empty())
    return Error{shown(id), "answers with frames that cannot be used (" + frames + ")", cure_for(counts_)};
  if (key_) return Error{shown(id), "does not answer to this key", "start the device, and give it the same key"};
  return Error{shown(id), "does not answer",
               "start the device, give its own PORT or ADDRESS:PORT, and its key if it has one (,key=FILE)"};
}

void NetworkDevice::send(NetworkFrame& frame, double now) {
  frame.session = own_;
  frame.sequence = sent_.next(now);
  frame.time_us = static_cast<std::uint64_t>(now * 1e6);
  FrameBytes bytes;
  const std::size_t length = write_frame(frame, bytes, key());
  (void)port_->send(std::span(bytes).first(length));  // a frame that cannot be sent counts as lost
}

// With a key, first asks for the device's session. The device opens only for a frame with its current session, so
// replayed frames fail. Each request uses a new session, so that old answers do not match.
void NetworkDevice::ask(double now) {
  opened_at_ = now;
  if (key_ || own_ == 0) own_ = random_session();
  NetworkFrame frame;
  frame.kind = key_ ? FrameKind::kAsk : FrameKind::kOpen;
  send(frame, now);
}

// 0: nothing, or nothing valid.
Result<std::size_t> NetworkDevice::receive(NetworkFrame& frame, double seconds) {
  FrameBytes bytes;
  auto got = port_->receive(bytes, seconds);
  if (!got || *got == 0) return got;
  const FrameFault fault = parse_frame(std::span(bytes).first(*got), frame, key());
  count_fault(counts_, fault);
  return fault == FrameFault::kNone ? *got : std::size_t{0};
}

// Only frames of the opened device are accepted.
bool NetworkDevice::accept(const NetworkFrame& frame, double now) {
  const bool answers = frame.kind == FrameKind::kDescription && frame.peer == own_ && frame.session != 0;
  if (frame.kind == FrameKind::kBusy && frame.peer == own_ && device_ == 0) {
    busy_ = frame.busy.by;
    if (busy_[0] == 0) busy_[0] = '?';
    return false;
  }
  const bool anew = frame.session != device_ || comes_after(frame.sequence, heard_sequence_);
  if (answers && (device_ == 0 || (silent(now) && anew))) {
    device_ = frame.session;  // the device has restarted, or its clock was reset
    can_ = frame.description.can;
    name_ = frame.description.name;
    heard_sequence_ = frame.sequence;
    heard_time_us_ = frame.time_us;
    clock_offset_ = now - static_cast<double>(frame.time_us) * 1e-6;
    heard_ = false;
    ++counts_.accepted;
    if (key_) {
      NetworkFrame open;
      open.kind = FrameKind::kOpen;
      open.peer = device_;
      send(open, now);
    }
    return true;
  }
  if (device_ == 0 || frame.peer != own_ || frame.session != device_) {
    ++counts_.foreign;
    return false;
  }
  return frame.kind == FrameKind::kState ? accept_state(frame, now) : answers;
}

bool NetworkDevice::accept_state(const NetworkFrame& frame, double now) {
  // A frame delayed longer than the watchdog's time counts as lost; its time stamp shows the delay.
  const double sensed = static_cast<double>(frame.time_us) * 1e-6;
  const double offset = clock_offset_ + kClockDrift * (heard_ ? now - heard_at_ : 0.0);
  if (!comes_after(frame.sequence, heard_sequence_) || frame.time_us < heard_time_us_ ||
      now - (sensed + offset) > kFrameSilence) {
    ++counts_.late;
    return false;
  }
  // The smallest observed delay is the reference; clock drift is tracked.
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
  for (int i = 0; i < kMostAtOnce; ++i) {
    const std::uint64_t dropped = counts_.dropped();
    NetworkFrame frame;
    const auto got = receive(frame, 0.0);
    if (!got || (*got == 0 && counts_.dropped() == dropped)) return;
    if (*got != 0 && accept(frame, now) && frame.kind == FrameKind::kState) fresh_ = true;
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
  // A device that still knows our session answers without a request. With a key it accepts no other session until ours
  // has timed out.
  const double since = now - (key_ && heard_ ? std::max(heard_at_, opened_at_) : opened_at_);
  if (quiet && since >= (key_ ? kForgotten : kReopen)) ask(now);
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

// A close frame of the open session: frames sent before it are not rendered after it.
bool NetworkDevice::safe_line(SafeLine& line) const {
  if (!port_ || port_->file() < 0 || device_ == 0) return false;
  NetworkFrame frame;
  frame.kind = FrameKind::kClose;
  frame.session = own_;
  frame.peer = device_;
  FrameBytes bytes;
  line.size = write_frame(frame, bytes, key());
  static_assert(kFrameHeader + FrameKey::kTag <= std::tuple_size_v<decltype(SafeLine::bytes)>);
  std::copy_n(bytes.begin(), line.size, line.bytes.begin());
  line.descriptor = port_->file();
  return true;
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
  if (frame.kind == FrameKind::kBusy)
    info.missing = std::string("it is in use by the engine at ") + frame.busy.by.data() + "; end that one first";
  if (frame.kind != FrameKind::kDescription) return {info};
  info.id = std::string("127.0.0.1:") + kNetworkPort;
  info.missing.clear();
  if (frame.description.name[0] != 0) info.name = frame.description.name.data();
  info.can = frame.description.can;
  if (const std::string wrong = beyond_belief(info.can); !wrong.empty()) info.missing = "it " + wrong;
  return {info};
}

}  // namespace pliant
