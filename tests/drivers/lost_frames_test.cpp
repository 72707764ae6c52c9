// A device that renders the model itself receives no frames for as long as its watchdog allows. The force from the last
// model stays within the guard's limits, wherever the hand moves meanwhile.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "devices/servo/servo.h"
#include "tests/drivers/network_bench.h"

namespace pliant {
namespace {

// A hand at the device's end of the wire; driver, servo and guard at the other; a wall at y = 0 in the touch tick.
// Frames to the device are lost in bursts.
struct LossyLine {
  NetworkBench bench;
  std::unique_ptr<Servo> servo;
  double lost_until = 0.0;  // [s]
  double largest = 0.0, largest_torque = 0.0, largest_grip = 0.0;
  std::uint64_t frames = 0;

  explicit LossyLine(const DeviceCapabilities& can, const GuardParameters& guard) {
    const auto carry = bench.carry;
    bench.device = std::make_unique<NetworkEndpoint>(std::make_unique<NetworkBench::Port>(bench, false), can, "lossy",
                                                     [this] { return bench.time + bench.device_clock; });
    bench.carry = [this, carry](auto& wire, double due, const NetworkBench::Packet& packet) {
      if (&wire == &bench.to_device && bench.time < lost_until) return;
      carry(wire, due, packet);
    };
    servo =
        std::make_unique<Servo>(std::make_unique<NetworkDevice>(bench.opener(), [this] { return bench.time; }), guard);
    EXPECT_TRUE(servo->open(""));
  }

