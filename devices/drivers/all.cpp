#include "devices/drivers/all.h"

#include <mutex>

#include "devices/drivers/force_dimension.h"
#include "devices/drivers/gamepad.h"
#include "devices/drivers/haply.h"
#include "devices/drivers/network_device.h"
#include "devices/drivers/polhem.h"
#include "devices/drivers/sony_pad.h"
#include "devices/drivers/spacemouse.h"
#include "devices/drivers/touch_x.h"
#include "devices/simulated/simulated_device.h"
#include "pliant/driver.h"

namespace pliant {

void register_all_drivers() {
  static std::once_flag once;
  std::call_once(once, [] {
    // One line a driver:
    register_simulated();
    (void)register_spacemouse();
    (void)register_dualsense();
    (void)register_dualshock4();
    (void)register_gamepad();
    (void)register_polhem();
    (void)register_driver(
        "forcedimension", [] { return std::make_unique<ForceDimension>(); }, list_force_dimension);
    (void)register_driver(
        "touch", [] { return std::make_unique<Touch>(); }, list_touch);
    (void)register_driver(
        "haply", [] { return std::make_unique<Haply>(); }, list_haply);
    (void)register_driver(
        "network", [] { return std::make_unique<NetworkDevice>(); }, list_network_devices);
  });
}

}  // namespace pliant
