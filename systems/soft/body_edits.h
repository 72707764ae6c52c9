// Edits of bodies between steps, by the owner of a run: forces, pushes, placement. Sent by Ring to the soft clock,
// which takes all waiting edits before a step; in lockstep, between the same two steps in every run.
#pragma once

#include <cstdint>

#include "components/math.h"
#include "components/transform.h"
#include "runtime/entity.h"

namespace pliant {

class Body;
struct World;

enum class BodyEditKind : std::uint8_t {
  kLoad,     // `force` at the centre of mass and `torque`, until replaced
  kLoadAt,   // `force` at a vertex, until replaced; zero removes it
  kPush,     // `force` [N s] and `torque` [N m s], once
  kPushAt,   // `force` [N s] at a vertex, once
  kPlace,    // `pose`, at rest
  kPresent,  // it has contacts and is stepped
  kAbsent    // it has no contacts, and does not move
};

struct BodyEdit {
  BodyEditKind kind = BodyEditKind::kLoad;
  Entity body;
  std::uint32_t triangle = 0;  // of the collision mesh, and the index of its corner: a vertex
  int corner = 0;
  dvec3 force{0}, torque{0};  // world
  Pose pose;                  // object frame to world
};
inline constexpr std::size_t kMostBodyEdits = 1024;  // capacity of the queue

// Before the bodies' free motion.
void take_body_edits(World& world);
// After a body's free step over T [s]: adds its loads to v*.
void take_loads(Body& body, double T);

}  // namespace pliant
