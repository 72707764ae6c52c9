#include <fmt/format.h>

#include "devices/pose_file.h"
#include "devices/simulated/simulated_device.h"
#include "devices/spec.h"

namespace pliant {
namespace {

constexpr double kLongestDelay = 1.0;     // [s]
constexpr double kFastestRate = 20000.0;  // [Hz]
constexpr double kShortest = 10e-6;       // [s] smallest time constant of a motion or an amplifier: its steps are half
                                          // of it
constexpr double kFarthestOption = 10.0;  // [m] of `at`
constexpr double kHardest = 1000.0;       // [N] of `push`

struct NumberKey {
  const char* name;
  double DeviceProfile::*value;
  std::optional<double> (*read)(std::string_view);
  double least, most;
  const char* what;
};
constexpr NumberKey kNumbers[] = {
    {"rate", &DeviceProfile::rate, plain_number, 10.0, kFastestRate, "a rate from 10 to 20000 Hz"},
    {"delay", &DeviceProfile::delay, seconds_of, 0.0, kLongestDelay, "a time up to 1s, as 5ms"},
    {"lag", &DeviceProfile::lag, seconds_of, 0.0, kLongestDelay, "a time up to 1s, as 0.3ms"},
    {"mass", &DeviceProfile::mass, plain_number, 1e-3, 100.0, "a mass from 0.001 to 100 kg"},
    {"damping", &DeviceProfile::damping, plain_number, 0.0, 1e3, "a damping from 0 to 1000 N s/m"},
    {"friction", &DeviceProfile::friction, newtons_of, 0.0, 100.0, "a force from 0 to 100 N"},
    {"encoder", &DeviceProfile::encoder, metres_of, 0.0, 0.1, "a length up to 0.1 m, as 0.05mm"},
    {"force_step", &DeviceProfile::force_step, newtons_of, 0.0, 10.0, "a force from 0 to 10 N, as 5mN"},
    {"max_torque", &DeviceProfile::max_torque, plain_number, 0.0, 10.0, "a torque from 0 to 10 N m"},
    {"max_force", &DeviceProfile::max_force, newtons_of, 0.0, 1e3, "a force from 0 to 1000 N"},
};

}  // namespace

Result<SimulatedOptions> parse_simulated(const std::string& id) {
  SimulatedOptions options;
  const std::string where = "simulated:" + id;
  bool first = true;
  for (const std::string& part : split(id, ',')) {
    const Option option = option_of(part);
    const auto wrong = [&](const std::string& what, const std::string& cure = {}) { return Error{where, what, cure}; };
    if (option.key.empty()) {
      const DeviceProfile* profile = first ? find_device_profile(option.value) : nullptr;
      if (!profile)
        return wrong(fmt::format("unknown profile '{}'", option.value),
                     fmt::format("profiles are: {}", device_profile_names()));
      options.profile = *profile;
    } else if (option.key == "hand") {
      const HandImpedance* hand = find_hand_impedance(option.value);
      if (!hand) return wrong(fmt::format("hand must be one of none, finger, relaxed, firm; got '{}'", option.value));
      options.hand = *hand;
    } else if (option.key == "clock") {
      if (option.value != "wall" && option.value != "tick")
        return wrong(fmt::format("clock must be one of wall, tick; got '{}'", option.value));
      options.clock = option.value == "tick" ? DeviceClock::kTick : DeviceClock::kWall;
    } else if (option.key == "stops") {
      if (option.value != "on" && option.value != "off")
        return wrong(fmt::format("stops must be one of on, off; got '{}'", option.value));
      options.stops = option.value == "on";
    } else if (option.key == "path") {
      auto rows = read_poses(option.value);
      if (!rows) return rows.error();
      options.will.path = path_of(*rows);
    } else if (option.key == "at" || option.key == "push") {
      const std::optional<dvec3> v = vector_of(option.value);
      if (!v) return wrong(fmt::format("{} must be three numbers X:Y:Z; got '{}'", option.key, option.value));
      const double most = option.key == "push" ? kHardest : kFarthestOption;
      if (!(length(*v) <= most))
        return wrong(fmt::format("{} must be at most {:g} {}; got '{}'", option.key, most,
                                 option.key == "push" ? "N" : "m from the middle", option.value));
      if (option.key == "push")
        options.will.push = *v;
      else
        options.will.path.rows = {{0.0, *v, {1, 0, 0, 0}}};
    } else {
      const NumberKey* known = nullptr;
      std::string names = "hand, clock, stops, path, at, push";
      for (const NumberKey& key : kNumbers) {
        names += std::string(", ") + key.name;
        if (option.key == key.name) known = &key;
      }
      if (!known) return wrong(fmt::format("unknown key '{}'", option.key), fmt::format("keys are {}", names));
      const std::optional<double> value = known->read(option.value);
      if (!value || *value < known->least || *value > known->most)
        return wrong(fmt::format("{} must be {}; got '{}'", option.key, known->what, option.value));
      options.profile.*(known->value) = *value;
    }
    first = false;
  }
  const DeviceProfile& profile = options.profile;
  if (profile.lag > 0.0 && profile.lag < kShortest)
    return Error{where, "lag must be 0 or at least 10us, or simulating it takes too long", "give 0"};
  if (profile.damping * kShortest > profile.mass)
    return Error{where, "mass over damping is below 10us, and simulating it takes too long", "give more mass"};
  if (profile.max_torque > 0.0 && !(profile.inertia > 0.0))
    return Error{where, "this profile turns no motors about its axes", "leave max_torque out, or take sigma.7"};
  return options;
}

}  // namespace pliant
