#include "devices/drivers/all.h"

#include <mutex>

#include "devices/drivers/gamepad.h"
#include "devices/drivers/polhem.h"
#include "devices/drivers/sony_pad.h"
#include "devices/drivers/spacemouse.h"
#include "pliant/driver.h"

namespace pliant {

void register_all_drivers() {
  static std::once_flag once;
  std::call_once(once, [] {
    // One line a driver:
    (void)register_spacemouse();
    (void)register_dualsense();
    (void)register_dualshock4();
    (void)register_gamepad();
    (void)register_polhem();
  });
}

}  // namespace pliant
