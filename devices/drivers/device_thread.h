// The thread of a driver whose device must be waited for. read() and write() exchange the newest values with it and
// return at once. Watchdog: a force that is not renewed within 20 ms becomes zero, whatever the caller's thread does.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "pliant/driver.h"
#include "runtime/clock.h"
#include "runtime/exchange.h"

namespace pliant {

class DeviceThread {
 public:
  ~DeviceThread() { stop(); }

  // `run` is called once, on the new thread, and must return soon after stopping() becomes true.
  void start(std::function<void()> run) {
    stop();
    samples_.acquire();  // discards an old sample
    stopping_ = off_ = false;
    thread_ = std::thread([work = std::move(run)] {
      request_realtime_priority();
      work();
    });
  }
  void stop() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

  // For the driver's callers.
  bool read(DeviceSample& sample) {
    if (!samples_.acquire()) return false;
    sample = samples_.read();
    return true;
  }
  void write(const DeviceWrench& wrench) {
    wrenches_.write() = {wrench, seconds()};
    wrenches_.publish();
  }
  void switch_off() { off_ = true; }  // zero force from now on, until start()

  // For the thread.
  bool stopping() const { return stopping_; }
  bool off() const { return off_; }
  // The force to render now: zero after the watchdog's time, at the end, and after switch_off().
  DeviceWrench wanted() {
    if (wrenches_.acquire()) newest_ = wrenches_.read();
    return stopping_ || off_ || seconds() - newest_.time > kDeadline ? DeviceWrench{} : newest_.wrench;
  }
  void publish(const DeviceSample& sample) {
    samples_.write() = sample;
    samples_.write().time = seconds();
    samples_.publish();
  }
  static double seconds() { return static_cast<double>(now_ns()) * 1e-9; }  // [s] monotonic
  static void sleep(double duration) { std::this_thread::sleep_for(std::chrono::duration<double>(duration)); }

 private:
  static constexpr double kDeadline = 0.020;  // [s]
  struct Wanted {
    DeviceWrench wrench;
    double time = 0.0;  // [s] monotonic, when it was written
  };
  std::thread thread_;
  std::atomic<bool> stopping_{false}, off_{false};
  TripleBuffer<DeviceSample> samples_;
  TripleBuffer<Wanted> wrenches_;
  Wanted newest_;
};

}  // namespace pliant
