// Driver `polhem`: WoodenHaptics and Polhem v1 over USB HID: three axes of force, six of sensing (polhem_kinematics.h).
//
// `id`: serial number or path, then
//   mechanism=NAME   the build of the arm; required, because the device cannot report it and the force depends on it
//   home=button      (default) pose unknown and force zero until the arm is parked and its button is pressed
//   home=here        the arm is parked now
//   home=kept        the encoders were set after power-up
// The device answers each report: the first zero report starts it, wait() returns with its answer. Its own watchdog
// switches the motors off 0.5 s after the last report.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "devices/drivers/polhem_kinematics.h"
#include "devices/drivers/stick_control.h"
#include "devices/ports/packet_port.h"
#include "pliant/driver.h"

namespace pliant {

struct PolhemInput {
  std::array<std::int16_t, 6> counts{};
  std::int16_t info = 0;  // nonzero: the calibration button was pressed after the encoders were set
  bool button = false;    // of the pen: encoded as 10000 added to the fourth encoder
};

// False: the report is too short.
bool parse_polhem(std::span<const std::uint8_t> report, PolhemInput& input);

inline constexpr std::size_t kPolhemOutput = 65;  // report number 0, then 64 bytes
// Currents [A], truncated to whole milliamperes.
void polhem_drive(const dvec3& currents, std::span<std::uint8_t, kPolhemOutput> into);
// Sets the encoders; the motors are off in this report.
void polhem_set_encoders(const std::array<int, 6>& counts, std::span<std::uint8_t, kPolhemOutput> into);

std::unique_ptr<Driver> make_polhem(PortOpener opener, SecondsClock clock = monotonic_seconds);
Status register_polhem();

}  // namespace pliant
