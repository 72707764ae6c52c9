// Wrappers: each applies exactly its documented effect to every driver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "devices/pose_file.h"
#include "devices/simulated/simulated_device.h"
#include "devices/wrappers/chain.h"
#include "devices/wrappers/gain.h"
#include "devices/wrappers/workspace.h"

namespace pliant {
namespace {

// Data received and returned by the inner device; sample n is n millimetres along x.
struct InsideDriver {
  std::vector<DeviceWrench> written;
  DeviceSample next;
  double step = 1e-3;  // [m]
  int reads = 0, safe = 0;
  bool silent = false, closed = false;
};

class Counting : public Driver {
 public:
  explicit Counting(InsideDriver& inside) : inside_(inside) {}
  Status open(const std::string&) override { return Done{}; }
  DeviceCapabilities capabilities() const override {
    DeviceCapabilities can;
    can.max_force = 8.0;
    can.max_stiffness = 1000.0;
    can.workspace = {0.1, 0.2, 0.3};
    can.rate = 1000.0;
    return can;
  }
  bool read(DeviceSample& sample) override {
    inside_.next.position.x = inside_.step * ++inside_.reads;
    inside_.next.time = 100.0 + 1e-3 * inside_.reads;
    if (inside_.silent) return false;
    sample = inside_.next;
    return true;
  }
  void write(const DeviceWrench& wrench) override { inside_.written.push_back(wrench); }
  void close() override { inside_.closed = true; }
  void make_safe() noexcept override { ++inside_.safe; }

