// The servo of a device: a driver in front of a driver. It runs at the device's rate on the newest force model
// (DeviceModel) from the touch tick; the guard (devices/guard/guard.h) limits the force. A late touch tick causes a
// short extrapolation with a deadline, instead of a zero-order hold of the force.
//
// Threads. read(), write() and write_model() are called by the touch clock and never wait; samples and models pass
// through a TripleBuffer. report() is for one thread, the owner's. arm(), disarm() and stop() may be called from any
// thread. The guard and the inner driver belong to the thread that runs the periods. From start() to halt() this is the
// servo's thread, or that of the calling library (DeviceLoop). Otherwise it is the caller of advance(), in virtual time
// and deterministic.
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

  // --- Driver: used by the owner before start(), then by the touch clock
  Status open(const std::string& id) override;
  void adopt();  // instead of open(), for a driver that is open already
  // The driver's, with its stiffness limited by its rate.
  DeviceCapabilities capabilities() const override { return can_; }
  bool read(DeviceSample& sample) override;
  // Zero: intentionally no force. Otherwise a force that is kept until the next call, at most for kModelHolds.
  void write(const DeviceWrench& wrench) override;
  bool write_model(const DeviceModel& model, const DeviceWrench& wrench) override;
  void close() override;
  void make_safe() noexcept override;

  // --- Time
  Status start();        // real time, on a separate thread or the library's
  void halt() noexcept;  // writes zero and makes the device safe
  bool runs() const { return running_; }
  Status can_advance() const;  // the reason if it cannot run in virtual time
  void advance(double time);   // [s] runs every period until then, at the device's rate
  void period(double now);     // runs one period; used by all of the above

  // --- From any thread
  void arm() { orders_ |= kArm; }
  void disarm() { orders_ |= kDisarm; }
  void stop() { orders_ |= kStop; }  // emergency stop: latched
  DeviceState state() const { return state_; }
  bool felt() const { return state_ == DeviceState::kActive; }

  const DeviceReport& report();
  const std::string& note() const { return note_; }  // warnings after open() or start(); may be empty

 private:
  enum Order : std::uint32_t { kArm = 1, kDisarm = 2, kStop = 4 };
  struct Message {
    DeviceModel model;
    double at = 0.0;  // [s] on the servo's clock, when it was written
    bool known = false, let_go = false;
  };
  void send(const DeviceModel& model, bool let_go);
  double clock() const;
  GuardOrders take_orders(double now);
  GuardInput input(double now);
  void put(const GuardInput& wanted, const DeviceWrench& wrench, bool make_safe);
  void measure(double now, bool sampled);
  void publish_report();
  void run();
  void end_thread();
  bool slept();

  std::unique_ptr<Driver> inner_;
  GuardParameters parameters_;
  DeviceCapabilities can_;
  bool open_ = false, looped_ = false;  // looped_: the library has received its callback
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

  // For the thread that runs the periods.
  Guard guard_;
  bool failed_ = false;      // the driver threw in this period or the last
  double sleep_offset_ = 0;  // [s] total suspended time at the last check
  bool looked_ = false;
  ServoFigures figures_;
  Histogram periods_, jitter_, trips_, reads_;
  DeviceSample newest_;
  double came_at_ = 0.0;  // [s]
  bool came_ = false;
  double last_ = 0.0, written_at_ = 0.0, reported_at_ = 0.0;
  std::uint64_t reported_periods_ = 0, reported_transitions_ = 0;
  bool reported_ = false;
  std::uint64_t not_ready_ = 0;  // samples
  double virtual_start_ = 0.0;
  std::uint64_t virtual_periods_ = 0;
  std::thread thread_;
};

}  // namespace pliant