  void tick(dvec3 position, dvec3 velocity, const DeviceModel& model) {
    bench.pose.sample.position = position;
    bench.pose.velocity = velocity;
    DeviceSample sample;
    servo->read(sample);
    servo->write_model(model, model.wrench);
    servo->period(bench.time);
    bench.step();
    largest = std::max(largest, length(bench.felt.force));
    largest_torque = std::max(largest_torque, length(bench.felt.torque));
    largest_grip = std::max(largest_grip, std::abs(bench.felt.grip));
  }
};

// The touch tick's model at `at`: a wall with friction and damping, or a tool's coupling to a handle.
DeviceModel law(dvec3 at, dvec3 velocity, double stiffness, bool tool, double limit) {
  DeviceModel model;
  model.position = at;
  model.max_force = limit;
  model.max_torque = 0.05;
  if (tool) {
    model.velocity = 0.9 * velocity;
    model.wrench.force = -stiffness * 2e-3 * dvec3(1, 1, 0);
    model.wrench.torque = dvec3(0.02, 0, 0);
    model.force_by_position = dmat3(-stiffness);
    model.force_by_turn = dmat3(0.05 * stiffness);
    model.torque_by_position = glm::transpose(model.force_by_turn);
    model.torque_by_turn = dmat3(-1.0);
    model.torque_by_spin = dmat3(-0.1);
    model.force_by_velocity = dmat3(-5.0);
  } else if (at.y < 0.0) {
    model.wrench.force = dvec3(0.3 * stiffness * at.y, -stiffness * at.y, 0);
    model.force_by_position[1][1] = -stiffness;
    model.force_by_position[0][0] = model.force_by_position[2][2] = -0.5 * stiffness;
    model.force_by_velocity = dmat3(-5.0);
  }
  return model;
}

TEST(LostFrames, WhatADeviceMakesOfItsLastModelKeepsToTheLimitsWhateverIsLost) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  int rendered = 0;
  for (const bool tool : {false, true})
    for (const double limit : {1.0, 3.3})
      for (const double stiffness : {200.0, 600.0, 5000.0})
        for (const double said : {0.0, 800.0})
          for (const double speed : {0.05, 0.5, 1.9}) {
            DeviceCapabilities can{.senses_rotation = true,
                                   .renders_torque = true,
                                   .max_force = 20.0,
                                   .max_torque = 1.0,
                                   .max_stiffness = said,
                                   .workspace = {0.3, 0.3, 0.3},
                                   .rate = 1000.0};
            LossyLine line(can, {});
            double phase = 0.0;
            const double amplitude = std::max(0.003, std::min(0.1, 0.02 * speed / 0.5));
            for (int i = 0; i < 2500; ++i) {
              const bool warming = i < 400;
              // To and fro, in and out of the wall, at up to `speed`; it rotates as fast as a hand can.
              if (!warming) phase += 1e-3 * speed / amplitude;
              const dvec3 at(0.3 * amplitude * std::cos(1.7 * phase), amplitude * (0.3 + std::sin(phase)) * 0.7, 0.0);
              const dvec3 velocity(0.0, 0.7 * speed * std::cos(phase), 0.0);
              line.bench.pose.sample.rotation =
                  glm::angleAxis(warming ? 0.0 : 1.5 * std::sin(3.0 * phase), dvec3(0, 0, 1));
              line.bench.pose.spin = {0, 0, warming ? 0.0 : 20.0};
              if (!warming && line.bench.time > line.lost_until + 0.03 && chance(random) < 0.02)
                line.lost_until = line.bench.time + 0.001 * (2 + std::floor(17 * chance(random)));
              DeviceModel model = law(at, velocity, stiffness, tool, limit);
              if (warming) model.wrench = {}, model.force_by_position = dmat3(0.0);
              line.tick(at, velocity, model);
            }
            const std::string who = testing::PrintToString(std::array{double(tool), limit, stiffness, said, speed});
            EXPECT_LE(line.largest, limit) << who;
            EXPECT_LE(line.largest_torque, 0.05 * (1 + 1e-6)) << who;
            rendered += line.largest > 0.2 * limit;
          }
  EXPECT_GT(rendered, 20) << "it does render";
}

// The guard's own limit (--max-force) applies like the level's.
TEST(LostFrames, AForceThatIsAtItsLimitDoesNotRiseAndEndsWhereTheSurfaceIsLeft) {
  LossyLine line({.max_force = 20.0, .workspace = {0.3, 0.3, 0.3}, .rate = 1000.0}, {.max_force = 1.0});
  for (int i = 0; i < 500; ++i) line.tick({1e-5 * (i % 3), 0.001, 0}, {}, law({0, 0.001, 0}, {}, 400.0, false, 3.3));
  dvec3 at{0, 0.001, 0};
  for (int i = 0; i < 400; ++i) {  // 6 mm deep: 2.4 N are wanted, 1 N leaves
    at.y = std::max(-0.006, 0.001 - 2e-5 * i);
    at.x = 1e-5 * (i % 3);
    DeviceModel model = law(at, {}, 400.0, false, 3.3);
    model.wrench.force.x = 0.0;
    line.tick(at, {}, model);
  }
  ASSERT_NEAR(length(line.bench.felt.force), 1.0, 1e-3);
  line.lost_until = 1e9;
  for (int i = 0; i < 15; ++i) {  // out, at 2 m/s
    at.y += 0.002;
    line.tick(at, {0, 2, 0}, law(at, {}, 400.0, false, 3.3));
    EXPECT_LE(length(line.bench.felt.force), 1.0);
    EXPECT_GE(line.bench.felt.force.y, 0.0) << "it does not pull";
    if (at.y > 0.003) EXPECT_LT(length(line.bench.felt.force), 0.02) << at.y << ": nothing is touched there";
  }
}

TEST(LostFrames, ALowBatteryFadesTheForceOfANetworkDevice) {
  LossyLine line({.max_force = 4.0, .workspace = {0.1, 0.1, 0.1}, .rate = 1000.0}, {});
  int count = 0;
  const auto tick = [&](double force) {
    DeviceModel model;
    model.max_force = 3.3;
    model.wrench.force.y = force;
    line.tick({1e-5 * (++count % 3), 0, 0}, {}, model);
  };
  for (int i = 0; i < 500; ++i) tick(0.0);
  for (int i = 0; i < 300; ++i) tick(1.0);
  ASSERT_NEAR(line.bench.felt.force.y, 1.0, 1e-3);
  line.bench.pose.low = true;
  double last = 1.001;
  for (int i = 0; i < 510; ++i) {
    tick(1.0);
    EXPECT_LE(line.bench.felt.force.y, last + 1e-9);
    last = line.bench.felt.force.y;
  }
  EXPECT_EQ(last, 0.0) << "gone in half a second";
  EXPECT_EQ(line.servo->state(), DeviceState::kTripped);
}

}  // namespace
}  // namespace pliant
