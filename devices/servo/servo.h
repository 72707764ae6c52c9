// A driver in front of a driver: the servo of a device, which runs at the device's rate on the newest force model
// (DeviceModel) from the touch tick, and the guard (devices/guard/guard.h) that decides what leaves. A touch tick that
// comes late is a short extrapolation with a deadline of its own, not a force that is held.
//
// Threads. read(), write() and write_model() are the touch clock's and never wait: samples and models travel by
// TripleBuffer. report() is one thread's, its owner's. arm(), disarm() and stop() are anybody's. The guard and the
// driver inside belong to whoever runs the periods: the servo's thread, or the library that calls (DeviceLoop), from
// start() to halt(); otherwise the caller of advance(), in virtual time and always the same.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "devices/guard/guard.h"
#include "devices/guard/watchman.h"
#include "pliant/device_state.h"
#include "pliant/driver.h"
#include "runtime/exchange.h"
#include "runtime/histogram.h"

namespace pliant {

// Whether it is to be driven by a servo: it has a rate, too.
bool wants_servo(const DeviceCapabilities& can);

class Servo final : public Driver {
 public:
  explicit Servo(std::unique_ptr<Driver> inner, const GuardParameters& parameters = {});
  ~Servo() override;

  // --- Driver: before start() its owner's, then the touch clock's
  Status open(const std::string& id) override;
  void adopt();  // in place of open(): the driver is open already
  // The driver's, its stiffness limited by its rate.
  DeviceCapabilities capabilities() const override { return can_; }
  bool read(DeviceSample& sample) override;
  // Zero: nothing is wanted, on purpose. Else a force that holds until the next, at most kModelHolds.
  void write(const DeviceWrench& wrench) override;
  bool write_model(const DeviceModel& model, const DeviceWrench& wrench) override;
  void close() override;
  void make_safe() noexcept override;

  // --- Time
  Status start();        // real time, on a thread of its own or the library's
  void halt() noexcept;  // the device is written zero and made safe
  bool runs() const { return running_; }
  Status can_advance() const;  // why it cannot run in virtual time, if it cannot
  void advance(double time);   // [s] every period until then, at the device's rate
  void period(double now);     // one; what all of the above run

  // --- Anybody's
  void arm() { orders_ |= kArm; }
  void disarm() { orders_ |= kDisarm; }
  void stop() { orders_ |= kStop; }  // emergency: latched
  DeviceState state() const { return state_; }
  bool felt() const { return state_ == DeviceState::kActive; }

  const DeviceReport& report();
  const std::string& note() const {
    return note_;
  }  // what is not as it might be, after open() or start(); may be empty

 private:
  enum Order : std::uint32_t { kArm = 1, kDisarm = 2, kStop = 4 };
  struct Message {
    DeviceModel model;
    double at = 0.0;  // [s] of the servo's clock, when it was written
    bool known = false, let_go = false;
  };
  void send(const DeviceModel& model, bool let_go);
  double clock() const;
  GuardOrders take_orders(double now);
  GuardWish wish(double now);
  void put(const GuardWish& wish, const DeviceWrench& wrench, bool make_safe);
  void measure(double now, bool sampled);
  void tell();
  void run();
  void end_thread();
  bool slept();

  std::unique_ptr<Driver> inner_;
  GuardParameters parameters_;
  DeviceCapabilities can_;
  bool open_ = false, looped_ = false;  // looped_: the library has been handed its tick
  std::string note_;
  LineWatch watch_;

  // touch -> servo, servo -> touch, servo -> owner
  TripleBuffer<Message> models_;
  TripleBuffer<DeviceSample> samples_;
  TripleBuffer<DeviceReport> reports_;
  std::atomic<std::uint32_t> orders_{0};
  std::atomic<DeviceState> state_{DeviceState::kDisconnected};
  std::atomic<bool> running_{false}, ended_{true}, granted_{false};
  std::atomic<double> virtual_now_{0.0};

  // Of whoever runs the periods.
  Guard guard_;
  bool failed_ = false;      // the driver threw in this period or the last
  double sleep_offset_ = 0;  // [s] how long the machine has slept, at the last look
  bool looked_ = false;
  ServoFigures figures_;
  Histogram periods_, jitter_, trips_, reads_;
  DeviceSample newest_;
  double came_at_ = 0.0;  // [s]
  bool came_ = false;
  double last_ = 0.0, written_at_ = 0.0, told_at_ = 0.0;
  std::uint64_t told_periods_ = 0, told_transitions_ = 0;
  bool told_ = false;
  std::uint64_t not_ready_ = 0;  // samples
  double virtual_start_ = 0.0;
  std::uint64_t virtual_periods_ = 0;
  std::thread thread_;
};

}  // namespace pliant
