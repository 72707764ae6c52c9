// Reconnects an unplugged device. When the inner driver reports a lost connection (Driver::gone), a thread closes and
// reopens it every kLookEvery until it is found. Meanwhile reads return nothing, and writes are dropped. The innermost
// wrapper of every device created from text (chain.h).
//
// The inner driver belongs to one side at a time, given by the phase: `kHeld`, the caller of these functions; `kGone`,
// the thread. Neither waits for the other, but close() waits until the thread has ended.
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <string>
#include <thread>

#include "devices/drop_counter.h"
#include "pliant/driver.h"

namespace pliant {

class Refound final : public Driver, public CountsDropped {
 public:
  static constexpr double kLookEvery = 0.25;  // [s]

  explicit Refound(std::unique_ptr<Driver> inner) : inner_(std::move(inner)) {}
  ~Refound() override { end(); }

  Status open(const std::string& id) override;
  DeviceCapabilities capabilities() const override { return can_; }
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  void close() override;
  void wait(double seconds) override;
  Status run(std::function<void()> tick) override { return inner_->run(std::move(tick)); }
  bool write_model(const DeviceModel& model, const DeviceWrench& wrench) override;
  void make_safe() noexcept override;
  bool safe_line(SafeLine& line) const override { return held() && inner_->safe_line(line); }
  std::string node() const override { return held() ? inner_->node() : std::string(); }
  DroppedFrames dropped() const override { return held() ? dropped_frames(*inner_) : DroppedFrames{}; }
  bool gone() const override { return phase_ == Phase::kGone; }

 private:
  enum class Phase : std::uint8_t { kHeld, kGone };
  bool held() const { return phase_.load(std::memory_order_acquire) == Phase::kHeld; }
  void look(const std::stop_token& end);
  bool open_again();
  void end();

  std::unique_ptr<Driver> inner_;
  std::string id_;
  DeviceCapabilities can_;
  std::atomic<Phase> phase_{Phase::kHeld};
  std::condition_variable_any asked_;  // only for the thread: it waits without allocating
  std::jthread thread_;
};

}  // namespace pliant
