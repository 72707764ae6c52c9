// Instruments for a level: a mesh, a body, a handle and the haptic device that moves it. Values suit the given object.
#pragma once

#include <span>

#include "content/author/object_frame.h"
#include "pliant/parameters.h"

namespace pliant {

enum class InstrumentKind : std::uint8_t { kRod, kSphereTip, kTweezersArm, kHand };

struct Instrument {
  InstrumentKind kind;
  const char* word;   // name in commands
  const char* about;  // short description
  double length;      // [1] of the object's diagonal, used if no length is given; 0: life size
  double tip;         // [1] tip radius as a fraction of the length
};
std::span<const Instrument> instruments();
const Instrument* find_instrument(const std::string& word);

struct InstrumentSize {
  double length = 0.0;  // [m] 0: chosen from the object
  double tip = 0.0;     // [m] radius of the tip; 0: from the length. Unused for a hand
};

// Places the instrument over the object, as near to its middle as it is thick there. Its tip points down (along
// Level::simulation's gravity), kClearance of the diagonal above the object. Rigid instruments weigh 25 g, so
// that one coupling suits every size; the hand is soft. The device has no driver yet. Returns the new node's number.
// Error: the object has no mesh.
Result<std::int32_t> add_instrument(Level& level, InstrumentKind kind, std::int32_t object,
                                    const InstrumentSize& size = {});
// Adds a probe with a haptic device in the same way. `radius` [m], 0: chosen from the object.
Result<std::int32_t> add_probe(Level& level, std::int32_t object, double radius = 0.0);

inline constexpr double kClearance = 0.1;  // [1]

// Moves the tool or probe straight down from its present place until it is pressed `depth` [m] into the object, rests,
// and moves up: 6 s. Depth 0: a twentieth of the object's diagonal, at most a third of its thickness there. World
// frame, for its script.
Path press_path(const Level& level, std::int32_t tool, std::int32_t object, double depth = 0.0);

}  // namespace pliant
