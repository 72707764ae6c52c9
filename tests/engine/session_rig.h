// Shared by the tests of Session: a sheet, a probe above it, a device under observation. Public headers only.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "pliant/pliant.h"

namespace pliant {

// Flat, facing up, `half` [m] to each side, its vertices row by row.
inline MeshData sheet(double half = 0.05, std::uint32_t cells = 50) {
  MeshData mesh;
  const auto at = [&](std::uint32_t i) { return static_cast<float>(half * (2.0 * i / cells - 1.0)); };
  for (std::uint32_t z = 0; z <= cells; ++z)
    for (std::uint32_t x = 0; x <= cells; ++x) mesh.position.push_back({at(x), 0, at(z)});
  for (std::uint32_t z = 0; z < cells; ++z)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t i = z * (cells + 1) + x, j = i + cells + 1;
      for (const std::uint32_t corner : {i, j, i + 1, i + 1, j, j + 1}) mesh.index.push_back(corner);
    }
  return mesh;
}

// Twelve triangles round the origin.
inline MeshData box(float half) {
  MeshData mesh;
  for (int i = 0; i < 8; ++i)
    mesh.position.push_back({i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half});
  mesh.index = {0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 1, 3, 0, 3, 2,
                4, 6, 7, 4, 7, 5, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  return mesh;
}

inline Scene press_scene() {
  Scene scene("press");
  scene.add_surface("tissue", sheet(), {.stiffness = 300.0});
  scene.add_probe("finger");
  return scene;
}

inline Session opened(const Scene& scene) {
  auto session = Session::open(scene);
  EXPECT_TRUE(session) << session.error().message();
  return std::move(session).value();
}

// From above to `depth` [m], a tick every 10 um.
inline void press(Session& session, double depth) {
  for (double y = 0.0005; y > -depth; y -= 1e-5) {
    ASSERT_TRUE(session.move("finger", {0, y, 0}));
    ASSERT_TRUE(session.step());
  }
  ASSERT_TRUE(session.move("finger", {0, -depth, 0}));
  ASSERT_TRUE(session.step());
}

// A device that the test looks at.
struct Log {
  std::atomic<int> reads{0}, writes{0}, opened{0}, closed{0};
  std::atomic<double> last{-1.0}, largest{0.0}, height{0.01};
  std::atomic<bool> ready{true}, silent{false}, throws{false}, write_throws{false};
  DeviceCapabilities can{.max_force = 0.5};
};
class LoggedDevice final : public Driver {
 public:
  explicit LoggedDevice(Log& log) : log_(log) {}
  Status open(const std::string& id) override {
    ++log_.opened;
    if (id == "broken") return Error{"device broken", "is broken; mend it"};
    return Done{};
  }
  DeviceCapabilities capabilities() const override { return log_.can; }
  bool read(DeviceSample& sample) override {
    ++log_.reads;
    if (log_.throws) throw std::runtime_error("cable cut");
    sample.position = {0, log_.height.load(), 0};
    sample.ready = log_.ready;
    return !log_.silent;
  }
  void write(const DeviceWrench& wrench) override {
    ++log_.writes;
    if (log_.write_throws && length(wrench.force) > 0.0) throw std::runtime_error("bus off");
    log_.last = length(wrench.force);
    log_.largest = std::max(log_.largest.load(), length(wrench.force));
  }
  void close() override { ++log_.closed; }

 private:
  Log& log_;
};

inline void lower(Session& session, Log& log, double to) {
  for (int i = 0; i < 1000 && log.height > to; ++i) {
    log.height = std::max(to, log.height.load() - 2e-5);
    ASSERT_TRUE(session.step());
  }
}

// Until `done`, at most five seconds.
template <class Done>
bool within_five_seconds(Done done) {
  for (int i = 0; i < 5000; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

}  // namespace pliant
