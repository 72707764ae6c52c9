// A custom device driver. It simulates a 100 g hand on a spring that lowers it onto the tissue and is moved by the
// rendered force. A real driver would access its hardware in read and write.
#include <pliant/pliant.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

namespace {

class SimulatedHand final : public pliant::Driver {
 public:
  pliant::Status open(const std::string& id) override {
    std::printf("opened `%s`\n", id.c_str());
    return pliant::Done{};
  }
  pliant::DeviceCapabilities capabilities() const override { return {.max_force = 3.0, .max_stiffness = 2000.0}; }

  // Both run on the touch clock, 1000 times a second: no waiting, no allocation.
  bool read(pliant::DeviceSample& sample) override {
    constexpr double kDt = 1e-3, kMass = 0.1, kSpring = 40.0, kDamping = 4.0,
                     kGoal = -0.01;  // [s] [kg] [N/m] [N s/m] [m]
    velocity_ += kDt / kMass * (kSpring * (kGoal - height_) - kDamping * velocity_ + force_);
    height_ += kDt * velocity_;
    sample.position = {0, height_, 0};
    return true;
  }
  void write(const pliant::DeviceWrench& wrench) override { force_ = wrench.force.y; }
  void close() override { std::printf("closed; the last force was %.3f N\n", force_); }

 private:
  double height_ = 0.02, velocity_ = 0.0, force_ = 0.0;  // [m] [m/s] [N]
};

pliant::MeshData box(float half) {
  pliant::MeshData mesh;
  for (int i = 0; i < 8; ++i)
    mesh.position.push_back({i & 1 ? half : -half, i & 2 ? 0 : -2 * half, i & 4 ? half : -half});
  mesh.index = {0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 1, 3, 0, 3, 2,
                4, 6, 7, 4, 7, 5, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  return mesh;
}

int fail(const pliant::Error& error) {
  return std::fprintf(stderr, "%s\n", error.message().c_str()), 1;
}

}  // namespace

int main() {
  // Registers it by name; `connect` then finds it.
  const auto registered = pliant::register_driver("simulated_hand", [] { return std::make_unique<SimulatedHand>(); });
  if (!registered) return fail(registered.error());

  pliant::Scene scene;
  scene.add_surface("block", box(0.05f), {.stiffness = 200.0});
  scene.add_probe("stylus", {.radius = 0.003});
  auto session = pliant::Session::open(scene);
  if (!session) return fail(session.error());
  if (auto done = session->connect("stylus", "simulated_hand:left"); !done) return fail(done.error());
  if (auto done = session->start(); !done) return fail(done.error());  // 1 kHz, on a separate thread
  for (int i = 0; i < 10; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const auto felt = session->reading("stylus");
    if (!felt) return fail(felt.error());
    std::printf("%.1f s  y %6.2f mm  force %.3f N\n", felt->time, 1e3 * felt->position.y, felt->force.y);
  }
  if (auto done = session->stop(); !done) return fail(done.error());
  const pliant::SessionFigures figures = session->figures();
  std::printf("%llu ticks, p99 %.1f us, %llu overruns\n", static_cast<unsigned long long>(figures.ticks),
              figures.p99_us, static_cast<unsigned long long>(figures.overruns));
}
