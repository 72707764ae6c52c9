// The devices of a run as both windows show them, `pliant run` and `pliant edit`: state, live axes, forces, rates, and
// the buttons that arm and stop them.
#pragma once

#include <string>

#include "engine/run/device_view.h"

namespace pliant::ui {

// The action of the emergency stop in the table of keys (Settings::keys), and its keys unless it says others.
inline constexpr const char *kStopAction = "device.stop", *kStopKeys = "F9";

// Draws into the window that is open, as wide as it is. `stop_keys`: of the emergency stop, "F9".
void device_list(const DevicesView& view, const std::string& stop_keys, DeviceOrders& orders);

// In a word, "Tripped"; of what renders nothing, "Connected".
const char* state_word(const DeviceView& device);
// Beside the name of a panel that is not in front: "2 active", "1 stopped"; empty: no device.
std::string devices_badge(const DevicesView& view);

}  // namespace pliant::ui
