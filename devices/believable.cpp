#include "devices/believable.h"

#include <fmt/format.h>

namespace pliant {
namespace {

constexpr double kSlowest = 10.0, kFastest = 20000.0;  // [Hz] slower ones would block a run

struct Figure {
  double DeviceCapabilities::*value;
  const char *what, *unit;
  double most;
};
constexpr Figure kFigures[] = {
    {&DeviceCapabilities::max_force, "largest force", "N", 1000.0},
    {&DeviceCapabilities::continuous_force, "continuous force", "N", 1000.0},
    {&DeviceCapabilities::max_torque, "largest torque", "N m", 100.0},
    {&DeviceCapabilities::max_grip, "largest force of its grip", "N", 1000.0},
    {&DeviceCapabilities::max_stiffness, "largest stiffness", "N/m", 1e7},
    {&DeviceCapabilities::max_velocity, "largest velocity", "m/s", 1000.0},
    {&DeviceCapabilities::rate, "rate", "Hz", kFastest},
    {&DeviceCapabilities::latency, "latency", "s", 200.0},
    {&DeviceCapabilities::damping, "damping", "N s/m", 1e4},
};
constexpr double kWidest = 100.0;  // [m] half of a workspace

}  // namespace

std::string beyond_belief(const DeviceCapabilities& can) {
  for (const Figure& figure : kFigures) {
    const double said = can.*figure.value;
    if (said >= 0.0 && said <= figure.most) continue;
    return fmt::format(
        "says a {} of {:g} {}, and must say a number from 0 (not known) to {:g}; correct what the device "
        "says of itself",
        figure.what, said, figure.unit, figure.most);
  }
  if (can.rate > 0.0 && can.rate < kSlowest)
    return fmt::format("says a rate of {:g} Hz, and must say one from {:g} Hz, or 0 (not known)", can.rate, kSlowest);
  for (int i = 0; i < 3; ++i)
    if (!(can.workspace[i] >= 0.0 && can.workspace[i] <= kWidest))
      return fmt::format(
          "says a workspace of {:g} m to either side, and must say a number from 0 to {:g}; metres are "
          "meant",
          can.workspace[i], kWidest);
  return {};
}

}  // namespace pliant
