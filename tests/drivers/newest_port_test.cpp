#include "devices/ports/newest_port.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "tests/drivers/emulated_hid.h"

namespace pliant {
namespace {

// A line whose packets leave when the test lets them.
struct SlowLine final : PacketPort {
  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    bool open = false, broken = false, sending = false;
    std::vector<int> left;
  };
  explicit SlowLine(Shared& shared) : shared_(shared) {}
  Status send(std::span<const std::uint8_t> packet) override {
    std::unique_lock lock(shared_.mutex);
    shared_.sending = true;
    shared_.changed.notify_all();
    shared_.changed.wait(lock, [&] { return shared_.open; });
    if (shared_.broken) return Error{"slow", "is gone"};
    shared_.left.push_back(packet[0]);
    shared_.changed.notify_all();
    return Done{};
  }
  Result<std::size_t> receive(std::span<std::uint8_t>, double) override { return std::size_t(0); }

 private:
  Shared& shared_;
};

Status send_one(PacketPort& port, int number) {
  return port.send(std::array<std::uint8_t, 1>{static_cast<std::uint8_t>(number)});
}

TEST(NewestPort, ALineThatIsSlowIsNotWaitedForAndTheNewestLeaves) {
  SlowLine::Shared shared;
  std::unique_ptr<PacketPort> port = newest_port(std::make_unique<SlowLine>(shared));
  ASSERT_TRUE(send_one(*port, 1).ok());
  {
    std::unique_lock lock(shared.mutex);
    shared.changed.wait(lock, [&] { return shared.sending; });
  }
  for (int i = 2; i <= 100; ++i) EXPECT_TRUE(send_one(*port, i).ok());  // the line is still busy with the first
  {
    const std::lock_guard lock(shared.mutex);
    EXPECT_TRUE(shared.left.empty());
    shared.open = true;
    shared.changed.notify_all();
  }
  port.reset();
  EXPECT_EQ(shared.left, (std::vector<int>{1, 100}));
}

TEST(NewestPort, WhatWasSentLastHasLeftWhenItEnds) {
  for (int i = 0; i < 200; ++i) {
    SlowLine::Shared shared;
    shared.open = true;
    std::unique_ptr<PacketPort> port = newest_port(std::make_unique<SlowLine>(shared));
    EXPECT_TRUE(send_one(*port, 3).ok());
    EXPECT_TRUE(send_one(*port, 7).ok());
    port.reset();
    ASSERT_FALSE(shared.left.empty());
    EXPECT_EQ(shared.left.back(), 7);
  }
}

TEST(NewestPort, ALineThatFailedRefusesFromThenOn) {
  SlowLine::Shared shared;
  shared.open = shared.broken = true;
  const std::unique_ptr<PacketPort> port = newest_port(std::make_unique<SlowLine>(shared));
  for (int i = 0; i < 100000 && send_one(*port, 1).ok(); ++i) std::this_thread::yield();
  EXPECT_FALSE(send_one(*port, 1).ok());
}

TEST(NewestPort, APacketThatIsTooLongIsRefused) {
  SlowLine::Shared shared;
  const std::unique_ptr<PacketPort> port = newest_port(std::make_unique<SlowLine>(shared));
  EXPECT_FALSE(port->send(std::vector<std::uint8_t>(kLongestNewest + 1)).ok());
}

}  // namespace
}  // namespace pliant