 private:
  InsideDriver& inside_;
};

std::unique_ptr<Driver> opened(InsideDriver& inside, const std::string& words) {
  auto chain = wrap(std::make_unique<Counting>(inside), words);
  EXPECT_TRUE(chain) << (chain ? "" : chain.error().message());
  EXPECT_TRUE(chain->driver->open(""));
  return std::move(chain->driver);
}

TEST(Wrappers, DelayIsExactlySoManySamplesInBothDirections) {
  for (const char* words : {"delay=5ms,written=3ms", "delay=5,written=3", "delay=2ms|delay=3ms,written=3ms"}) {
    InsideDriver inside;
    const auto driver = opened(inside, words);
    EXPECT_NEAR(driver->capabilities().latency, 8e-3, 1e-12) << words;
    for (int i = 1; i <= 50; ++i) {
      DeviceSample sample;
      const bool there = driver->read(sample);
      EXPECT_EQ(there, i > 5) << words << ' ' << i;
      if (there) {
        EXPECT_DOUBLE_EQ(sample.position.x, 1e-3 * (i - 5));
        EXPECT_DOUBLE_EQ(sample.time, 100.0 + 1e-3 * (i - 5)) << "a sample keeps its time";
      }
      driver->write({dvec3(i, 0, 0), dvec3(0), 0.0});
      EXPECT_DOUBLE_EQ(inside.written.back().force.x, i > 3 ? i - 3 : 0.0);
    }
    driver->close();
    EXPECT_EQ(inside.written.back().force.x, 0.0) << "closed with zero, not with what was on its way";
  }
}

TEST(Wrappers, DropLosesItsShareAndTheSameEveryTime) {
  std::vector<bool> first;
  for (int run = 0; run < 2; ++run) {
    InsideDriver inside;
    const auto driver = opened(inside, "drop=10%,written=50%,seed=7");
    std::vector<bool> came;
    for (int i = 0; i < 20000; ++i) {
      DeviceSample sample;
      came.push_back(driver->read(sample));
      driver->write({});
    }
    const double share = 1.0 - static_cast<double>(std::count(came.begin(), came.end(), true)) / 20000.0;
    EXPECT_NEAR(share, 0.1, 5 * std::sqrt(0.1 * 0.9 / 20000));
    EXPECT_NEAR(static_cast<double>(inside.written.size()) / 20000.0, 0.5, 5 * std::sqrt(0.25 / 20000));
    if (run == 0) first = came;
    EXPECT_EQ(came, first);
  }
}

TEST(Wrappers, DropOfEverythingAndOfNothingAreExact) {
  for (const auto& [words, expected] : {std::pair("drop=100%", 0), {"drop=0%", 1000}}) {
    InsideDriver inside;
    const auto driver = opened(inside, words);
    int came = 0;
    for (int i = 0; i < 1000; ++i) {
      DeviceSample sample;
      came += driver->read(sample);
    }
    EXPECT_EQ(came, expected) << words;
  }
}

TEST(Wrappers, JitterKeepsTheOrderAndIsNoLaterThanItSays) {
  InsideDriver inside;
  const auto driver = opened(inside, "jitter=4ms,seed=3");
  double last = 0.0;
  std::vector<int> late(6, 0);
  for (int i = 1; i <= 5000; ++i) {
    DeviceSample sample;
    if (!driver->read(sample)) continue;
    EXPECT_GT(sample.position.x, last);
    last = sample.position.x;
    const auto by = static_cast<std::size_t>(std::lround(i - sample.position.x * 1e3));
    ASSERT_LE(by, 4u);
    ++late[by];
  }
  for (std::size_t by = 0; by <= 4; ++by) EXPECT_GT(late[by], 0) << by;
}

TEST(Wrappers, QuantiseRoundsToTheNearestCount) {
  InsideDriver inside;
  inside.step = 0.37e-3;
  const auto driver = opened(inside, "quantise=1mm,force=0.25");
  for (int i = 1; i <= 100; ++i) {
    DeviceSample sample;
    ASSERT_TRUE(driver->read(sample));
    EXPECT_NEAR(sample.position.x, std::round(0.37 * i) * 1e-3, 1e-15);
  }
  driver->write({dvec3(0.6, -0.13, 0.1), dvec3(0), 0.0});
  EXPECT_EQ(inside.written.back().force, dvec3(0.5, -0.25, 0.0));
}

// Work of the hand on the device, against work of the probe on the world.
TEST(Wrappers, GainKeepsPowerWhereBothNumbersAreTheSameAndElseSaysThatItDoesNot) {
  for (const auto& [words, kept] : {std::pair("gain=3", true), {"gain=3,force=1", false}, {"scale=3", false}}) {
    InsideDriver inside;
    auto chain = wrap(std::make_unique<Counting>(inside), words);
    ASSERT_TRUE(chain);
    EXPECT_EQ(chain->notes.empty(), kept) << words;
    ASSERT_TRUE(chain->driver->open(""));
    DeviceSample before, after;
    ASSERT_TRUE(chain->driver->read(before));
    chain->driver->write({dvec3(2, 0, 0), dvec3(0), 0.0});
    ASSERT_TRUE(chain->driver->read(after));
    const double world = 2.0 * (after.position.x - before.position.x), device = inside.written.back().force.x * 1e-3;
    if (kept)
      EXPECT_NEAR(world, device, 1e-15) << words;
    else
      EXPECT_NEAR(device, world / 3.0, 1e-15) << words;
  }
}

// A world spring at the wrapper's limit corresponds to one at the device's own limit.
TEST(Wrappers, GainSaysTheLimitsOfTheWorld) {
  InsideDriver inside;
  for (const char* words : {"gain=2", "gain=4,force=0.5", "scale=3"}) {
    const auto driver = opened(inside, words);
    const DeviceCapabilities can = driver->capabilities();
    DeviceSample sample;
    ASSERT_TRUE(driver->read(sample));
    driver->write({can.max_stiffness * sample.position, dvec3(0), 0.0});
    EXPECT_NEAR(length(inside.written.back().force) / (inside.step * inside.reads), 1000.0, 1e-9) << words;
    driver->write({dvec3(can.max_force, 0, 0), dvec3(0), 0.0});
    EXPECT_NEAR(inside.written.back().force.x, 8.0, 1e-12) << words;
  }
}

TEST(Wrappers, ClutchLeavesThePoseWhereItWasAndForceLeavesOnlyWithoutIt) {
  InsideDriver inside;
  const auto driver = opened(inside, "clutch=2");
  DeviceSample sample;
  dvec3 last(0);
  for (int i = 1; i <= 300; ++i) {
    const bool down = i > 100 && i <= 200;
    inside.next.buttons = down ? 4u : 3u;
    ASSERT_TRUE(driver->read(sample));
    EXPECT_EQ(sample.ready, !down);
    if (i > 1) {
      EXPECT_NEAR(length(sample.position - last), i > 101 && i <= 200 ? 0.0 : 1e-3, 1e-12) << i;
    }
    last = sample.position;
  }
  EXPECT_NEAR(sample.position.x, 0.3 - 0.1 + 0.001, 1e-12) << "the hand went 0.3 m, 99 mm of it with the clutch down";
}

TEST(Wrappers, BorderIsContinuousAndItsRateGrowsWithTheDepth) {
  InsideDriver inside;
  inside.step = 0.1e-3;
  const auto driver = opened(inside, "border=40mm,rate=5");
  DeviceSample sample;
  double last = 0.0, last_speed = 0.1;
  for (int i = 1; i <= 800; ++i) {
    ASSERT_TRUE(driver->read(sample));
    const double speed = (sample.position.x - last) / 1e-3, depth = std::max(0.0, 0.1e-3 * i - 0.040);
    EXPECT_NEAR(speed, 0.1 + 5 * depth, 1e-9) << i;
    EXPECT_LT(std::abs(speed - last_speed), 1e-3) << "no step of the speed at the border";
    last = sample.position.x;
    last_speed = speed;
  }
  driver->write({dvec3(-1, 0, 0), dvec3(0), 0.0});
  ASSERT_TRUE(driver->read(sample));
  EXPECT_NEAR(sample.position.x - last, 0.1e-3, 1e-12) << "a probe that is pushed back does not drift on";
}

TEST(Wrappers, FrameTurnsPosesToTheWorldAndForcesBackAndKeepsTheWork) {
  InsideDriver inside;
  const auto driver = opened(inside, "frame=0:90:0");
  inside.next.position = {0, 0.2, 0.3};
  DeviceSample a, b;
  ASSERT_TRUE(driver->read(a));
  EXPECT_NEAR(length(a.position - dvec3(0.3, 0.2, -1e-3)), 0.0, 1e-12) << "x of the device is -z of the world";
  ASSERT_TRUE(driver->read(b));
  const dvec3 force(1, 2, 3);
  driver->write({force, dvec3(0), 0.0});
  EXPECT_NEAR(dot(force, b.position - a.position), dot(inside.written.back().force, dvec3(1e-3, 0, 0)), 1e-15);
  EXPECT_NEAR(driver->capabilities().workspace.x, 0.3, 1e-12);
  EXPECT_NEAR(driver->capabilities().workspace.z, 0.1, 1e-12);
}

TEST(Wrappers, ReplayGivesBackWhatRecordHasKept) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "pliant_record_test.csv";
  std::filesystem::remove(file);
  {
    InsideDriver inside;
    const auto driver = opened(inside, "record=" + file.string());
    DeviceSample sample;
    for (int i = 1; i <= 100; ++i) {
      inside.next.buttons = static_cast<std::uint32_t>(i % 3);
      ASSERT_TRUE(driver->read(sample));
      driver->write({dvec3(0, i, 0), dvec3(0), 0.0});
    }
    driver->close();
    EXPECT_TRUE(inside.closed);
  }
  const auto rows = read_poses(file.string());
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 100u);
  InsideDriver inside;
  inside.step = 7e-3;
  const auto driver = opened(inside, "replay=" + file.string());
  for (int i = 1; i <= 100; ++i) {
    DeviceSample sample;
    ASSERT_TRUE(driver->read(sample));
    EXPECT_EQ(sample.position.x, 1e-3 * i);
    EXPECT_EQ(sample.buttons, static_cast<std::uint32_t>(i % 3));
    EXPECT_EQ((*rows)[static_cast<std::size_t>(i) - 1].wrench.force.y, i);
    driver->write({dvec3(5, 0, 0), dvec3(0), 0.0});
    EXPECT_EQ(inside.written.back().force, dvec3(0)) << "the hand at the device is not in this motion";
  }
  InsideDriver again;
  auto second = wrap(std::make_unique<Counting>(again), "record=" + file.string());
  ASSERT_TRUE(second);
  const Status refused = second->driver->open("");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), testing::HasSubstr("replaces nothing"));
  std::filesystem::remove(file);
}

