// Drivers `dualsense` (DualSense, DualSense Edge) and `dualshock4`. Input: sticks and motion; output: vibration, and
// the resistance of a DualSense's right trigger. They cannot push: force is rendered as vibration strength.
//
// Pose. The left stick moves right and towards the user, the right stick up and down (stick_control.h: by rate or by
// position). The rotation is the controller's own (motion_filter.h), in world axes if it lies flat with its face up.
// The left shoulder is the clutch of the sticks. Grip: the right trigger. Buttons: SonyButton.
#pragma once

#include <memory>

#include "devices/drivers/sony_report.h"
#include "devices/drivers/stick_control.h"
#include "devices/ports/packet_port.h"
#include "pliant/driver.h"

namespace pliant {

// `id`: serial number or path, followed by stick_control.h's options.
std::unique_ptr<Driver> make_sony_pad(SonyModel model, PortOpener opener, SecondsClock clock = monotonic_seconds);
Status register_dualsense();
Status register_dualshock4();

}  // namespace pliant
