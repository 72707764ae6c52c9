// Drivers `dualsense` (DualSense, DualSense Edge) and `dualshock4`: sticks and motion in; shaking out, and of a
// DualSense the right trigger's resistance. They push nothing: a force is felt as how hard they shake.
//
// Pose. The left stick moves right and towards the user, the right stick up and down (stick_control.h: by rate or by
// position); the rotation is the controller's own (motion_filter.h), world axes where it lies flat with its face up.
// The left shoulder is the clutch of the sticks. Grip: the right trigger. Buttons: SonyButton.
#pragma once

#include <memory>

#include "devices/drivers/sony_report.h"
#include "devices/drivers/stick_control.h"
#include "devices/ports/packet_port.h"
#include "pliant/driver.h"

namespace pliant {

// `id`: serial number or path, then stick_control.h's words.
std::unique_ptr<Driver> make_sony_pad(SonyModel model, PortOpener opener, SecondsClock clock = monotonic_seconds);
Status register_dualsense();
Status register_dualshock4();

}  // namespace pliant
