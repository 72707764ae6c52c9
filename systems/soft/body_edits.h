// What whoever owns a run does to bodies between steps: forces of its own, pushes, places. Travels by Ring to the soft
// clock, which takes all that waits before a step; in lockstep, between the same two steps in every run.
#pragma once

#include <cstdint>

#include "components/math.h"
#include "components/transform.h"
#include "runtime/entity.h"

namespace pliant {

class Body;
struct World;

enum class BodyEditKind : std::uint8_t {
  kLoad,     // `force` at the centre of mass and `torque`, until another one comes
  kLoadAt,   // `force` at a vertex, until another one comes for it; zero: none any more
  kPush,     // `force` [N s] and `torque` [N m s], once
  kPushAt,   // `force` [N s] at a vertex, once
  kPlace,    // `pose`, at rest
  kPresent,  // it meets others and is stepped
  kAbsent    // it meets nothing, and stands where it is
};

struct BodyEdit {
  BodyEditKind kind = BodyEditKind::kLoad;
  Entity body;
  std::uint32_t triangle = 0;  // of the collision mesh, and which of its corners: a vertex
  int corner = 0;
  dvec3 force{0}, torque{0};  // world
  Pose pose;                  // object frame to world
};
inline constexpr std::size_t kMostBodyEdits = 1024;  // that wait for a step

// Before the bodies' free motion.
void take_body_edits(World& world);
// After a body's free step over T [s]: v* with what is on it beside contacts.
void take_loads(Body& body, double T);

}  // namespace pliant
