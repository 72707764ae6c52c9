#include <mutex>

#include "devices/drivers/falcon.h"
#include "devices/drivers/force_dimension.h"
#include "devices/drivers/gamepad.h"
#include "devices/drivers/haply.h"
#include "devices/drivers/network_device.h"
#include "devices/drivers/polhem.h"
#include "devices/drivers/serial_device.h"
#include "devices/drivers/sony_pad.h"
#include "devices/drivers/spacemouse.h"
#include "devices/drivers/touch_x.h"
#include "devices/simulated/simulated_device.h"
#include "pliant/driver.h"
#include "pliant/drivers.h"

namespace pliant {
namespace {

// A duplicate name is a bug in this list, which a test detects.
template <class D>
void add(const char* name, DeviceLister lister) {
  (void)register_driver(
      name, [] { return std::make_unique<D>(); }, std::move(lister));
}

}  // namespace

void register_all_drivers() {
  static std::once_flag once;
  std::call_once(once, [] {
    // One line per driver:
    register_simulated();
    (void)register_spacemouse();
    (void)register_dualsense();
    (void)register_dualshock4();
    (void)register_gamepad();
    (void)register_polhem();
    add<Falcon>("falcon", list_falcon);
    add<ForceDimension>("forcedimension", list_force_dimension);
    add<Haply>("haply", list_haply);
    add<NetworkDevice>("network", list_network_devices);
    add<SerialDevice>("serial", [] { return list_serial(); });
    add<Touch>("touch", list_touch);
  });
}

}  // namespace pliant
