// Gamepads and joysticks under /dev/input, by Linux's evdev.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/drivers/gamepad.h"

namespace pliant {

struct GamepadFound {
  std::string path;      // /dev/input/event7
  std::string id;        // its unique id (a serial or address), else the path
  GamepadTraits traits;  // without the ranges of its axes, which need an open device
  std::string missing;   // why it cannot be opened and the remedy; empty: it can
  std::string hardware;  // DeviceInfo::hardware
};

// Event devices in sysfs with ABS_X, ABS_Y and a button of a gamepad or joystick.
std::vector<GamepadFound> find_gamepads();
// By id or path; empty: the first that can be opened. Effects are sent on a separate thread.
Result<std::unique_ptr<GamepadLine>> open_gamepad(const std::string& id);

}  // namespace pliant
