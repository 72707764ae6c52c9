#include "devices/drivers/network_device.h"

#include <gtest/gtest.h>

#include "tests/drivers/network_bench.h"

namespace pliant {
namespace {

// One tick of either side. True: a sample came.
bool tick(NetworkBench& bench, NetworkDevice& driver, DeviceSample& sample, dvec3 force) {
  bench.step();
  const bool came = driver.read(sample);
  driver.write({.force = force});
  return came;
}

TEST(NetworkDevice, PosesComeAndForcesGo) {
  NetworkBench bench;
  bench.pose.sample.position = {0.01, 0.02, 0.03};
  bench.pose.sample.buttons = 2;
  NetworkDevice driver = bench.driver();
  ASSERT_TRUE(driver.open(""));
  EXPECT_EQ(driver.name(), "bench");
  EXPECT_NEAR(driver.capabilities().max_force, 4.0, 1e-6);
  DeviceSample sample;
  for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {0, 1.5, 0});
  EXPECT_NEAR(length(sample.position - dvec3(0.01, 0.02, 0.03)), 0.0, 1e-8);
  EXPECT_TRUE(sample.ready);
  EXPECT_EQ(sample.buttons, 2u);
  EXPECT_NEAR(sample.time, bench.time, 1e-5) << "of our clock, though the device's is another";
  EXPECT_EQ(bench.felt.force, dvec3(0, 1.5, 0));
  EXPECT_NEAR(driver.round_trip(), 1e-3, 1e-6);
  driver.close();
  bench.step();
  EXPECT_EQ(bench.felt.force, dvec3(0));
  EXPECT_FALSE(bench.device->opened());
}

TEST(NetworkDevice, TheModelIsRenderedWhereTheDeviceIsAndNoFartherThanItsRadius) {
  NetworkBench bench;
  NetworkDevice driver = bench.driver();
  ASSERT_TRUE(driver.open(""));
  DeviceSample first;
  for (int i = 0; i < 5; ++i) tick(bench, driver, first, {});
  DeviceModel model;
  model.wrench.force = {0, 0.5, 0};
  model.force_by_position = dmat3(0, 0, 0, 0, -100, 0, 0, 0, 0);
  model.force_by_velocity = dmat3(-2.0);
  bench.pose.velocity = {0.125, 0, 0};
  bench.pose.sample.position = {0, -0.0078125, 0};
  const auto felt = [&] {
    EXPECT_TRUE(driver.write_model(model, {.force = {9, 9, 9}}));
    bench.step();
    DeviceSample sample;
    driver.read(sample);
    return bench.felt.force;
  };
  EXPECT_NEAR(length(felt() - dvec3(-0.25, 0.5 + 0.78125, 0)), 0.0, 1e-6);
  bench.pose.sample.position = {0, -0.5, 0};  // far outside: treated as 10 mm away
  EXPECT_NEAR(length(felt() - dvec3(-0.25, 1.5, 0)), 0.0, 1e-6);
  model.wrench.force = {0, 1000, 0};
  EXPECT_NEAR(length(felt()), 4.0, 1e-6) << "the device says that it renders 4 N";
}

TEST(NetworkDevice, OfAModelOfATurnTheAngleCountsWhicheverSignTheQuaternionHas) {
  DeviceModel model;
  model.rotation = glm::angleAxis(0.3, dvec3(0, 0, 1));
  model.torque_by_turn = dmat3(-2.0);
  model.torque_by_spin = dmat3(-0.5);
  model.force_by_turn = dmat3(1.0);
  StateFrame at;
  at.spin = {0, 0, 1};
  for (const double sign : {1.0, -1.0}) {
    at.sample.rotation = sign * glm::angleAxis(0.5, dvec3(0, 0, 1));
    const DeviceWrench wrench = model_wrench(model, 0.01, at);
    EXPECT_NEAR(length(wrench.torque - dvec3(0, 0, -2.0 * 0.2 - 0.5)), 0.0, 1e-12);
    EXPECT_NEAR(length(wrench.force - dvec3(0, 0, 0.2)), 0.0, 1e-12);
  }
}

TEST(NetworkDevice, SilenceOfTwentyMillisecondsIsZeroForceOnEitherSide) {
  NetworkBench bench;
  NetworkDevice driver = bench.driver();
  ASSERT_TRUE(driver.open(""));
  DeviceSample sample;
  for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {0, 2, 0});
  ASSERT_EQ(bench.felt.force, dvec3(0, 2, 0));
  // The engine stops: the device lets go.
  const double begin = bench.time;
  while (length(bench.felt.force) > 0.0 && bench.time - begin < 1.0) bench.step();
  EXPECT_NEAR(bench.time - begin, 0.021, 1.5e-3);
  while (driver.read(sample)) {
  }
  // The device stops: zero is sent to it, although another force is written to the driver.
  for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {0, 2, 0});
  ASSERT_EQ(bench.felt.force, dvec3(0, 2, 0));
  bench.to_device.clear();
  const auto device = std::move(bench.device);
  int still = 0;
  for (int i = 0; i < 100; ++i) {
    bench.time += 1e-3;
    EXPECT_FALSE(driver.read(sample) && i > 0);
    bench.to_device.clear();
    driver.write({.force = {0, 2, 0}});
    NetworkFrame sent;
    const auto& packet = bench.to_device.back().packet;
    ASSERT_EQ(parse_frame(packet, sent), FrameFault::kNone);
    if (length(sent.force.wrench.force) > 0.0) ++still;
  }
  EXPECT_LE(still, 21);
  EXPECT_GE(still, 18);
}

