// Two simulated devices in simulated hands press into a wall in real time, for PLIANT_DEVICE_SECONDS. Memory, clock
// offset and force limits must not change with time. Effects of a busy machine (late periods, removed force) are
// printed, not tested.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "devices/servo/servo.h"
#include "devices/simulated/simulated_device.h"
#include "runtime/clock.h"
#include "scenes/count_allocations.h"
#include "tests/two_devices/seconds_to_run.h"

namespace pliant {
namespace {

constexpr double kWall = 400.0;  // [N/m]

double now() {
  return static_cast<double>(now_ns()) * 1e-9;
}

// [KiB] of this process in memory.
long resident() {
  long pages = 0, unused = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%ld %ld", &unused, &pages) != 2) pages = 0;
    std::fclose(file);
  }
  return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

struct SeenLong {
  std::atomic<double> largest{0.0};                 // [N] written
  std::atomic<double> youngest{1e9}, oldest{-1e9};  // [s] a sample's age when it was read
  std::atomic<std::uint64_t> nonsense{0}, back{0};  // writes that are no number; samples not newer than the last
};

// Wraps a device and observes its data.
class Watched final : public Driver {
 public:
  Watched(std::unique_ptr<Driver> inner, SeenLong& seen) : inner_(std::move(inner)), seen_(seen) {}
  Status open(const std::string& id) override { return inner_->open(id); }
  DeviceCapabilities capabilities() const override { return inner_->capabilities(); }
  bool read(DeviceSample& sample) override {
    if (!inner_->read(sample)) return false;
    const double age = now() - sample.time;
    seen_.youngest = std::min(seen_.youngest.load(), age);
    seen_.oldest = std::max(seen_.oldest.load(), age);
    if (!(sample.time > last_)) ++seen_.back;
    last_ = sample.time;
    return true;
  }
  void write(const DeviceWrench& wrench) override {
    const double size = length(wrench.force);
    if (!std::isfinite(size)) ++seen_.nonsense;
    seen_.largest = std::max(seen_.largest.load(), size);
    inner_->write(wrench);
  }
  void close() override { inner_->close(); }
  void make_safe() noexcept override { inner_->make_safe(); }

