// What somebody on the line of a keyed device can do: keep frames and send them again, at any later time, or send
// frames of another key. Nothing of it is a force, all of it is counted, and it is said in words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>

#include "tests/drivers/network_bench.h"

namespace pliant {
namespace {

using testing::HasSubstr;
using Packets = std::vector<NetworkBench::Packet>;

FrameKey key_of(const std::string& secret) {
  return FrameKey({reinterpret_cast<const std::uint8_t*>(secret.data()), secret.size()});
}
const std::string kSecret = "a secret of some length", kOther = "another one, as long as it";

// A keyed device and its engine, and everything that has passed between them.
struct Tapped {
  NetworkBench bench{key_of(kSecret)};
  NetworkDevice driver = bench.driver();
  Packets to_device, to_engine;
  DeviceSample sample;

  Tapped() {
    ::setenv("PLIANT_TEST_KEY", kSecret.c_str(), 1);
    ::setenv("PLIANT_TEST_OTHER_KEY", kOther.c_str(), 1);
    bench.carry = [this](auto& wire, double due, const NetworkBench::Packet& packet) {
      wire.push_back({due, packet});
      (&wire == &bench.to_device ? to_device : to_engine).push_back(packet);
    };
  }
  void open() { ASSERT_TRUE(driver.open(",key-env=PLIANT_TEST_KEY")); }
  bool tick(dvec3 force) {
    driver.write({.force = force});
    bench.step();
    return driver.read(sample);
  }
  void press(int ticks, dvec3 force = {0, 2, 0}) {
    for (int i = 0; i < ticks; ++i) tick(force);
    ASSERT_EQ(bench.felt.force, force);
  }
  NetworkFrame last_to_device() const {
    NetworkFrame frame;
    const FrameKey key = key_of(kSecret);
    EXPECT_EQ(parse_frame(to_device.back(), frame, &key), FrameFault::kNone);
    return frame;
  }
  void send(NetworkFrame frame, const FrameKey& key) {
    FrameBytes bytes;
    const std::size_t size = write_frame(frame, bytes, &key);
    bench.to_device.push_back({bench.time, {bytes.begin(), bytes.begin() + static_cast<long>(size)}});
  }
};

TEST(NetworkAttack, AFrameThatWasKeptIsNoForceInItsOwnSession) {
  Tapped line;
  line.open();
  line.press(200);
  const Packets kept = std::exchange(line.to_device, {});
  for (int i = 0; i < 5; ++i) line.tick({});
  const FrameCounts before = line.bench.device->counts();
  std::uint64_t forces = 0;
  for (const NetworkBench::Packet& packet : kept) {
    line.bench.to_device.push_back({line.bench.time, packet});
    line.tick({});
    ASSERT_EQ(line.bench.felt.force, dvec3(0));
    ++forces;
  }
  const FrameCounts after = line.bench.device->counts();
  // Its questions are answered, and change nothing.
  EXPECT_GE(after.late - before.late, forces - 3);
  EXPECT_TRUE(line.bench.device->opened());
  line.press(5);
}

// Half a round of sequences later the numbers of an old frame would follow; its time does not.
TEST(NetworkAttack, AFrameThatWasKeptFromHalfARoundAgoIsKnownByItsTime) {
  Tapped line;
  line.open();
  line.press(50);
  const NetworkBench::Packet kept = line.to_device.back();
  NetworkFrame ahead = line.last_to_device();
  ahead.sequence += 0x7fffffffu;
  ahead.time_us += 1000;
  ahead.force = {};
  line.send(ahead, key_of(kSecret));
  line.bench.step();
  ASSERT_EQ(line.bench.felt.force, dvec3(0));
  ahead.sequence += 2;  // now the kept one comes after it
  ahead.time_us += 1000;
  line.send(ahead, key_of(kSecret));
  line.bench.step();
  const FrameCounts before = line.bench.device->counts();
  line.bench.to_device.push_back({line.bench.time, kept});
  line.bench.step();
  EXPECT_EQ(line.bench.felt.force, dvec3(0));
  EXPECT_EQ(line.bench.device->counts().late - before.late, 1u);
}

TEST(NetworkAttack, AFrameThatWasKeptIsNoForceInALaterSession) {
  enum class After { kClose, kSilence, kRestart };
  for (const After after : {After::kClose, After::kSilence, After::kRestart}) {
    Tapped line;
    line.open();
    line.press(100);
    const Packets kept = std::exchange(line.to_device, {});
    if (after == After::kClose) line.driver.close();
    if (after == After::kRestart) line.bench.start_device(key_of(kSecret));
    for (int i = 0; i < 1100; ++i) line.bench.step();
    EXPECT_FALSE(line.bench.device->opened());
    // Nobody has it: a kept open frame, with everything that came behind it, opens nothing.
    const auto replay = [&] {
      const FrameCounts before = line.bench.device->counts();
      for (const NetworkBench::Packet& packet : kept) {
        line.bench.to_device.push_back({line.bench.time, packet});
        line.bench.step();
        ASSERT_EQ(line.bench.felt.force, dvec3(0));
      }
      EXPECT_GE(line.bench.device->counts().foreign - before.foreign, kept.size() - 2);
    };
    replay();
    EXPECT_FALSE(line.bench.device->opened());
    // The engine has it anew.
    line.bench.to_engine.clear();
    line.open();
    for (int i = 0; i < 5; ++i) line.tick({});
    replay();
    line.press(5);
  }
}

TEST(NetworkAttack, AStateThatWasKeptIsNoPoseAndIsSaid) {
  Tapped line;
  line.bench.pose.sample.position = {0.05, 0, 0};
  line.open();
  line.press(50);
  const Packets kept = std::exchange(line.to_engine, {});
  line.bench.pose.sample.position = {0, 0, 0};
  for (int i = 0; i < 3; ++i) line.tick({});
  const std::uint64_t before = line.driver.dropped().late;
  for (const NetworkBench::Packet& packet : kept) line.bench.to_engine.push_back({line.bench.time, packet});
  line.tick({});
  EXPECT_EQ(line.sample.position, dvec3(0));
  EXPECT_GE(line.driver.dropped().late - before, 50u);
  EXPECT_THAT(describe(line.driver.dropped()), HasSubstr("doubled, overtaken or replayed"));
}

TEST(NetworkAttack, AnEngineWithAnotherKeyMovesNothingIsCountedAndGetsTheReason) {
  Tapped line;
  const Status opened = line.driver.open(",key-env=PLIANT_TEST_OTHER_KEY");
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message(),
              HasSubstr("does not answer to this key; start the device, and give it the same"));
  EXPECT_FALSE(line.bench.device->opened());
  EXPECT_GT(line.bench.device->counts().key, 10u);
  EXPECT_EQ(line.bench.felt.force, dvec3(0));
  EXPECT_TRUE(line.to_engine.empty()) << "the device says nothing to whoever sends it";
}

// In the middle of a press: neither another's force comes in, nor does the engine's end.
TEST(NetworkAttack, FramesOfAnotherKeyInTheMiddleOfAPressAreCountedAndChangeNothing) {
  Tapped line;
  line.open();
  line.press(50);
  const FrameCounts before = line.bench.device->counts();
  for (int i = 0; i < 100; ++i) {
    line.driver.write({.force = {0, 2, 0}});
    NetworkFrame forged = line.last_to_device();
    forged.sequence += 1000;
    forged.force.wrench.force = {0, 0, -3};
    line.send(forged, key_of(kOther));
    forged.kind = FrameKind::kClose;
    line.send(forged, key_of(kOther));
    line.bench.step();
    line.driver.read(line.sample);
    ASSERT_EQ(line.bench.felt.force, dvec3(0, 2, 0));
  }
  EXPECT_EQ(line.bench.device->counts().key - before.key, 200u);
  EXPECT_TRUE(line.bench.device->opened());
}

// A device that was started again with another key, under a force: it renders nothing, and the engine says why.
TEST(NetworkAttack, ADeviceThatComesBackWithAnotherKeyRendersNothing) {
  Tapped line;
  line.open();
  line.press(50);
  line.bench.start_device(key_of(kOther));
  line.bench.felt = {};
  for (int i = 0; i < 3000; ++i) {
    EXPECT_FALSE(line.tick({0, 2, 0}) && i > 3);
    ASSERT_EQ(line.bench.felt.force, dvec3(0));
  }
  EXPECT_GT(line.bench.device->counts().key, 2000u);
  // An answer in its name without the right key is dropped, counted and said, with the cure.
  NetworkFrame forged;
  forged.kind = FrameKind::kState;
  forged.session = 5;
  FrameBytes bytes;
  const FrameKey other = key_of(kOther);
  const std::size_t size = write_frame(forged, bytes, &other);
  line.bench.to_engine.push_back({line.bench.time, {bytes.begin(), bytes.begin() + static_cast<long>(size)}});
  line.tick({});
  EXPECT_EQ(line.driver.dropped().key, 1u);
  EXPECT_THAT(describe(line.driver.dropped()), HasSubstr("1 without the right key"));
  EXPECT_THAT(cure_for(line.driver.dropped()), HasSubstr("give both sides the same key"));
}

}  // namespace
}  // namespace pliant
