// The devices of a run, for the windows of `pliant run` and `pliant edit`: state, axes, forces, rates, and buttons to
// arm and stop them.
#pragma once

#include <string>

#include "engine/run/device_view.h"

namespace pliant::ui {

// Draws into the current window at its width. `stop_keys`: of the emergency stop, "F9".
void device_list(const DevicesView& view, const std::string& stop_keys, DeviceOrders& orders);

// In one word, "Tripped"; for devices that render nothing, "Connected".
const char* state_word(const DeviceView& device);
// Shown with the name of a hidden panel: "2 active", "1 stopped"; empty: no device.
std::string devices_badge(const DevicesView& view);

}  // namespace pliant::ui
