// Driver "forcedimension": omega, delta, sigma and lambda by Force Dimension, through the vendor's libdhd, opened at
// run time with our own declarations. The vendor's safety limits are unchanged: no expert mode, no other velocity
// threshold, no other watchdog. A force that the device has switched off is switched on again only by its own button.
//
// The vendor's axes: x towards the operator, y to the right, z up; world axes are their y, z, x. SI units.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "devices/drivers/device_thread.h"
#include "devices/ports/shared_library.h"

namespace pliant {

class ForceDimension final : public Driver {
 public:
  // `libraries`: tried in this order; empty: the vendor's names.
  explicit ForceDimension(std::vector<std::string> libraries = {});
  ~ForceDimension() override;
  // `id`: device number of the vendor's library; empty: 0.
  Status open(const std::string& id) override;
  DeviceCapabilities capabilities() const override { return can_; }
  bool read(DeviceSample& sample) override { return thread_.read(sample); }
  void write(const DeviceWrench& wrench) override { thread_.write(wrench); }
  void close() override;
  void make_safe() noexcept override { thread_.switch_off(); }  // the thread engages the brakes within one exchange

  // The devices that the library finds.
  std::vector<DeviceInfo> list();

 private:
  struct Library;
  Result<std::shared_ptr<Library>> load() const;
  void run();
  bool exchange(int& since_status, bool& braked);

  std::vector<std::string> names_;
  std::shared_ptr<Library> library_;
  signed char index_ = 0, device_ = -1;
  DeviceCapabilities can_;
  DeviceThread thread_;
  DeviceSample sample_;
  bool force_on_ = false;
};

std::vector<DeviceInfo> list_force_dimension();

}  // namespace pliant
