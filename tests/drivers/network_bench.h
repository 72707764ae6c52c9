// An engine's driver and a device on a wire in virtual time. The wire can be cut, delayed, duplicate packets and
// falsify them.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "devices/drivers/network_device.h"
#include "devices/drivers/network_endpoint.h"

namespace pliant {

struct NetworkBench {
  using Packet = std::vector<std::uint8_t>;
  struct Held {
    double due;  // [s]
    Packet packet;
  };
  double time = 100.0;        // [s]
  double device_clock = 5e3;  // [s] ahead of ours
  double to_device_delay = 0.0, to_engine_delay = 0.0;
  std::deque<Held> to_device, to_engine;
  // Transmits a packet; tests replace it to disturb the transmission.
  std::function<void(std::deque<Held>&, double, const Packet&)> carry = [](auto& wire, double due, const Packet& p) {
    wire.push_back({due, p});
  };
  StateFrame pose;    // the device's state
  DeviceWrench felt;  // rendered last
  std::unique_ptr<NetworkEndpoint> device;

  struct Port final : ListeningPort {
    NetworkBench& bench;
    bool engine;
    Port(NetworkBench& b, bool e) : bench(b), engine(e) {}
    Status send(std::span<const std::uint8_t> packet) override {
      bench.carry(engine ? bench.to_device : bench.to_engine,
                  bench.time + (engine ? bench.to_device_delay : bench.to_engine_delay),
                  Packet(packet.begin(), packet.end()));
      return Done{};
    }
    Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) override {
      auto& wire = engine ? bench.to_engine : bench.to_device;
      for (double until = bench.time + seconds; wire.empty() || wire.front().due > bench.time;) {
        if (!engine || bench.time >= until) return std::size_t{0};
        bench.step();  // the driver waits while the device continues
      }
      const Packet packet = wire.front().packet;
      wire.pop_front();
      const std::size_t size = std::min(packet.size(), into.size());
      std::copy_n(packet.begin(), size, into.begin());
      return size;
    }
    void take_peer() override {}
    void free_peer() override {}
  };

  explicit NetworkBench(std::optional<FrameKey> key = {}) { start_device(std::move(key)); }
  void start_device(std::optional<FrameKey> key = {}) {
    device = std::make_unique<NetworkEndpoint>(
        std::make_unique<Port>(*this, false),
        DeviceCapabilities{.max_force = 4.0, .max_stiffness = 800.0, .workspace = {0.1, 0.1, 0.1}, .rate = 1000.0},
        "bench", [this] { return time + device_clock; }, std::move(key));
  }
  PortOpener opener() {
    return [this](const std::string&) -> Result<std::unique_ptr<PacketPort>> {
      return std::unique_ptr<PacketPort>(std::make_unique<Port>(*this, true));
    };
  }
  NetworkDevice driver() {
    return NetworkDevice(opener(), [this] { return time; });
  }
  // One millisecond of the device.
  void step() {
    time += 1e-3;
    if (device) felt = device->tick(pose);
  }
};

}  // namespace pliant
