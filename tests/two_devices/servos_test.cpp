// Two devices in real time, each with its own servo, under one touch clock, with orders from a third thread: for the
// thread sanitizer.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "devices/servo/servo.h"
#include "tests/two_devices/seconds_to_run.h"

namespace pliant {
namespace {

// Observations: written values, the writing thread, and when it was closed.
struct Seen {
  std::atomic<int> writes{0}, reads{0}, after_close{0}, made_safe{0};
  std::atomic<double> last{-1.0}, largest{0.0};
  std::atomic<bool> closed{false};
};

class TimedDriver : public Driver {
 public:
  TimedDriver(Seen& seen, double rate, DeviceLoop loop) : seen_(seen), rate_(rate), loop_(loop) {}
  ~TimedDriver() override { end(); }
  Status open(const std::string&) override { return Done{}; }
  DeviceCapabilities capabilities() const override { return {.max_force = 2.0, .rate = rate_, .loop = loop_}; }
  bool read(DeviceSample& sample) override {
    ++seen_.reads;
    sample = {};
    sample.position.y = 1e-5 * (reads_++ % 5);  // unsynchronised on purpose: one thread alone may call this
    return true;
  }
  void write(const DeviceWrench& wrench) override {
    ++seen_.writes;
    if (seen_.closed) ++seen_.after_close;
    seen_.last = length(wrench.force);
    seen_.largest = std::max(seen_.largest.load(), length(wrench.force));
  }
  void make_safe() noexcept override {
    ++seen_.made_safe;
    seen_.last = 0.0;
  }
  void close() override {
    end();
    seen_.closed = true;
  }
  void wait(double seconds) override {
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(seconds, 1.0 / rate_)));
  }
  Status run(std::function<void()> tick) override {
    thread_ = std::thread([this, tick] {
      while (!stop_) {
        tick();
        std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / rate_));
      }
    });
    return Done{};
  }

 private:
  void end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  Seen& seen_;
  double rate_;
  DeviceLoop loop_;
  int reads_ = 0;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

void run_two(DeviceLoop first, DeviceLoop second, double seconds) {
  using clock = std::chrono::steady_clock;
  Seen seen[2];
  {
    Servo left(std::make_unique<TimedDriver>(seen[0], 1000.0, first));
    Servo right(std::make_unique<TimedDriver>(seen[1], 4000.0, second));
    Servo* const both[] = {&left, &right};
    for (Servo* const servo : both) {
      ASSERT_TRUE(servo->open(""));
      ASSERT_TRUE(servo->start());
    }
    std::atomic<bool> done{false};
    std::thread touch([&] {
      for (int i = 0; !done; ++i) {
        for (Servo* const servo : both) {
          DeviceSample sample;
          servo->read(sample);
          DeviceModel model;
          model.position = sample.position;
          model.wrench.force.y = i % 400 < 100 ? 0.0 : 1.0;
          if (i % 1000 == 999)
            servo->write({});
          else
            servo->write_model(model, model.wrench);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    const auto end = clock::now() + std::chrono::duration<double>(seconds);
    for (int i = 0; clock::now() < end; ++i) {
      for (Servo* const servo : both) {
        const DeviceReport& report = servo->report();
        EXPECT_LE(report.force, 2.0);
        if (servo->state() == DeviceState::kTripped) servo->arm();
        if (i % 50 == 49) servo->stop();
        if (i % 70 == 69) servo->disarm(), servo->arm();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    done = true;
    touch.join();
    for (Servo* const servo : both) {
      servo->halt();
      EXPECT_GT(servo->report().figures.periods, 0u);
    }
    for (const Seen& one : seen) EXPECT_EQ(one.last, 0.0) << "halted";
    for (Servo* const servo : both) ASSERT_TRUE(servo->start()) << "and once more";
    for (Servo* const servo : both) servo->close();
  }
  for (const Seen& one : seen) {
    EXPECT_GT(one.writes, 0);
    EXPECT_LE(one.largest, 2.0);
    EXPECT_EQ(one.last, 0.0);
    EXPECT_EQ(one.after_close, 0);
    EXPECT_GE(one.made_safe, 1);
  }
}

TEST(TwoDevices, RunInRealTimeBesideEachOtherWhoeverOwnsTheirLoops) {
  const double each = seconds_to_run() / 2.0;
  run_two(DeviceLoop::kOurs, DeviceLoop::kReply, each);
  run_two(DeviceLoop::kCallback, DeviceLoop::kOurs, each);
}

TEST(TwoDevices, ADeviceWithALoopOfItsOwnDoesNotRunInLockstep) {
  Seen seen;
  for (const DeviceLoop loop : {DeviceLoop::kReply, DeviceLoop::kCallback}) {
    Servo servo(std::make_unique<TimedDriver>(seen, 1000.0, loop));
    ASSERT_TRUE(servo.open(""));
    EXPECT_FALSE(servo.can_advance());
  }
}

}  // namespace
}  // namespace pliant