TEST(NetworkDevice, ALineThatDelaysIsAsGoodAsNone) {
  for (const bool to_device : {false, true}) {
    NetworkBench bench;
    NetworkDevice driver = bench.driver();
    ASSERT_TRUE(driver.open(""));
    DeviceSample sample;
    for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {0, 2, 0});
    ASSERT_GT(bench.felt.force.y, 0.0);
    (to_device ? bench.to_device_delay : bench.to_engine_delay) = 0.2;
    for (int i = 0; i < 400; ++i) {
      const bool came = tick(bench, driver, sample, {0, 2, 0});
      if (i < 60) continue;
      EXPECT_EQ(bench.felt.force, dvec3(0)) << "to the device " << to_device << ", tick " << i;
      EXPECT_FALSE(came && sample.ready) << "to the device " << to_device << ", tick " << i;
    }
  }
}

TEST(NetworkDevice, ADelayThatWasThereFromTheStartIsFoundToo) {
  NetworkBench bench;
  bench.to_device_delay = bench.to_engine_delay = 0.1;
  NetworkDevice driver = bench.driver();
  ASSERT_TRUE(driver.open("")) << "it can be opened";
  DeviceSample sample;
  for (int i = 0; i < 1000; ++i) {
    const bool came = tick(bench, driver, sample, {0, 2, 0});
    ASSERT_EQ(bench.felt.force, dvec3(0)) << i;
    if (i > 300) {
      ASSERT_FALSE(came && sample.ready) << i;
    }
  }
  EXPECT_NEAR(driver.round_trip(), 0.2, 5e-3);
}

TEST(NetworkDevice, DoubledOvertakenForeignAndDamagedFramesAreDroppedAndCounted) {
  NetworkBench bench;
  NetworkDevice driver = bench.driver();
  ASSERT_TRUE(driver.open(""));
  DeviceSample sample;
  for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {0, 1, 0});
  const FrameCounts before = driver.counts(), heard_before = bench.device->counts();
  NetworkBench::Packet old;
  int n = 0;
  bench.carry = [&](auto& wire, double due, const NetworkBench::Packet& packet) {
    wire.push_back({due, packet});
    wire.push_back({due, packet});  // doubled
    if (n++ < 2) old = packet;
    auto stranger = packet;
    stranger[0] ^= 0xFF;  // not ours
    wire.push_back({due, stranger});
    auto cut = packet;
    cut.resize(40);  // truncated
    wire.push_back({due, cut});
  };
  for (int i = 0; i < 10; ++i) {
    bench.pose.sample.position.x += 1e-3;
    ASSERT_TRUE(tick(bench, driver, sample, {0, 1, 0}));
    EXPECT_NEAR(sample.position.x, bench.pose.sample.position.x, 1e-7);
    EXPECT_EQ(bench.felt.force, dvec3(0, 1, 0));
  }
  FrameCounts counts = driver.counts();
  EXPECT_EQ(counts.accepted - before.accepted, 10u);
  EXPECT_EQ(counts.late - before.late, 10u);
  EXPECT_EQ(counts.unknown - before.unknown, 10u);
  EXPECT_EQ(counts.too_short - before.too_short, 10u);
  EXPECT_EQ(counts.dropped() - before.dropped(), 30u);
  EXPECT_EQ(counts.lost, before.lost);
  bench.step();
  const FrameCounts& heard = bench.device->counts();
  EXPECT_EQ(heard.late - heard_before.late, 10u);
  EXPECT_EQ(heard.too_short - heard_before.too_short, 10u);
  // One that was overtaken by nine others.
  bench.carry = [](auto& wire, double due, const NetworkBench::Packet& p) { wire.push_back({due, p}); };
  driver.read(sample);
  bench.to_engine.push_back({bench.time, old});
  counts = driver.counts();
  EXPECT_FALSE(driver.read(sample));
  EXPECT_EQ(driver.counts().late + driver.counts().foreign, counts.late + counts.foreign + 1);
  // Three that never came.
  for (int i = 0; i < 3; ++i) bench.step();
  bench.to_engine.clear();
  tick(bench, driver, sample, {});
  EXPECT_EQ(driver.counts().lost - counts.lost, 3u);
}