 private:
  std::unique_ptr<Driver> inner_;
  SeenLong& seen_;
  double last_ = -1.0;
};

SimulatedOptions pressing(const char* profile) {
  SimulatedOptions options = *parse_simulated(profile);
  const auto row = [](double time, double y) { return PathRow{time, {0, y, 0}, {1, 0, 0, 0}}; };
  options.will.path.rows = {row(0.0, 0.01), row(0.5, -0.008), row(1.5, -0.008), row(2.0, 0.01)};
  options.will.path.repeats = true;
  return options;
}

// The wall of a touch tick at the pose that it knows.
DeviceModel wall_at(dvec3 position) {
  DeviceModel model;
  model.position = position;
  model.max_force = 3.3;
  if (position.y < 0.0) {
    model.wrench.force.y = -kWall * position.y;
    model.force_by_position[1][1] = -kWall;
  }
  return model;
}

struct Device {
  Device(const char* name)
      : profile(name), servo(std::make_unique<Watched>(std::make_unique<SimulatedDevice>(pressing(name)), seen)) {}
  const char* profile;
  SeenLong seen;
  Servo servo;
  std::array<std::uint64_t, 64> causes{};  // how often each took the force away
  std::uint64_t printed = 0;               // transitions looked at
};

void count_losses(Device& device, const DeviceReport& report) {
  const std::uint64_t kept = std::min<std::uint64_t>(report.transitions, DeviceReport::kKept);
  for (std::uint64_t i = kept - std::min(kept, report.transitions - device.printed); i < kept; ++i) {
    const DeviceTransition& one = report.transition(i);
    if (one.from == DeviceState::kActive) ++device.causes[static_cast<std::size_t>(one.cause)];
  }
  device.printed = report.transitions;
}

void print_report(Device& device, double seconds) {
  const ServoFigures& f = device.servo.report().figures;
  std::printf(
      "%s: %llu periods in %.1f s, %llu late (%.0f us at most), %llu samples, largest force %.3f N, oldest "
      "model %.0f us, samples %.0f to %.0f us old, %llu transitions\n",
      device.profile, static_cast<unsigned long long>(f.periods), seconds, static_cast<unsigned long long>(f.missed),
      f.period_max, static_cast<unsigned long long>(f.samples), device.seen.largest.load(), f.oldest_model,
      1e6 * device.seen.youngest, 1e6 * device.seen.oldest,
      static_cast<unsigned long long>(device.servo.report().transitions));
  for (std::size_t i = 0; i < device.causes.size(); ++i) {
    if (device.causes[i] == 0) continue;
    DeviceTransition one;
    one.cause = static_cast<DeviceCause>(i);
    const std::string words = describe(one);
    std::printf("  force taken away %llu times: %s\n", static_cast<unsigned long long>(device.causes[i]),
                words.substr(words.rfind(" N: ") + 4).c_str());
  }
}

TEST(TwoDevices, KeepTheirMemoryClocksAndLimitsHoweverLongTheyRun) {
  const double seconds = seconds_to_run();
  Device touch("touch"), omega("omega.7");
  Device* const both[] = {&touch, &omega};
  const double began = now();
  for (Device* const device : both) {
    ASSERT_TRUE(device->servo.open(""));
    ASSERT_TRUE(device->servo.start());
  }
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> ticks{0}, overruns{0};
  std::thread clock([&] {
    static_cast<void>(request_realtime_priority());
    RealtimeClock touch_clock(1000.0);
    DeviceSample samples[2];
    bool heard[2] = {};
    while (!done) {
      touch_clock.next();
      for (std::size_t i = 0; i < 2; ++i) {
        heard[i] = both[i]->servo.read(samples[i]) || heard[i];
        if (!heard[i]) continue;
        const DeviceModel model = wall_at(samples[i].position);
        both[i]->servo.write_model(model, model.wrench);
      }
      ++ticks;
      overruns = touch_clock.overruns();
    }
  });
  std::uint64_t allocations = 0, trips = 0;
  long first = 0, last = 0;
  double fast[2] = {};  // [1] periods beyond the rate's limit
  {
    while (now() - began < 0.2 * seconds) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    first = resident();
    const CountAllocations counting;  // from here on nothing that runs takes memory
    while (now() - began < seconds) {
      for (Device* const device : both) {
        count_losses(*device, device->servo.report());
        if (device->servo.state() != DeviceState::kTripped) continue;
        ++trips;
        device->servo.arm();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    allocations = counting.count();
  }
  last = resident();
  done = true;
  clock.join();
  for (Device* const device : both) device->servo.halt();
  const double ran = now() - began;
  for (std::size_t i = 0; i < 2; ++i) {
    const ServoFigures& f = both[i]->servo.report().figures;
    fast[i] = static_cast<double>(f.periods) - ran * both[i]->servo.capabilities().rate;
    print_report(*both[i], ran);
  }
  std::printf(
      "touch clock: %llu ticks, %llu skipped; tripped and armed again %llu times; memory %ld KiB after a fifth, "
      "%ld KiB at the end\n",
      static_cast<unsigned long long>(ticks), static_cast<unsigned long long>(overruns),
      static_cast<unsigned long long>(trips), first, last);
  EXPECT_EQ(allocations, 0u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Device& device = *both[i];
    SCOPED_TRACE(device.profile);
    const ServoFigures& f = both[i]->servo.report().figures;
    const double period = 1.0 / both[i]->servo.capabilities().rate;
    EXPECT_GT(f.periods, 0u);
    EXPECT_EQ(f.periods, f.samples + f.without_sample);
    EXPECT_LE(fast[i], 2.0) << "a servo that is late must not run faster to make up for it";
    EXPECT_LE(device.seen.largest, 3.3) << "the level's limit";
    EXPECT_EQ(device.seen.nonsense, 0u);
    EXPECT_EQ(device.seen.back, 0u) << "samples must grow newer";
    EXPECT_GE(device.seen.youngest, -1e-6) << "a sample from the future: the clocks drift apart";
    EXPECT_LE(device.seen.youngest, period) << "the device's clock falls behind";
    both[i]->servo.close();
  }
}

// The same hand and wall on a machine that was started just now, and on one that has been up for more than three years:
// monotonic clocks count from the start, and a sum of periods or a difference of times must not grow coarse.
TEST(TwoDevices, FeelTheSameHoweverLongTheMachineHasBeenUp) {
  const auto forces = [](double began) {
    SimulatedOptions options = pressing("omega.7");
    options.clock = DeviceClock::kTick;
    class Kept final : public Driver {
     public:
      explicit Kept(std::unique_ptr<Driver> inner, std::vector<double>& force)
          : inner_(std::move(inner)), force_(force) {}
      Status open(const std::string& id) override { return inner_->open(id); }
      DeviceCapabilities capabilities() const override { return inner_->capabilities(); }
      bool read(DeviceSample& sample) override { return inner_->read(sample); }
      void write(const DeviceWrench& wrench) override {
        force_.push_back(wrench.force.y);
        inner_->write(wrench);
      }
      void close() override { inner_->close(); }

     private:
      std::unique_ptr<Driver> inner_;
      std::vector<double>& force_;
    };
    std::vector<double> force;
    Servo servo(std::make_unique<Kept>(std::make_unique<SimulatedDevice>(std::move(options)), force));
    EXPECT_TRUE(servo.open(""));
    DeviceSample sample;
    bool heard = false;
    for (int i = 0; i < 4 * 6000; ++i) {
      servo.period(began + i * 0.25e-3);
      heard = servo.read(sample) || heard;
      if (heard && i % 4 == 0) {
        const DeviceModel model = wall_at(sample.position);
        servo.write_model(model, model.wrench);
      }
    }
    EXPECT_EQ(servo.state(), DeviceState::kActive) << describe(servo.report().transition(0));
    servo.close();
    return force;
  };
  const std::vector<double> young = forces(0.0), old = forces(1e8);
  ASSERT_EQ(young.size(), old.size());
  double largest = 0.0, difference = 0.0;
  for (std::size_t i = 0; i < young.size(); ++i) {
    largest = std::max(largest, std::abs(young[i]));
    difference = std::max(difference, std::abs(young[i] - old[i]));
  }
  EXPECT_GT(largest, 1.0) << "nothing was felt";
  EXPECT_LT(difference, 0.01) << "[N]";
}

}  // namespace
}  // namespace pliant
