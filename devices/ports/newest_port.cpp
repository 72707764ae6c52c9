#include "devices/ports/newest_port.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

#include "runtime/exchange.h"

namespace pliant {
namespace {

struct Packet {
  std::array<std::uint8_t, kLongestNewest> bytes{};
  std::size_t length = 0;
};

class NewestPort final : public PacketPort {
 public:
  explicit NewestPort(std::unique_ptr<PacketPort> line) : line_(std::move(line)), thread_([this] { run(); }) {}
  ~NewestPort() override {
    ended_.store(true, std::memory_order_release);
    wake();
    thread_.join();
  }

  Status send(std::span<const std::uint8_t> packet) override {
    if (packet.size() > kLongestNewest) return Error{"device", "a packet is longer than its line takes"};
    if (failed_.load(std::memory_order_acquire)) return Error{"device", "is gone", "plug it in again"};
    Packet& next = newest_.write();
    std::copy(packet.begin(), packet.end(), next.bytes.begin());
    next.length = packet.size();
    newest_.publish();
    wake();
    return Done{};
  }
  Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) override {
    return line_->receive(into, seconds);
  }
  // Only before the first send, while the thread is idle.
  Result<std::size_t> feature(std::uint8_t number, std::span<std::uint8_t> into) override {
    return line_->feature(number, into);
  }
  Status set_feature(std::span<const std::uint8_t> report) override { return line_->set_feature(report); }
  std::vector<std::uint8_t> descriptor() override { return line_->descriptor(); }
  int file() const override { return line_->file(); }
  std::string node() const override { return line_->node(); }

 private:
  void wake() {
    kept_.fetch_add(1, std::memory_order_release);
    kept_.notify_one();
  }

  void run() {
    for (std::uint32_t seen = 0;;) {
      kept_.wait(seen, std::memory_order_acquire);
      seen = kept_.load(std::memory_order_acquire);
      const bool last = ended_.load(std::memory_order_acquire);
      if (newest_.acquire() && !failed_.load(std::memory_order_relaxed)) {
        const Packet& packet = newest_.read();
        if (!line_->send({packet.bytes.data(), packet.length})) failed_.store(true, std::memory_order_release);
      }
      if (last) return;
    }
  }

  std::unique_ptr<PacketPort> line_;
  TripleBuffer<Packet> newest_;
  std::atomic<std::uint32_t> kept_{0};
  std::atomic<bool> ended_{false}, failed_{false};
  std::thread thread_;  // last: it uses all members above
};

}  // namespace

std::unique_ptr<PacketPort> newest_port(std::unique_ptr<PacketPort> line) {
  return std::make_unique<NewestPort>(std::move(line));
}

}  // namespace pliant
