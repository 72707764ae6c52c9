// Simulated hands that hold simulated devices (devices/simulated) and move probes and tools: --probe NAME=hand. A
// DriverLink (driver_link.h) connects them like any device, with servo and guard.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/world.h"
#include "devices/simulated/simulated_device.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr std::string_view kHandId = "hand:";  // prefix of the id of a device in a simulated hand

// The parsed words after "hand:" of a source: [FILE][,PROFILE][,KEY=VALUE...][|WRAPPER=VALUE...], in any order before
// the bar. FILE is a word that is neither a profile's name nor contains '='.
struct HandWords {
  std::string file;      // of the path; "": the level's script, or an orbit
  std::string device;    // profile and keys, for parse_simulated
  std::string wrappers;  // for wrap()
};
HandWords hand_words(const std::string& words);

class SimulatedHands {
 public:
  // Adds a hand for this probe or tool. It takes over the device's path (script, orbit) as its target; without one it
  // stays at the device's place. Call before the clocks start.
  Status add(World& world, Entity hand, const std::string& words);
  bool empty() const { return hands_.empty(); }
  bool moves(Entity hand) const;
  double seconds() const;  // [s] of the longest path that does not repeat
  const std::vector<std::string>& notes() const { return notes_; }

  struct Held {
    Entity hand = kNoEntity;
    std::unique_ptr<Driver> driver;     // with wrappers, not opened; DeviceLinks takes it when connecting
    SimulatedDevice* device = nullptr;  // owned by the driver
    dvec3 middle{0};                    // [m] world: centre of its workspace, as for DriverLink::begin()
    double seconds = 0.0;
  };
  std::vector<Held>& held() { return hands_; }

 private:
  std::vector<Held> hands_;
  std::vector<std::string> notes_;
};

}  // namespace pliant
