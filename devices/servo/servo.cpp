#include "devices/servo/servo.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "devices/drop_counter.h"
#include "devices/guard/last_resort.h"
#include "devices/servo/local_force.h"
#include "runtime/clock.h"

namespace pliant {
namespace {

constexpr double kReportEvery = 0.05;  // [s] of reports for a person to read
constexpr double kLateModel = 2e-3;    // [s] two ticks of the touch clock
constexpr double kSlept = 0.020;       // [s] less is the two clocks' reading
constexpr double kLongestWait = 5e-3;  // [s] for a reply: an order is heard at least so often

double seconds(clockid_t which) {
  timespec at{};
  clock_gettime(which, &at);
  return static_cast<double>(at.tv_sec) + 1e-9 * static_cast<double>(at.tv_nsec);
}

std::uint64_t ns(double s) {
  return s > 0.0 ? static_cast<std::uint64_t>(s * 1e9) : 0;
}

}  // namespace

bool wants_servo(const DeviceCapabilities& can) {
  return can.rate > 0.0 && renders(can);
}

Servo::Servo(std::unique_ptr<Driver> inner, const GuardParameters& parameters)
    : inner_(std::move(inner)), parameters_(parameters) {}

Servo::~Servo() {
  close();
}

Status Servo::open(const std::string& id) {
  if (open_) return Error{"servo", "is open already", "close it first"};
  if (Status opened = inner_->open(id); !opened) return opened;
  adopt();
  return Done{};
}

void Servo::adopt() {
  try {
    can_ = inner_->capabilities();
  } catch (...) {
    inner_->close();
    throw;
  }
  open_ = true;
  note_.clear();
  can_.max_stiffness = stable_stiffness(can_, can_.rate);
  guard_ = Guard(can_, parameters_);
  figures_ = {};
  periods_ = jitter_ = trips_ = reads_ = {};
  came_ = false;
  virtual_periods_ = 0;
  looped_ = failed_ = reported_ = false;
  if (!guard_to_the_last(*inner_)) note_ = "more devices are open than a crash handler knows";
  if (const std::string sentence = watch_.start(*inner_, can_); !sentence.empty()) note_ = sentence;
  not_ready_ = 0;
  publish_report();
}

// [s] Real time while a thread runs, else the virtual time of advance().
double Servo::clock() const {
  return running_ ? seconds(CLOCK_MONOTONIC) : virtual_now_.load();
}

bool Servo::read(DeviceSample& sample) {
  const bool fresh = samples_.acquire();
  if (fresh) sample = samples_.read();
  return fresh;
}

void Servo::send(const DeviceModel& model, bool let_go) {
  Message& message = models_.write();
  message.model = model;
  message.at = clock();
  message.known = !let_go;
  message.let_go = let_go;
  models_.publish();
}

void Servo::write(const DeviceWrench& wrench) {
  DeviceModel model;
  model.wrench = wrench;
  send(model, is_nothing(model));
}

bool Servo::write_model(const DeviceModel& model, const DeviceWrench&) {
  send(model, false);
  return true;
}

void Servo::make_safe() noexcept {
  stop();
  if (!running_ && open_) inner_->make_safe();
}

void Servo::close() {
  halt();
  if (!open_) return;
  open_ = false;
  guard_.close(virtual_now_);
  state_ = guard_.state();
  try {
    inner_->write({});
  } catch (...) {  // made safe anyway
  }
  inner_->make_safe();
  let_go_of(*inner_);
  watch_.end();
  inner_->close();
  publish_report();
}

Status Servo::can_advance() const {
  if (can_.loop == DeviceLoop::kOurs) return Done{};
  return Error{"device",
               can_.loop == DeviceLoop::kReply ? "answers in its own time and cannot run in lockstep"
                                               : "is run by its maker's library and cannot run in lockstep",
               "call Session::start()", "device.realtime"};
}

void Servo::advance(double time) {
  const double dt = 1.0 / can_.rate;
  for (;;) {
    const double next = static_cast<double>(virtual_periods_) * dt;
    if (next > time + 0.5e-6 * dt) return;
    ++virtual_periods_;
    virtual_now_ = next;
    period(next);
  }
}

// Whether the machine was suspended since the last call: one clock continues, the other does not.
bool Servo::slept() {
  if (!running_) return false;
  const double offset = seconds(CLOCK_BOOTTIME) - seconds(CLOCK_MONOTONIC);
  const bool slept = looked_ && offset - sleep_offset_ > kSlept;
  sleep_offset_ = offset;
  looked_ = true;
  return slept;
}

GuardOrders Servo::take_orders(double) {
  const std::uint32_t given = orders_.exchange(0);
  GuardOrders orders;
  orders.arm = given & kArm;
  orders.disarm = given & kDisarm;
  orders.stop = given & kStop;
  orders.suspended = slept();
  orders.failed = failed_;
  orders.let_go = models_.read().let_go;
  return orders;
}

GuardInput Servo::input(double now) {
  const Message& message = models_.read();
  GuardInput wanted;
  wanted.known = message.known;
  if (!message.known) return wanted;
  const DeviceModel model = softened(message.model, can_.max_stiffness);
  wanted.age = std::max(0.0, now - message.at);
  wanted.wrench = local_force(model, guard_.position(), can_.senses_rotation ? guard_.rotation() : model.rotation,
                              guard_.velocity(), guard_.spin(), wanted.age);
  wanted.weight = model.weight;
  wanted.velocity = model.carried;
  wanted.stiffness = stiffness_along(model.force_by_position, wanted.wrench.force);
  wanted.turning_stiffness = stiffness_along(model.torque_by_turn, wanted.wrench.torque);
  wanted.max_force = model.max_force;
  wanted.max_torque = model.max_torque;
  wanted.easing = model.easing;
  figures_.oldest_model = std::max(figures_.oldest_model, 1e6 * wanted.age);
  if (wanted.age > kLateModel) ++figures_.late_models;
  return wanted;
}

// After exit() or a crash nothing is written: the device has been made safe. A device that renders the model itself
// receives one that respects the guard's current limits even if no further frame arrives.
void Servo::put(const GuardInput& wanted, const DeviceWrench& wrench, bool make_safe) {
  if (all_made_safe()) return;
  try {
    DeviceModel model;
    if (guard_.state() == DeviceState::kActive) {
      model = softened(models_.read().model, can_.max_stiffness);
      model.position = guard_.position();
      model.rotation = guard_.rotation();
      const double square = dot(wanted.wrench.force, wanted.wrench.force);
      const double share = square > 0.0 ? std::clamp(dot(wrench.force, wanted.wrench.force) / square, 0.0, 1.0) : 0.0;
      model = rendered_elsewhere(model, wrench, share, guard_.report().max_force);
    }
    if (!inner_->write_model(model, wrench)) inner_->write(wrench);
    failed_ = false;
  } catch (...) {
    failed_ = true;
  }
  if (make_safe || failed_) inner_->make_safe();
}

void Servo::period(double now) {
  if (!running_) virtual_now_ = now;
  if (models_.acquire()) ++figures_.models;
  DeviceSample sample;
  bool sampled = false;
  bool threw = false;
  try {
    sampled = inner_->read(sample);
  } catch (...) {
    threw = true;
  }
  failed_ = failed_ || threw;
  const GuardOrders orders = take_orders(now);
  guard_.sense(sampled ? &sample : nullptr, now, orders);
  const GuardInput wanted = input(now);
  const DeviceWrench wrench = guard_.release(wanted, now, orders);
  put(wanted, wrench, guard_.take_make_safe());
  failed_ = failed_ || threw;
  state_ = guard_.state();
  if (sampled) {
    samples_.write() = sample;
    samples_.publish();
    newest_ = sample;
    came_at_ = now;
    came_ = true;
    if (sample.time > 0.0) reads_.add(ns(now - sample.time));
    if (!sample.ready) ++not_ready_;
  }
  watch_.beat(*inner_, now);
  measure(now, sampled);
}

void Servo::measure(double now, bool sampled) {
  ServoFigures& f = figures_;
  if (f.periods > 0) {
    const double since = now - last_, wanted = 1.0 / can_.rate;
    periods_.add(ns(since));
    jitter_.add(ns(std::abs(since - wanted)));
    if (since > 1.5 * wanted) f.missed += static_cast<std::uint64_t>(std::lround(since / wanted)) - 1;
  } else {
    reported_at_ = now;
  }
  ++f.periods;
  ++(sampled ? f.samples : f.without_sample);
  if (sampled && can_.loop == DeviceLoop::kReply && f.periods > 1) trips_.add(ns(now - written_at_));
  last_ = now;
  if (can_.loop == DeviceLoop::kReply) written_at_ = running_ ? seconds(CLOCK_MONOTONIC) : now;
  if (now - reported_at_ < kReportEvery && guard_.report().transitions == reported_transitions_ && reported_) return;
  if (now > reported_at_) f.rate = static_cast<double>(f.periods - reported_periods_) / (now - reported_at_);
  reported_at_ = now;
  reported_periods_ = f.periods;
  publish_report();
}

void Servo::publish_report() {
  figures_.period_p50 = periods_.percentile_us(0.5);
  figures_.period_p99 = periods_.percentile_us(0.99);
  figures_.period_max = periods_.max_us();
  figures_.jitter = jitter_.percentile_us(0.99);
  figures_.round_trip_p50 = trips_.percentile_us(0.5);
  figures_.round_trip_max = trips_.max_us();
  figures_.read_p50 = reads_.percentile_us(0.5);
  figures_.read_max = reads_.max_us();
  figures_.has_priority = granted_;
  reported_transitions_ = guard_.report().transitions;
  reported_ = true;
  DeviceReport& out = reports_.write();
  out = guard_.report();
  out.figures = figures_;
  out.dropped = dropped_frames(*inner_);
  out.dropped.not_ready = not_ready_;
  out.sample = newest_;
  out.sample_age = came_ ? last_ - came_at_ : -1.0;
  reports_.publish();
}

const DeviceReport& Servo::report() {
  reports_.acquire();
  return reports_.read();
}

Status Servo::start() {
  if (!open_) return Error{"servo", "is not open", "call open() first"};
  if (running_) return Done{};
  looked_ = false;
  guard_ = Guard(can_, parameters_);  // another clock: previous state is invalid
  models_.write() = {};
  models_.publish();
  running_ = true;
  ended_ = false;
  if (can_.loop != DeviceLoop::kCallback) {
    try {
      thread_ = std::thread([this] { run(); });
    } catch (...) {
      running_ = false;
      ended_ = true;
      throw;
    }
    return Done{};
  }
  if (looped_) return Done{};
  Status looping = inner_->run([this] {
    if (!running_) {
      if (ended_) return;
      end_thread();
      ended_ = true;
      return;
    }
    period(seconds(CLOCK_MONOTONIC));
  });
  looped_ = looping.ok();
  if (!looped_) running_ = false, ended_ = true;
  return looping;
}

// The last call on the thread that writes.
void Servo::end_thread() {
  guard_.close(seconds(CLOCK_MONOTONIC));
  state_ = guard_.state();
  put({}, {}, true);
  publish_report();
}

void Servo::halt() noexcept {
  if (!running_.exchange(false)) return;
  if (thread_.joinable()) {
    thread_.join();
  } else {  // the library's thread ends it in its next call; if it calls no more, it has stopped the device itself
    for (int i = 0; i < 100 && !ended_; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void Servo::run() {
  granted_ = request_realtime_priority();
  const double dt = 1.0 / can_.rate;
  double due = seconds(CLOCK_MONOTONIC);
  const auto sleep_until = [](double time) {
    timespec at{};
    at.tv_sec = static_cast<time_t>(time);
    at.tv_nsec = static_cast<long>((time - static_cast<double>(at.tv_sec)) * 1e9);
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
  };
  while (running_) {
    if (can_.loop == DeviceLoop::kReply) {
      const double before = seconds(CLOCK_MONOTONIC);
      try {
        inner_->wait(std::min(kLongestWait, 4.0 * dt));
      } catch (...) {
        failed_ = true;
      }
      // A device that is gone may answer at once, repeatedly: avoid a busy loop.
      const double now = seconds(CLOCK_MONOTONIC);
      if (now - before < 0.1 * dt && now - last_ < 0.5 * dt) sleep_until(last_ + dt);
    } else {
      due += dt;
      const double now = seconds(CLOCK_MONOTONIC);
      if (due < now) due = now;  // late: the missed deadline is counted, not made up for
      sleep_until(due);
    }
    period(seconds(CLOCK_MONOTONIC));
  }
  end_thread();
  ended_ = true;
}

}  // namespace pliant