TEST(Wrappers, TwoDevicesDoNotRecordIntoOneFileHoweverItIsSpelled) {
  const std::filesystem::path folder = testing::TempDir(), file = folder / "pliant_record_shared.csv";
  std::filesystem::remove(file);
  InsideDriver a, b;
  const auto first = opened(a, "record=" + file.string());
  auto second = wrap(std::make_unique<Counting>(b), "record=" + (folder / "." / file.filename()).string());
  ASSERT_TRUE(second);
  const Status refused = second->driver->open("");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), testing::HasSubstr("is being recorded into"));
  DeviceSample sample;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(first->read(sample));
  first->close();
  const auto rows = read_poses(file.string());
  ASSERT_TRUE(rows) << rows.error().message();
  EXPECT_EQ(rows->size(), 10u);
  std::filesystem::remove(file);
  // A device without samples leaves no empty file.
  { const auto idle = opened(b, "record=" + file.string()); }
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Wrappers, RecordStopsAtItsLengthAndSaysHowMuchIsMissing) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "pliant_record_long.csv";
  std::filesystem::remove(file);
  InsideDriver inside;
  const auto driver = opened(inside, "record=" + file.string() + ",seconds=50ms");
  DeviceSample sample;
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(driver->read(sample));
  driver->close();
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  EXPECT_THAT(line, testing::HasSubstr("did not fit"));
  const auto rows = read_poses(file.string());
  ASSERT_TRUE(rows);
  EXPECT_LE(rows->size(), 51u);
  std::filesystem::remove(file);
}