TEST(NetworkDevice, AnotherDevicesFramesAreNotTakenForThisOnes) {
  NetworkBench bench;
  NetworkDevice driver = bench.driver();
  ASSERT_TRUE(driver.open(""));
  DeviceSample sample;
  for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {});
  NetworkFrame forged;
  forged.kind = FrameKind::kState;
  forged.session = 12345;
  forged.sequence = 1000000;
  forged.state.sample.position = {1, 1, 1};
  FrameBytes bytes;
  const std::size_t size = write_frame(forged, bytes);
  bench.to_engine.clear();
  bench.to_engine.push_back({bench.time, {bytes.begin(), bytes.begin() + static_cast<long>(size)}});
  EXPECT_FALSE(driver.read(sample));
  EXPECT_EQ(driver.counts().foreign, 1u);
}

TEST(NetworkDevice, ADeviceThatWasStartedAgainIsFoundAndItsOldForceIsForgotten) {
  NetworkBench bench;
  NetworkDevice driver = bench.driver();
  ASSERT_TRUE(driver.open(""));
  DeviceSample sample;
  for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {0, 2, 0});
  bench.device.reset();
  bench.felt = {};
  bench.to_device.clear();
  bench.device_clock = 1.0;  // its clock restarts as well
  bench.start_device();
  int until = -1;
  for (int i = 0; i < 300 && until < 0; ++i) {
    const bool came = tick(bench, driver, sample, {0, 2, 0});
    if (came && sample.ready && bench.felt.force.y > 0.0) until = i;
  }
  EXPECT_GT(until, 0);
  EXPECT_LE(until, 150) << "[ms] it is opened ten times a second";
}

TEST(NetworkDevice, AClockThatRunsBackwardsIsNotBelieved) {
  NetworkBench bench;
  NetworkDevice driver = bench.driver();
  ASSERT_TRUE(driver.open(""));
  DeviceSample sample;
  for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {});
  bench.device_clock -= 1.0;
  EXPECT_FALSE(tick(bench, driver, sample, {}));
  EXPECT_EQ(driver.counts().late, 1u);
}

TEST(NetworkDevice, AnEmergencyStopOrHotMotorsAreAPoseThatIsNotReady) {
  NetworkBench bench;
  NetworkDevice driver = bench.driver();
  ASSERT_TRUE(driver.open(""));
  DeviceSample sample;
  for (bool StateFrame::*fault : {&StateFrame::stopped, &StateFrame::hot}) {
    bench.pose.*fault = true;
    for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {0, 1, 0});
    EXPECT_FALSE(sample.ready);
    EXPECT_EQ(bench.felt.force, dvec3(0));
    bench.pose.*fault = false;
    for (int i = 0; i < 5; ++i) tick(bench, driver, sample, {0, 1, 0});
    EXPECT_TRUE(sample.ready);
  }
}

TEST(NetworkDevice, ASecondEngineWaitsUntilTheFirstHasLeft) {
  NetworkBench bench;
  NetworkDevice first = bench.driver(), second = bench.driver();
  ASSERT_TRUE(first.open(""));
  DeviceSample sample;
  for (int i = 0; i < 5; ++i) tick(bench, first, sample, {0, 1, 0});
  NetworkFrame open;
  open.kind = FrameKind::kOpen;
  open.session = 99;
  FrameBytes bytes;
  const std::size_t size = write_frame(open, bytes);
  bench.to_device.push_back({bench.time, {bytes.begin(), bytes.begin() + static_cast<long>(size)}});
  for (int i = 0; i < 5; ++i) tick(bench, first, sample, {0, 1, 0});
  EXPECT_EQ(bench.felt.force, dvec3(0, 1, 0));
  EXPECT_EQ(bench.device->counts().foreign, 1u);
  const auto opened = second.open("");  // the first does not respond now, and times out after a second
  EXPECT_TRUE(opened) << opened.error().message();
}

TEST(NetworkDevice, NobodyThereIsOneSentence) {
  NetworkBench bench;
  bench.device.reset();
  NetworkDevice driver = bench.driver();
  const auto opened = driver.open("10.0.0.7:5000");
  ASSERT_FALSE(opened);
  EXPECT_EQ(
      opened.error().message(),
      "network device `10.0.0.7:5000`: does not answer; start the device, give its own PORT or ADDRESS:PORT, and its "
      "key if it has one (,key=FILE)");
  DeviceSample sample;
  EXPECT_FALSE(driver.read(sample));
  driver.write({});
  driver.close();
}

}  // namespace
}  // namespace pliant
