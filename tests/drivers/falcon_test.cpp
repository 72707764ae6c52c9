#include "devices/drivers/falcon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <random>

#include "devices/drivers/falcon_delta.h"
#include "tests/drivers/until.h"

namespace pliant {
namespace {

constexpr dvec3 kMiddle{0, 0, 0.125};

// Positions of the workspace, by chance.
std::vector<dvec3> positions(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> across(-0.035, 0.035);
  std::vector<dvec3> all;
  for (int i = 0; i < count; ++i) all.push_back(kMiddle + dvec3(across(random), across(random), across(random)));
  return all;
}

TEST(FalconDelta, TheLegsThatItFindsHaveTheLengthsThatTheyHave) {
  // The knee and the shin from the other side: rotated about z by the leg's angle, as Stamper draws them.
  constexpr double kPi = 3.14159265358979323846;
  for (const dvec3& p : positions(100)) {
    FalconPose pose;
    ASSERT_TRUE(falcon_angles(p, pose));
    for (int i = 0; i < 3; ++i) {
      const double turn = kPi / 2 + kPi / 12 - 2 * kPi / 3 * i;
      const dvec3 out(std::cos(turn), std::sin(turn), 0), side(-std::sin(turn), std::cos(turn), 0);
      const double u = dot(p, out) - 0.040 + 0.01443, v = dot(p, side) + 0.02309 - 0.025;
      const dvec3 knee(0.060 * std::cos(pose.angle[i]), 0.0, 0.060 * std::sin(pose.angle[i]));
      // Between knee and effector there are two stubs of 11.25 mm in the leg's plane and a shin of 102.5 mm that leans.
      const double plane = std::hypot(u - knee.x, p.z - knee.z) - 2 * 0.01125;
      EXPECT_NEAR(std::hypot(plane, v), 0.1025, 1e-12);
    }
  }
}

TEST(FalconDelta, NewtonFindsThePositionThatTheAnglesCameFrom) {
  double worst = 0.0;
  for (const dvec3& p : positions(2000)) {
    FalconPose pose;
    ASSERT_TRUE(falcon_angles(p, pose));
    dvec3 found = kMiddle;
    ASSERT_TRUE(falcon_position(pose.angle, found)) << p.x << ' ' << p.y << ' ' << p.z;
    worst = std::max(worst, length(found - p));
  }
  EXPECT_LT(worst, 1e-10);
}

TEST(FalconDelta, TheJacobianIsTheDifferenceOfTheAngles) {
  constexpr double h = 1e-6;
  for (const dvec3& p : positions(200)) {
    FalconPose pose, more, less;
    ASSERT_TRUE(falcon_angles(p, pose));
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 step(0);
      step[axis] = h;
      ASSERT_TRUE(falcon_angles(p + step, more) && falcon_angles(p - step, less));
      const dvec3 slope = (more.angle - less.angle) / (2 * h);
      EXPECT_LT(length(slope - pose.jacobian[axis]), 1e-6 * length(slope) + 1e-6);
    }
  }
}

TEST(FalconDelta, TheMotorsDoTheWorkThatTheHandGets) {
  for (const dvec3& p : positions(200)) {
    FalconPose pose;
    ASSERT_TRUE(falcon_angles(p, pose));
    const dvec3 force(1.0, -2.0, 0.5), velocity(0.1, 0.05, -0.2);
    dvec3 torque;
    ASSERT_TRUE(falcon_torques(pose, force, torque));
    EXPECT_NEAR(dot(torque, pose.jacobian * velocity), dot(force, velocity), 1e-12);
  }
}

TEST(FalconDelta, OutOfReachThereIsNoPoseAndNoTorque) {
  FalconPose pose;
  EXPECT_FALSE(falcon_angles({0, 0, 0.5}, pose));
  EXPECT_FALSE(falcon_angles({0.5, 0, 0.1}, pose));
  EXPECT_FALSE(falcon_angles({NAN, 0, 0.1}, pose));
  dvec3 position = kMiddle;
  EXPECT_FALSE(falcon_position({3.0, -3.0, 1.0}, position));
  EXPECT_EQ(position, kMiddle);
  EXPECT_EQ(falcon_motors({0, 0, 0.5}, {1, 1, 1}), (std::array<int, 3>{}));
  EXPECT_EQ(falcon_motors(kMiddle, {NAN, 0, 0}), (std::array<int, 3>{}));
}

TEST(FalconMotors, AForceThatIsTooLargeIsMadeSmallerAndNotTurned) {
  for (const dvec3& p : positions(50)) {
    FalconPose pose;
    ASSERT_TRUE(falcon_angles(p, pose));
    const dvec3 force(300.0, -100.0, 50.0);
    const auto motors = falcon_motors(p, force);
    int largest = 0;
    for (const int motor : motors) largest = std::max(largest, std::abs(motor));
    EXPECT_LE(largest, 4095);
    EXPECT_GE(largest, 4094);
    const dvec3 torque = dvec3(motors[0], motors[1], motors[2]) / -10000.0;
    EXPECT_NEAR(dot(glm::normalize(glm::transpose(pose.jacobian) * torque), glm::normalize(force)), 1.0, 1e-6);
  }
}

TEST(FalconFrame, AFrameIsSixteenLettersAndItsNibblesAreSmallestFirst) {
  const FalconFrame frame = falcon_command({0x1234, -1, 0}, true, 4);
  EXPECT_EQ(std::string(frame.begin(), frame.end()), std::string("<EDCBPPPPAAAAFA>"));
  const auto report = parse_falcon(frame);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->count, (std::array<int, 3>{0x1234, -1, 0}));
}

