// 3Dconnexion's six-axis caps, wired and wireless: a sprung cap that is pushed and rotated. Input only, no force.
//
// Axes. The device counts right, towards its user and down (right-handed); world is right, up, towards its user: world
// = (x, -z, y), for translation and rotation. By rate the cap's deflection is a velocity, by position a displacement.
// Buttons: bit mask in the device's numbering; the second is the clutch, which freezes the pose while pressed.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "devices/drivers/stick_control.h"
#include "devices/ports/hid_descriptor.h"
#include "devices/ports/packet_port.h"
#include "pliant/driver.h"

namespace pliant {

// Location of the six axes and the buttons in the reports.
struct SpaceMouseLayout {
  HidLayout hid;
  std::array<HidField, 6> axes{};  // X Y Z Rx Ry Rz
  std::vector<HidField> buttons;   // at most 32
};

// From the report descriptor. Without one (an old kernel, another transport): three int16 in reports 1 and 2, or six in
// report 1, a button mask in report 3, full scale 350.
Result<SpaceMouseLayout> spacemouse_layout(std::span<const std::uint8_t> descriptor);

struct SpaceMouseState {
  std::array<double, 6> axes{};  // [1] in [-1, 1], device axes
  std::uint32_t buttons = 0;
};

enum class SpaceMousePart : std::uint8_t { kNothing, kAxes, kButtons };

// Parses a report into `state`; values not in the report are kept. kNothing: another report, or one that is too short.
SpaceMousePart parse_spacemouse(const SpaceMouseLayout& layout, std::span<const std::uint8_t> report,
                                SpaceMouseState& state);

// Registered as `spacemouse`. `id`: serial number or path, followed by stick_control.h's options.
std::unique_ptr<Driver> make_spacemouse(PortOpener opener, SecondsClock clock = monotonic_seconds);
Status register_spacemouse();

}  // namespace pliant