TEST(Wrappers, MotorsAreSwitchedOffThroughEveryWrapper) {
  InsideDriver inside;
  const auto driver = opened(inside, "delay=5|jitter=1ms|drop=50%|quantise=1mm|gain=2|frame=1:2:3|clutch=1|border=1m");
  driver->make_safe();
  EXPECT_EQ(inside.safe, 1);
  driver->close();
  EXPECT_TRUE(inside.closed);
}

TEST(Wrappers, BadWordsGetOneSentence) {
  const struct {
    const char* words;
    const char* part;
  } bad[] = {{"delay", "is no WRAPPER=VALUE"},
             {"delay=", "must be"},
             {"delay=-1ms", "must be"},
             {"delay=11s", "up to 10s"},
             {"delay=nan", "must be"},
             {"delay=1e400s", "must be"},
             {"delay=5ms,written=3", "same unit"},
             {"delay=5ms,wriiten=3ms", "unknown key 'wriiten'"},
             {"drop=110%", "0% to 100%"},
             {"drop=10%,seed=x", "whole number"},
             {"slow=5", "wrappers are:"},
             {"|", "is no WRAPPER=VALUE"},
             {"gain=0", "0.001 to 1000"},
             {"frame=1:2", "three angles"},
             {"clutch=32", "0 to 31"},
             {"replay=/nowhere/at/all.csv", "cannot be opened"},
             {"record=", "must name a file"}};
  for (const auto& [words, part] : bad) {
    InsideDriver inside;
    const auto chain = wrap(std::make_unique<Counting>(inside), words);
    ASSERT_FALSE(chain) << words;
    EXPECT_THAT(chain.error().message(), testing::HasSubstr(part)) << words;
    EXPECT_EQ(chain.error().message().find('\n'), std::string::npos) << words;
  }
}

TEST(Wrappers, AnIdNamesADriverAndWhatStandsInFrontOfIt) {
  register_simulated();
  auto chain = make_device("simulated:falcon,clock=tick|delay=5ms|gain=2");
  ASSERT_TRUE(chain) << chain.error().message();
  EXPECT_EQ(chain->id, "falcon,clock=tick");
  ASSERT_TRUE(chain->driver->open(chain->id));
  EXPECT_NEAR(chain->driver->capabilities().max_force, 4.0, 1e-12);
  DeviceSample sample;
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(chain->driver->read(sample));
  EXPECT_TRUE(chain->driver->read(sample));
  const auto unknown = make_device("nothing:0|delay=5ms");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message(), testing::HasSubstr("drivers are:"));
}

}  // namespace
}  // namespace pliant
