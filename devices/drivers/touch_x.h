// Driver "touch": Touch, Touch X and Phantom by 3D Systems, through the vendor's libHD (OpenHaptics), opened at run
// time with our own declarations. The vendor's scheduler calls us at its own rate and on its own thread. Its force
// clamp, ramp and software limit are always on.
//
// The vendor's axes are the world's (x right, y up, z towards the user), in millimetres.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "devices/ports/shared_library.h"
#include "pliant/driver.h"
#include "runtime/exchange.h"

namespace pliant {

class Touch final : public Driver {
 public:
  // `libraries`: tried in this order; empty: the vendor's names.
  explicit Touch(std::vector<std::string> libraries = {});
  ~Touch() override;
  // `id`: the name given in the vendor's set-up program; empty or `default`: the default device.
  Status open(const std::string& id) override;
  DeviceCapabilities capabilities() const override { return can_; }
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  Status run(std::function<void()> tick) override;
  void close() override;
  void make_safe() noexcept override { off_ = true; }  // the next frame switches the force output off

  std::vector<DeviceInfo> list();

 private:
  struct Library;
  struct Wanted {
    dvec3 force{0};
    double time = 0.0;  // [s] monotonic
  };
  Result<std::shared_ptr<Library>> load() const;
  static unsigned on_frame(void* self);
  void frame();

  std::vector<std::string> names_;
  std::shared_ptr<Library> library_;
  unsigned device_ = 0;
  unsigned long task_ = 0;
  DeviceCapabilities can_;
  std::atomic<bool> off_{false}, has_tick_{false};
  bool was_off_ = false, failed_ = false;
  std::function<void()> tick_;
  DeviceSample sample_;
  TripleBuffer<DeviceSample> samples_;
  TripleBuffer<Wanted> forces_;
  Wanted newest_;
};

std::vector<DeviceInfo> list_touch();

}  // namespace pliant
