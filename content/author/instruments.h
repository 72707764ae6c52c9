// Instruments for a level: a mesh, a body, the handle by which it is held, and the haptic device that leads it, in
// numbers that suit the object which it is for.
#pragma once

#include <span>

#include "content/author/object_frame.h"
#include "pliant/parameters.h"

namespace pliant {

enum class InstrumentKind : std::uint8_t { kRod, kSphereTip, kTweezersArm, kHand };

struct Instrument {
  InstrumentKind kind;
  const char* word;   // as it is called in a command
  const char* about;  // in a few words
  double length;      // [1] of the object's diagonal, where no length is asked for; 0: life size
  double tip;         // [1] of its length: radius of the tip
};
std::span<const Instrument> instruments();
const Instrument* find_instrument(const std::string& word);

struct InstrumentSize {
  double length = 0.0;  // [m] 0: by the object
  double tip = 0.0;     // [m] radius of the tip; 0: by the length. A hand has none.
};

// Over the object's highest place under which it is thick, clear of it by kClearance of its diagonal, tip down (against
// Level::simulation's gravity). All are rigid and weigh 25 g, so that one coupling suits every size; the hand is soft.
// The device has no driver yet. The number of the new node. Error: the object has no mesh.
Result<std::int32_t> add_instrument(Level& level, InstrumentKind kind, std::int32_t object,
                                    const InstrumentSize& size = {});
// A probe with a haptic device, likewise. `radius` [m], 0: by the object.
Result<std::int32_t> add_probe(Level& level, std::int32_t object, double radius = 0.0);

inline constexpr double kClearance = 0.1;  // [1]

// Down from where the tool or probe now stands until it is pressed into the object, `depth` [m] (0: a twentieth of the
// object's diagonal, but not more than a third of its thickness there), a rest, and up: 6 s. In world, for its script.
Path press_path(const Level& level, std::int32_t tool, std::int32_t object, double depth = 0.0);

}  // namespace pliant