TEST(FalconFrame, TheLastWholeFrameOfAStreamCounts) {
  const auto text = [](std::string_view s) {
    return parse_falcon({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()});
  };
  EXPECT_FALSE(text(""));
  EXPECT_FALSE(text("<AAAAAAAAAAAAAA"));
  EXPECT_FALSE(text("<AAAAaAAAAAAAAA>")) << "no nibble";
  EXPECT_EQ(text("AA><BAAAAAAAAAAAAA><CAAAAAAAAAAAAA><DAA")->count[0], 2);
  EXPECT_EQ(text("<<BAAAAAAAAAAAAA>")->count[0], 1);
  const std::string homed = std::string("<AAAAAAAAAAAA") + static_cast<char>(0x41 + 0x75) + "A>";
  EXPECT_EQ(text(homed)->homed, 7u);
  EXPECT_EQ(text(homed)->buttons, 5u);
}

// The device: its boot loader and its firmware.
struct FakeFalcon {
  std::mutex mutex;
  enum { kOff, kBoot, kLoading, kRunning } state = kOff;
  std::vector<std::uint8_t> loaded;
  std::size_t size = 0;  // of the firmware that starts it
  int failures = 0;      // how often its boot loader does not answer
  bool plugged = true, silent = false, homed = true;
  dvec3 position = kMiddle;  // [m]
  std::array<int, 3> motors{};
  std::atomic<int> frames{0};
  int hellos = 0, modem_low = 0;
  int baud = 0;
  std::deque<std::vector<std::uint8_t>> out;

