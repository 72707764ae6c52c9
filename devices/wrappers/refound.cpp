#include "devices/wrappers/refound.h"

#include <chrono>
#include <mutex>

#include "runtime/has_threads.h"

namespace pliant {
namespace {

// A different device in its place would be used with the wrong limits.
bool same(const DeviceCapabilities& a, const DeviceCapabilities& b) {
  return a.renders_force == b.renders_force && a.renders_torque == b.renders_torque &&
         a.renders_grip == b.renders_grip && a.resists_only == b.resists_only && a.max_force == b.max_force &&
         a.max_torque == b.max_torque && a.rate == b.rate && a.loop == b.loop && a.workspace == b.workspace &&
         a.senses_rotation == b.senses_rotation;
}

}  // namespace

Status Refound::open(const std::string& id) {
  end();
  if (Status opened = inner_->open(id); !opened) return opened;
  id_ = id;
  can_ = inner_->capabilities();
  phase_ = Phase::kHeld;
  // A device whose loop is the vendor's library's can only be found by that library.
  if (kHasThreads && can_.loop != DeviceLoop::kCallback)
    thread_ = std::jthread([this](const std::stop_token& stop) { look(stop); });
  return Done{};
}

bool Refound::read(DeviceSample& sample) {
  if (!held()) return false;
  if (inner_->read(sample)) return true;
  if (inner_->gone()) phase_.store(Phase::kGone, std::memory_order_release);
  return false;
}

void Refound::write(const DeviceWrench& wrench) {
  if (held()) inner_->write(wrench);
}

bool Refound::write_model(const DeviceModel& model, const DeviceWrench& wrench) {
  return !held() || inner_->write_model(model, wrench);
}

void Refound::wait(double seconds) {
  if (held())
    inner_->wait(seconds);
  else
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

void Refound::make_safe() noexcept {
  if (held()) inner_->make_safe();
}

void Refound::close() {
  end();
  inner_->close();
  phase_ = Phase::kHeld;
}

void Refound::end() {
  thread_ = {};  // stops and joins the thread
}

void Refound::look(const std::stop_token& end) {
  std::mutex mutex;
  const std::stop_callback wake(end, [&] {
    const std::lock_guard ended(mutex);
    asked_.notify_all();
  });
  std::unique_lock lock(mutex);
  while (!end.stop_requested()) {
    asked_.wait_for(lock, std::chrono::duration<double>(kLookEvery), [&] { return end.stop_requested(); });
    if (end.stop_requested() || held()) continue;
    if (open_again()) phase_.store(Phase::kHeld, std::memory_order_release);
  }
}

bool Refound::open_again() {
  try {
    inner_->close();
    if (!inner_->open(id_)) return false;
    if (same(inner_->capabilities(), can_)) return true;
    inner_->close();
  } catch (...) {  // tried again later
  }
  return false;
}

}  // namespace pliant
