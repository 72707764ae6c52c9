#include "devices/ports/newest_port.h"

#include <algorithm>
#include <array>

#include "devices/ports/newest_writer.h"

namespace pliant {
namespace {

struct Packet {
  std::array<std::uint8_t, kLongestNewest> bytes{};
  std::size_t length = 0;
};

class NewestPort final : public PacketPort {
 public:
  explicit NewestPort(std::unique_ptr<PacketPort> line) : line_(std::move(line)), writer_(Send{line_.get()}) {}

  Status send(std::span<const std::uint8_t> packet) override {
    if (packet.size() > kLongestNewest) return Error{"device", "a packet is longer than its line takes"};
    if (writer_.failed()) return Error{"device", "is gone; plug it in again"};
    writer_.give([&](Packet& next) {
      std::copy(packet.begin(), packet.end(), next.bytes.begin());
      next.length = packet.size();
    });
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
  struct Send {
    PacketPort* line;
    bool operator()(const Packet& packet) const {
      return static_cast<bool>(line->send({packet.bytes.data(), packet.length}));
    }
  };

  std::unique_ptr<PacketPort> line_;
  NewestWriter<Packet, Send> writer_;  // last: its thread uses the line
};

}  // namespace

std::unique_ptr<PacketPort> newest_port(std::unique_ptr<PacketPort> line) {
  return std::make_unique<NewestPort>(std::move(line));
}

}  // namespace pliant
