// The simulated device as a driver.
#include "devices/simulated/simulated_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "devices/pose_file.h"

namespace pliant {
namespace {

TEST(SimulatedDevice, EveryProfileIsListedAndOpensByItsName) {
  register_simulated();
  register_simulated();  // a second call has no effect
  std::size_t found = 0;
  for (const DeviceInfo& info : list_devices()) {
    if (info.driver != "simulated") continue;
    ++found;
    auto driver = make_driver("simulated");
    ASSERT_TRUE(driver);
    ASSERT_TRUE((*driver)->open(info.id)) << info.id;
    const DeviceCapabilities can = (*driver)->capabilities();
    EXPECT_EQ(can.max_force, info.can.max_force);
    EXPECT_GT(can.max_force, 0.0);
    EXPECT_GT(can.max_stiffness, 0.0);
    EXPECT_GE(can.rate, 1000.0);
    EXPECT_TRUE(can.continuous_force <= can.max_force);
  }
  EXPECT_EQ(found, kDeviceProfiles);
}

TEST(SimulatedDevice, ForceActsAfterTheTransportDelayAndItsPositionIsInCounts) {
  SimulatedDevice device;
  ASSERT_TRUE(device.open("touch,hand=none,clock=tick,delay=2.5ms,lag=0,friction=0,damping=0,mass=0.1,encoder=1um"));
  DeviceSample sample;
  for (int i = 0; i <= 10; ++i) {
    ASSERT_TRUE(device.read(sample));
    device.write({dvec3(1, 0, 0), dvec3(0), 0.0});
    const double since = std::max(0.0, 1e-3 * i - 2.5e-3), x = 0.5 * 1.0 / 0.1 * since * since;
    EXPECT_NEAR(device.true_position().x, x, 1e-12) << i;
    EXPECT_NEAR(sample.position.x, std::round(x * 1e6) * 1e-6, 1e-15) << i;
  }
}

TEST(SimulatedDevice, ForceSaturatesByItsNormAndComesInCounts) {
  SimulatedDevice device;
  ASSERT_TRUE(device.open("touch,hand=none,clock=tick,delay=0,lag=0,max_force=3,force_step=0.5"));
  DeviceSample sample;
  ASSERT_TRUE(device.read(sample));
  device.write({dvec3(30, 40, 0), dvec3(0), 0.0});
  EXPECT_EQ(device.motor_force(), dvec3(2, 2.5, 0)) << "3 N along (3, 4, 0), in half newtons";
  device.write({dvec3(std::nan(""), 0, 0), dvec3(0), 0.0});
  EXPECT_EQ(device.motor_force(), dvec3(0));
}

TEST(SimulatedDevice, LockstepGivesTheSameBitsEveryTime) {
  std::vector<dvec3> first;
  for (int run = 0; run < 2; ++run) {
    SimulatedDevice device;
    ASSERT_TRUE(device.open("omni,clock=tick,push=0:-0.5:0,at=0:0.001:0"));
    std::vector<dvec3> way;
    for (int i = 0; i < 500; ++i) {
      DeviceSample sample;
      ASSERT_TRUE(device.read(sample));
      way.push_back(sample.position);
      device.write({dvec3(0, std::max(0.0, -400.0 * sample.position.y), 0), dvec3(0), 0.0});
    }
    if (run == 0) first = way;
    EXPECT_EQ(way, first);
  }
}

TEST(SimulatedDevice, HandFollowsItsPathInFreeSpaceAndLagsInAWall) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "pliant_hand_path.csv";
  {
    std::ofstream out(file);
    out << "time_s,x,y,z\n0,0,0.02,0\n1,0,-0.02,0\n2,0,-0.02,0\n";
  }
  for (const double K : {0.0, 400.0}) {
    SimulatedDevice device;
    ASSERT_TRUE(device.open("falcon,clock=tick,path=" + file.string()));
    DeviceSample sample;
    for (int i = 0; i < 2000; ++i) {
      ASSERT_TRUE(device.read(sample));
      device.write({dvec3(0, std::max(0.0, -K * sample.position.y), 0), dvec3(0), 0.0});
    }
    // Springs in series: wall K, grip and arm, within the bound of friction.
    const HandImpedance& hand = device.options().hand;
    const double k = 1.0 / (1.0 / hand.arm_stiffness + 1.0 / hand.grip_stiffness), rest = -0.02 * k / (k + K);
    EXPECT_NEAR(sample.position.y, rest, device.options().profile.friction / (k + K) + 1e-4) << K;
  }
  std::filesystem::remove(file);
}

// Asserts no timing, only that samples are those of its own clock, whenever it is read.
TEST(SimulatedDevice, OnTheWallClockSamplesComeAtItsRateHoweverOftenItIsAsked) {
  SimulatedDevice device;
  ASSERT_TRUE(device.open("omega.7"));
  double last = 0.0;
  int came = 0;
  const auto begin = std::chrono::steady_clock::now();
  while (came < 20 && std::chrono::steady_clock::now() - begin < std::chrono::seconds(20)) {
    DeviceSample sample;
    if (!device.read(sample)) continue;
    if (came > 0) {
      const double periods = (sample.time - last) * 4000.0;
      EXPECT_GT(periods, 0.999);
      EXPECT_NEAR(periods, std::round(periods), 1e-3);
    }
    last = sample.time;
    ++came;
  }
  EXPECT_EQ(came, 20);
}

TEST(SimulatedDevice, WorkspaceEndsInStopsWhereItSaysSo) {
  for (const bool stops : {true, false}) {
    SimulatedDevice device;
    ASSERT_TRUE(
        device.open(std::string("falcon,hand=none,clock=tick,friction=0,push=0:4:0,stops=") + (stops ? "on" : "off")));
    DeviceSample sample;
    for (int i = 0; i < 1500; ++i) ASSERT_TRUE(device.read(sample));
    if (stops)
      EXPECT_NEAR(device.true_position().y, 0.05 + 4.0 / kStopStiffness, 1e-6);
    else
      EXPECT_GT(device.true_position().y, 1.0);
  }
}

TEST(SimulatedDevice, TorqueTurnsItsGripByItsInertiaAlone) {
  SimulatedOptions options = *parse_simulated("sigma.7,hand=none,clock=tick,delay=0,lag=0");
  options.profile.turn_damping = options.profile.turn_friction = options.profile.turn_encoder = 0.0;
  SimulatedDevice device(options);
  ASSERT_TRUE(device.open(""));
  DeviceSample sample;
  const dvec3 torque(0, 0, 0.01);
  for (int i = 0; i <= 100; ++i) {
    ASSERT_TRUE(device.read(sample));
    device.write({dvec3(0), torque, 0.0});
  }
  const double t = 100.0 / options.profile.rate, angle = 0.5 * torque.z / options.profile.inertia * t * t;
  EXPECT_NEAR(device.true_turn().z, angle, 1e-12);
  EXPECT_NEAR(2.0 * std::atan2(sample.rotation.z, sample.rotation.w), angle, 1e-12) << "about world z, right-handed";
  EXPECT_NEAR(length(device.true_position()), 0.0, 1e-15);
  device.write({dvec3(0), dvec3(3, 4, 0), 0.0});
  EXPECT_NEAR(length(device.motor_torque() - dvec3(0.12, 0.16, 0)), 0.0, 1e-15) << "0.2 N m, by the norm";
}

TEST(SimulatedDevice, HandHoldsATurnAgainstATorqueByGripAndWristInSeries) {
  for (const char* name : {"finger", "relaxed", "firm"}) {
    SimulatedOptions options = *parse_simulated(std::string("sigma.7,clock=tick,hand=") + name);
    options.profile.turn_friction = 0.0;
    options.will.path.rows = {{0.0, dvec3(0), glm::angleAxis(1.0, dvec3(1, 0, 0))}};
    SimulatedDevice device(options);
    ASSERT_TRUE(device.open(""));
    EXPECT_TRUE(device.capabilities().renders_torque);
    DeviceSample sample;
    const dvec3 torque(0, 0.02, 0);
    for (int i = 0; i < 4 * 12000; ++i) {
      ASSERT_TRUE(device.read(sample));
      device.write({dvec3(0), torque, 0.0});
    }
    const HandImpedance wrist = turning(options.hand);
    const double angle = torque.y * (1.0 / wrist.arm_stiffness + 1.0 / wrist.grip_stiffness);
    EXPECT_NEAR(device.true_turn().y, angle, 1e-6) << name;
    const dquat expected = glm::angleAxis(angle, dvec3(0, 1, 0)) * glm::angleAxis(1.0, dvec3(1, 0, 0));
    EXPECT_NEAR(std::abs(glm::dot(sample.rotation, expected)), 1.0, 1e-7) << name;
  }
  SimulatedDevice without;
  ASSERT_TRUE(without.open("touch"));
  EXPECT_FALSE(without.capabilities().renders_torque);
}

TEST(SimulatedDevice, BadWordsGetOneSentence) {
  const struct {
    const char* id;
    const char* part;
  } bad[] = {{"fantom", "profiles are: touch"},
             {"touch,hand=strong", "none, finger, relaxed, firm"},
             {"touch,clock=fast", "wall, tick"},
             {"touch,delay=2", "up to 1s"},
             {"touch,delay=-1ms", "up to 1s"},
             {"touch,mass=0", "0.001 to 100 kg"},
             {"touch,rate=nan", "10 to 20000 Hz"},
             {"touch,lag=0.001us", "lag must be 0 or at least 10us"},
             {"touch,mass=0.001,damping=1000", "give more mass"},
             {"touch,push=0:2e3:0", "at most 1000 N"},
             {"touch,at=1e300:0:0", "at most 10 m"},
             {"touch,stops=maybe", "on, off"},
             {"touch,max_torque=0.1", "take sigma.7"},
             {"touch,weight=3", "unknown key 'weight'"},
             {"touch,omni", "unknown profile 'omni'"},
             {"touch,push=1:2", "three numbers"},
             {"touch,path=/nowhere.csv", "cannot be opened"}};
  for (const auto& [id, part] : bad) {
    SimulatedDevice device;
    const Status status = device.open(id);
    ASSERT_FALSE(status) << id;
    EXPECT_THAT(status.error().message(), testing::HasSubstr(part)) << id;
  }
}

TEST(PoseFile, BadLinesAreNamed) {
  for (const auto& [text, part] : {std::pair("", "holds no rows"),
                                   {"a,b\n", ":1: the header"},
                                   {"time_s,x,y,z\n0,1,2\n", ":2: this row is not 4"},
                                   {"time_s,x,y,z\n0,1,2,3\n0,1,2,3\n", ":3: time does not grow"},
                                   {"time_s,x,y,z\n0,1,2,inf\n", ":2: this row"},
                                   {"time_s,x,y,z,qw,qx,qy,qz\n0,1,2,3,0,0,0,0\n", ":2: the quaternion"}}) {
    const auto rows = parse_poses(text, "file.csv");
    ASSERT_FALSE(rows) << text;
    EXPECT_THAT(rows.error().message(), testing::HasSubstr(part));
  }
}

}  // namespace
}  // namespace pliant