  void answer(std::span<const std::uint8_t> bytes) {
    for (std::size_t at = 0; at < bytes.size(); at += 62) {  // packets of 64, each with the modem's state in front
      std::vector<std::uint8_t> packet{0x01, 0x60};
      const auto part = bytes.subspan(at, std::min<std::size_t>(62, bytes.size() - at));
      packet.insert(packet.end(), part.begin(), part.end());
      out.push_back(packet);
    }
  }
  void take(std::span<const std::uint8_t> bytes) {
    const std::string text(bytes.begin(), bytes.end());
    if (state == kRunning) {
      if (silent || baud != 2 || bytes.size() != kFalconFrame) return;
      const auto command = parse_falcon(bytes);
      if (!command) return;
      motors = command->count;
      ++frames;
      FalconPose pose;
      falcon_angles(position, pose);
      std::array<int, 3> counts;
      for (int i = 0; i < 3; ++i)
        counts[static_cast<std::size_t>(i)] =
            static_cast<int>(std::lround((pose.angle[i] - falcon_angle(0)) / (falcon_angle(1) - falcon_angle(0))));
      FalconFrame frame = falcon_command(counts, false, 0);
      frame[13] = static_cast<std::uint8_t>(0x41 + (homed ? 0x70 : 0x30) + 2);
      const std::uint8_t nothing[] = {0x01, 0x60};
      out.emplace_back(nothing, nothing + 2);
      answer(std::span(frame).first(7));
      answer(std::span(frame).subspan(7));
    } else if (text == "\x0A\x43\x0D" && baud == 0x4138 && modem_low > 0) {
      ++hellos;
      if (failures-- > 0) return;
      const std::uint8_t reply[] = {0x0A, 0x44, 0x2C, 0x0D};
      answer(reply);
      state = kBoot;
    } else if (text == "A" && state == kBoot && baud == 0x15) {
      answer(bytes);
      state = kLoading;
      loaded.clear();
    } else if (state == kLoading) {
      loaded.insert(loaded.end(), bytes.begin(), bytes.end());
      answer(bytes);
      if (loaded.size() == size) state = kRunning;
    }
  }

  struct Port final : PacketPort {
    FakeFalcon& falcon;
    explicit Port(FakeFalcon& of) : falcon(of) {}
    Status send(std::span<const std::uint8_t> packet) override {
      const std::lock_guard lock(falcon.mutex);
      if (!falcon.plugged) return Error{"fake", "gone"};
      falcon.take(packet);
      return Done{};
    }
    Result<std::size_t> receive(std::span<std::uint8_t> into, double) override {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      const std::lock_guard lock(falcon.mutex);
      if (!falcon.plugged) return Error{"fake", "gone"};
      if (falcon.out.empty()) return std::size_t{0};
      const auto packet = falcon.out.front();
      falcon.out.pop_front();
      std::copy_n(packet.begin(), std::min(packet.size(), into.size()), into.begin());
      return std::min(packet.size(), into.size());
    }
    Status set_feature(std::span<const std::uint8_t> request) override {
      const std::lock_guard lock(falcon.mutex);
      if (!falcon.plugged) return Error{"fake", "gone"};
      if (request[0] == 3) falcon.baud = request[1] | request[2] << 8;
      if (request[0] == 1 && request[1] == 0 && request[2] == 1) ++falcon.modem_low;
      if (request[0] == 0) falcon.out.clear();
      return Done{};
    }
  };
  PortOpener opener() {
    return [this](const std::string&) -> Result<std::unique_ptr<PacketPort>> {
      const std::lock_guard lock(mutex);
      if (!plugged) return Error{"USB 0403:cb48", "is not there; plug it in and switch it on"};
      return std::unique_ptr<PacketPort>(std::make_unique<Port>(*this));
    };
  }
  dvec3 felt() {
    const std::lock_guard lock(mutex);
    FalconPose pose;
    falcon_angles(position, pose);
    return glm::transpose(pose.jacobian) * (dvec3(motors[0], motors[1], motors[2]) / -10000.0);
  }
};

struct FirmwareFile {
  std::string path = (std::filesystem::path(testing::TempDir()) / "falcon_firmware_test.bin").string();
  explicit FirmwareFile(std::size_t size) {
    std::ofstream file(path, std::ios::binary);
    for (std::size_t i = 0; i < size; ++i) file.put(static_cast<char>(i * 7));
  }
  ~FirmwareFile() { std::filesystem::remove(path); }
};

