#include "engine/run/soft_clock.h"

#include <algorithm>
#include <chrono>
#include <exception>

#include "components/soft_body.h"
#include "systems/schedule.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/tool_step.h"

namespace pliant {

namespace {
constexpr const char* kSoftReport = "; please report it with the level";
}

SoftClock::SoftClock(World& world) : world_(world), schedule_(soft_schedule()) {
  for (auto [entity, body] : world.registry.view<const SoftBody>())
    tetrahedra_ += world.tet_meshes[body.tets].tets.size();
}

void SoftClock::step(double dt) {
  run_soft_step(schedule_, world_, {figures_.steps, dt, time_});
  if (journal_) journal_->note(figures_.steps, time_);
  time_ += dt;
  const SoftState& soft = *world_.soft;
  ++figures_.steps;
  figures_.step_ms = soft.times.total;
  figures_.contacts = static_cast<std::uint32_t>(soft.contacts.size());
  figures_.contacts_sum += figures_.contacts;
  figures_.contacts_max = std::max(figures_.contacts_max, figures_.contacts);
  figures_.sweeps_sum += static_cast<std::uint64_t>(soft.report.sweeps);
  figures_.residual_max = std::max(figures_.residual_max, soft.report.residual);
}

// Step k begins at k soft_step, without accumulated rounding.
void SoftClock::reach(double time) {
  if (!any()) return;
  const double T = world_.simulation.soft_step;
  for (;;) {
    time_ = static_cast<double>(figures_.steps) * T;
    if (time_ > time + 1e-6 * T) return;
    step(T);
  }
}

LateStep SoftClock::late_step(double late, double soft_step) {
  const double whole = soft_step + late, length = std::min(whole, kLongestStep * soft_step);
  return {length, whole - length};
}

void SoftClock::start() {
  if (any()) thread_ = std::thread([this] { run(); });
}

void SoftClock::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

const SoftFigures& SoftClock::latest() {
  reported_.acquire();
  return reported_.read();
}

void SoftClock::run() {
  try {
    loop();
  } catch (const std::exception& thrown) {
    error_ = Error{"soft clock", std::string("stopped by an exception: ") + thrown.what() + kSoftReport};
  } catch (...) {
    error_ = Error{"soft clock", std::string("stopped by an exception of an unknown kind") + kSoftReport};
  }
  failed_ = error_.has_value();
}

void SoftClock::loop() {
  using clock = std::chrono::steady_clock;
  const auto period =
      std::chrono::duration_cast<clock::duration>(std::chrono::duration<double>(world_.simulation.soft_step));
  auto due = clock::now();
  while (!stop_) {
    const auto now = clock::now();
    if (now < due) {
      std::this_thread::sleep_until(due);
    }
    const auto began = std::max(now, due);
    if (paused_) {
      due = began + period;
      continue;
    }
    const double late = std::chrono::duration<double>(began - due).count();
    const double T = world_.simulation.soft_step;
    figures_.overruns += late > 0.1 * T ? 1 : 0;
    const LateStep next = late_step(late, T);
    figures_.time_lost += next.lost;
    step(next.length);
    reported_.write() = figures_;
    reported_.publish();
    due = began + period;
  }
  // The last step may be the one that took too long.
  const double late = std::chrono::duration<double>(clock::now() - due).count();
  if (!paused_ && late > 0.0) figures_.time_lost += late_step(late, world_.simulation.soft_step).lost;
}

}  // namespace pliant
