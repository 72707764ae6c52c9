#include "devices/drivers/network_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "devices/ports/crc32.h"

namespace pliant {
namespace {

constexpr FrameKind kKinds[] = {FrameKind::kAsk,   FrameKind::kOpen,  FrameKind::kDescription,
                                FrameKind::kState, FrameKind::kForce, FrameKind::kClose};

NetworkFrame sample_frame(FrameKind kind) {
  NetworkFrame frame;
  frame.kind = kind;
  frame.session = 0x01020304;
  frame.peer = 0xA0B0C0D0;
  frame.sequence = 0xFFFFFFFE;
  frame.time_us = 0x0102030405060708;
  frame.description.can = {.senses_rotation = true, .max_force = 3.5, .workspace = {0.1, 0.2, 0.25}, .rate = 2000.0};
  std::strcpy(frame.description.name.data(), "a handle");
  frame.state.sample.position = {0.5, -0.25, 0.125};
  frame.state.sample.rotation = glm::normalize(dquat(0.5, 0.5, -0.5, 0.5));
  frame.state.sample.grip = 0.75;
  frame.state.sample.buttons = 5;
  frame.state.velocity = {1, 2, 3};
  frame.state.hot = true;
  frame.state.heard = 77;
  frame.force.wrench.force = {1, -2, 3};
  frame.force.has_model = true;
  frame.force.radius = 0.5;
  frame.force.model.position = {0.25, 0, 1};
  frame.force.model.force_by_position = dmat3(-100, 1, 2, 3, -200, 4, 5, 6, -300);
  frame.force.model.torque_by_spin = dmat3(-0.5);
  return frame;
}

FrameFault parse(const FrameBytes& bytes, std::size_t size, NetworkFrame& into) {
  return parse_frame(std::span(bytes).first(size), into);
}

TEST(NetworkFrame, TheCheckSumIsTheOneOfEthernet) {
  const char* text = "123456789";
  EXPECT_EQ(crc32({reinterpret_cast<const std::uint8_t*>(text), 9}), 0xCBF43926u);
}

TEST(NetworkFrame, EveryKindComesBackAsItWasWritten) {
  for (const FrameKind kind : kKinds) {
    const NetworkFrame sent = sample_frame(kind);
    FrameBytes bytes;
    const std::size_t size = write_frame(sent, bytes);
    NetworkFrame got;
    ASSERT_EQ(parse(bytes, size, got), FrameFault::kNone) << static_cast<int>(kind);
    EXPECT_EQ(got.kind, kind);
    EXPECT_EQ(got.session, sent.session);
    EXPECT_EQ(got.peer, sent.peer);
    EXPECT_EQ(got.sequence, sent.sequence);
    EXPECT_EQ(got.time_us, sent.time_us);
    FrameBytes again;
    EXPECT_EQ(write_frame(got, again), size);
    EXPECT_EQ(std::memcmp(bytes.data(), again.data(), size), 0) << "kind " << static_cast<int>(kind);
  }
}

TEST(NetworkFrame, TheBytesStandWhereTheDocumentSays) {
  FrameBytes bytes;
  EXPECT_EQ(write_frame(sample_frame(FrameKind::kState), bytes), 100u);
  EXPECT_EQ(std::memcmp(bytes.data(), "PLNT\x01\x04\x64\x00", 8), 0);
  const std::uint8_t session[] = {4, 3, 2, 1};
  EXPECT_EQ(std::memcmp(bytes.data() + 12, session, 4), 0);
  EXPECT_EQ(bytes[24], 8);   // microseconds, lowest first
  EXPECT_EQ(bytes[32], 77);  // heard
  EXPECT_EQ(bytes[36], 1 | 4);
  float x;
  std::memcpy(&x, bytes.data() + 44, 4);
  EXPECT_EQ(x, 0.5f);
  EXPECT_EQ(write_frame(sample_frame(FrameKind::kForce), bytes), 344u);
  std::memcpy(&x, bytes.data() + 128 + 4, 4);
  EXPECT_EQ(x, 1.0f) << "the second number is of the first column, second row";
  EXPECT_EQ(write_frame(sample_frame(FrameKind::kDescription), bytes), 104u);
}

TEST(NetworkFrame, EveryTruncationAndEverySingleBitIsRefused) {
  for (const FrameKind kind : kKinds) {
    FrameBytes bytes;
    const std::size_t size = write_frame(sample_frame(kind), bytes);
    NetworkFrame got;
    got.sequence = 4242;
    for (std::size_t cut = 0; cut < size; ++cut) EXPECT_NE(parse(bytes, cut, got), FrameFault::kNone) << cut;
    for (std::size_t bit = 0; bit < 8 * size; ++bit) {
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
      EXPECT_NE(parse(bytes, size, got), FrameFault::kNone) << "kind " << static_cast<int>(kind) << " bit " << bit;
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    }
    EXPECT_EQ(got.sequence, 4242u) << "what is refused changes nothing";
    std::vector<std::uint8_t> longer(bytes.begin(), bytes.begin() + static_cast<long>(size));
    longer.push_back(0);
    EXPECT_EQ(parse_frame(longer, got), FrameFault::kLength);
  }
}

TEST(NetworkFrame, NumbersThatCannotBeAreRefusedThoughTheSumIsRight) {
  const double nan = std::nan("");
  for (int i = 0; i < 8; ++i) {
    NetworkFrame frame = sample_frame(i < 5 ? FrameKind::kState : FrameKind::kForce);
    if (i == 0) frame.state.sample.position.x = nan;
    if (i == 1) frame.state.sample.position.y = 1e5;  // micrometres, perhaps
    if (i == 2) frame.state.sample.rotation = dquat(0, 0, 0, 0);
    if (i == 3) frame.state.sample.grip = -0.5;
    if (i == 4) frame.state.velocity.z = INFINITY;
    if (i == 5) frame.force.model.force_by_position[2][1] = nan;
    if (i == 6) frame.force.wrench.force.x = -INFINITY;
    if (i == 7) frame.force.radius = -1.0;
    FrameBytes bytes;
    NetworkFrame got;
    const std::size_t size = write_frame(frame, bytes);
    EXPECT_EQ(parse(bytes, size, got), i == 2 ? FrameFault::kRotation : FrameFault::kValue) << i;
  }
}

TEST(NetworkFrame, ANameSteersNoTerminal) {
  NetworkFrame frame = sample_frame(FrameKind::kDescription);
  frame.description.name.fill('\x1b');
  FrameBytes bytes;
  NetworkFrame got;
  const std::size_t size = write_frame(frame, bytes);
  ASSERT_EQ(parse(bytes, size, got), FrameFault::kNone);
  EXPECT_EQ(std::string(got.description.name.data()), std::string(31, '?'));
}

TEST(NetworkFrame, SequencesGoOnAfterTheLargestNumber) {
  EXPECT_TRUE(comes_after(0, 0xFFFFFFFF));
  EXPECT_FALSE(comes_after(0xFFFFFFFF, 0));
  EXPECT_FALSE(comes_after(7, 7));
}

}  // namespace
}  // namespace pliant