TEST(Falcon, ItsFirmwareIsLoadedAgainWhereItFailsAndThenForcesGoWhereTheyShould) {
  FirmwareFile file(1000);
  FakeFalcon fake;
  fake.size = 1000;
  fake.failures = 1;
  fake.position = kMiddle + dvec3(0.01, -0.02, 0.015);
  Falcon driver(fake.opener());
  const auto opened = driver.open(file.path);
  ASSERT_TRUE(opened) << opened.error().message();
  EXPECT_EQ(fake.hellos, 2);
  ASSERT_EQ(fake.loaded.size(), 1000u);
  EXPECT_EQ(fake.loaded[999], static_cast<std::uint8_t>(999 * 7));
  DeviceSample sample;
  const dvec3 force(1, 2, -1);
  ASSERT_TRUE(runs_until(driver, sample, {.force = force},
                         [&](bool came) { return came && length(fake.felt() - force) < 0.02; }));
  EXPECT_TRUE(sample.ready);
  EXPECT_NEAR(length(sample.position - dvec3(0.01, -0.02, 0.015)), 0.0, 1e-4) << "a count is about 40 um";
  EXPECT_EQ(sample.buttons, 2u);
  EXPECT_TRUE(soon([&] { return length(fake.felt()) == 0.0; })) << "a force that nobody renews is over";
  driver.close();
  EXPECT_EQ(length(fake.felt()), 0.0);
}

TEST(Falcon, AFirmwareThatRunsAlreadyIsNotLoaded) {
  FakeFalcon fake;
  fake.state = FakeFalcon::kRunning;
  setenv("XDG_DATA_HOME", "nowhere", 1);
  Falcon driver(fake.opener());
  ASSERT_TRUE(driver.open(""));
  EXPECT_EQ(fake.hellos, 0);
  unsetenv("XDG_DATA_HOME");
}

TEST(Falcon, UntilItIsHomedItsPoseIsUnknownAndItHasNoForce) {
  FirmwareFile file(100);
  FakeFalcon fake;
  fake.state = FakeFalcon::kRunning;
  fake.homed = false;
  Falcon driver(fake.opener());
  ASSERT_TRUE(driver.open(file.path));
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {0, 5, 0}}, [&](bool) { return fake.frames > 50; }));
  EXPECT_FALSE(sample.ready);
  EXPECT_EQ(length(fake.felt()), 0.0);
  {
    const std::lock_guard lock(fake.mutex);
    fake.homed = true;
  }
  EXPECT_TRUE(
      runs_until(driver, sample, {.force = {0, 5, 0}}, [&](bool) { return sample.ready && fake.felt().y > 4.9; }));
}

TEST(Falcon, AnUnpluggedOneIsFoundAgainAndGetsItsFirmwareAgain) {
  FirmwareFile file(300);
  FakeFalcon fake;
  fake.size = 300;
  Falcon driver(fake.opener());
  ASSERT_TRUE(driver.open(file.path));
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && sample.ready; }));
  {
    const std::lock_guard lock(fake.mutex);
    fake.plugged = false;
    fake.state = FakeFalcon::kOff;
    fake.motors = {};
  }
  int quiet = 0;
  ASSERT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return (quiet = came ? 0 : quiet + 1) > 100; }));
  {
    const std::lock_guard lock(fake.mutex);
    fake.plugged = true;
  }
  EXPECT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && sample.ready; }));
}

TEST(Falcon, WhatIsMissingIsOneSentence) {
  FakeFalcon fake;
  setenv("XDG_DATA_HOME", "nowhere", 1);
  EXPECT_EQ(
      Falcon(fake.opener()).open("").error().message(),
      "falcon: its firmware is not loaded, and nowhere/pliant/falcon.bin is not there; put the maker's firmware file "
      "there, or give it as `falcon:FILE`");
  unsetenv("XDG_DATA_HOME");
  EXPECT_EQ(Falcon(fake.opener()).open("no/such.bin").error().message(),
            "no/such.bin: cannot be read; give the maker's firmware file of the Falcon as `falcon:FILE`");
  FirmwareFile empty(0);
  EXPECT_FALSE(Falcon(fake.opener()).open(empty.path));
  fake.plugged = false;
  FirmwareFile file(100);
  EXPECT_EQ(Falcon(fake.opener()).open(file.path).error().message(),
            "USB 0403:cb48: is not there; plug it in and switch it on");
}

}  // namespace
}  // namespace pliant
