// Simulated hands with simulated devices in them (devices/simulated) that move probes and tools: --probe NAME=hand.
// Read before a touch tick, written after it with what left safety. In lockstep a sample a tick; else by the wall
// clock.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "components/world.h"
#include "devices/simulated/simulated_device.h"
#include "runtime/clock.h"
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

// Which surface is stiffer than what a device renders stably, and what is done about it: one sentence, or none.
std::string stiffness_note(const World& world, const std::string& hand, const DeviceCapabilities& can);

// [1] What of a surface's force may reach such a device, so that it feels no stiffer than the device renders stably. A
// share of a passive force is passive; the surface itself, and what others feel of it, stay as they are.
double softening(const World& world, const DeviceCapabilities& can);
// What safety is to hold to before that share is taken, so that nothing is limited twice.
DeviceCapabilities before_softening(DeviceCapabilities can, double share);

class SimulatedHands {
 public:
  // A hand for this probe or tool. It wants to follow the device's path (script, orbit), which is its own from now on;
  // without one it stays where the device is. Before the clocks start.
  Status add(World& world, Entity hand, const std::string& name, const std::string& words, bool lockstep);
  bool empty() const { return hands_.empty(); }
  bool moves(Entity hand) const;
  double seconds() const;  // [s] of the longest path that does not repeat
  const std::vector<std::string>& notes() const { return notes_; }

  Status open();  // right before the loop: the hands begin
  // Around a tick; neither allocates nor waits.
  void read(World& world, Tick tick);
  void write(World& world);
  void let_go(World& world);  // instead of write(): nobody feels anything
  void idle();                // instead of both while a loop is paused; on the wall clock the hands go on
  void close() noexcept;
  ~SimulatedHands() { close(); }
  SimulatedHands() = default;
  SimulatedHands(SimulatedHands&&) noexcept = default;
  SimulatedHands& operator=(SimulatedHands&&) noexcept = default;

 private:
  struct Held {
    Entity device = kNoEntity, hand = kNoEntity;
    std::unique_ptr<Driver> driver;
    double seconds = 0.0, share = 1.0;  // share: softening()
    bool ready = false;
  };
  std::vector<Held> hands_;
  std::vector<std::string> notes_;
  bool open_ = false;
};

}  // namespace pliant
