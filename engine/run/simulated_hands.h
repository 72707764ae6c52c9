// Simulated hands with simulated devices in them (devices/simulated) that move probes and tools: --probe NAME=hand.
// A DriverLink (driver_link.h) connects them as it does any device: servo, guard and all.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/world.h"
#include "devices/simulated/simulated_device.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr std::string_view kHandId = "hand:";  // in front of the words, as the id of what such a hand holds

// The words behind "hand:" of a source, apart: [FILE][,PROFILE][,KEY=VALUE...][|WRAPPER=VALUE...], in any order before
// the bar. FILE is what is neither a profile's name nor holds '='.
struct HandWords {
  std::string file;      // of the path; "": the level's own script, or an orbit
  std::string device;    // profile and keys, for parse_simulated
  std::string wrappers;  // for wrap()
};
HandWords hand_words(const std::string& words);

class SimulatedHands {
 public:
  // A hand for this probe or tool. It wants to follow the device's path (script, orbit), which is its own from now on;
  // without one it stays where the device is. Before the clocks start.
  Status add(World& world, Entity hand, const std::string& words);
  bool empty() const { return hands_.empty(); }
  bool moves(Entity hand) const;
  double seconds() const;  // [s] of the longest path that does not repeat
  const std::vector<std::string>& notes() const { return notes_; }

  struct Held {
    Entity hand = kNoEntity;
    std::unique_ptr<Driver> driver;     // wrappers and all, not opened; whoever connects it takes it
    SimulatedDevice* device = nullptr;  // within it
    dvec3 middle{0};                    // [m] world: of its workspace, as DriverLink::begin() takes it
    double seconds = 0.0;
  };
  std::vector<Held>& held() { return hands_; }

 private:
  std::vector<Held> hands_;
  std::vector<std::string> notes_;
};

}  // namespace pliant
