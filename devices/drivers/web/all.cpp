// In place of drivers/all.cpp in a browser: the drivers of HID devices that need no thread, and the simulated devices.
// Others are JavaScript's (pliant_register_driver).
#include "devices/drivers/sony_pad.h"
#include "devices/drivers/spacemouse.h"
#include "devices/simulated/simulated_device.h"
#include "pliant/drivers.h"

namespace pliant {

void register_all_drivers() {
  static const bool once = [] {
    register_simulated();
    (void)register_spacemouse();
    (void)register_dualsense();
    (void)register_dualshock4();
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace pliant
