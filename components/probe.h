// The tool that presses the surface: a point, a sphere, a capsule (a stylus, an instrument's shaft), or a small set of
// points or spheres. Each is a set of tips: spheres at fixed places in the probe's frame, of radius 0 for points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "components/math.h"
#include "components/range.h"
#include "pliant/parameters.h"
#include "runtime/entity.h"
#include "runtime/store.h"

namespace pliant {

struct Mesh;

// Actions of the mouse on its probe besides moving it. Other devices do neither.
struct ProbeHold {
  bool hovers = false;       // clear of everything: among bodies the probe is put at its device and collides with none
  Entity body = kNoEntity;   // soft or rigid, pulled by a spring from `point` to the probe; kNoEntity: none
  dvec3 point{0};            // [m] world, on the body's surface when the hold began
  std::uint32_t number = 0;  // differs for every hold
  bool operator==(const ProbeHold&) const = default;
};

// Rate: touch. Writer: read_devices (pose, velocity), friction_feedback (force).
struct Probe : ProbeParameters {
  Handle<Mesh> shell;         // set at spawn if the level has bodies that it can touch: its surface, probe frame
  Entity device = kNoEntity;  // has a HapticDevice; kNoEntity: not moved

  dvec3 position{0};           // [m] world
  dquat rotation{1, 0, 0, 0};  // world
  dvec3 velocity{0};           // [m/s] world
  dvec3 previous{0};           // [m] world, one tick ago: the start of the swept segment
  dquat previous_rotation{1, 0, 0, 0};
  bool placed = false;  // false until the device has given a first pose; then `previous` is valid
  bool fresh = false;   // this tick's pose is the first one
  ProbeHold hold;       // writer: read_mouse, or the caller that sets its pose

  dvec3 force{0};   // [N] world, on the probe: the sum over its contacts, before the safety layer
  dvec3 torque{0};  // [N m] world, about the probe's position: from its contacts' lever arms
};

inline constexpr Range kProbeLengths{0.0, 1e3};  // [m] radius, length and coordinates of points

}  // namespace pliant
