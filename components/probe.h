// What a person holds against the surface: a point, a sphere, a capsule (a stylus, an instrument's shaft), or a small
// set of points or spheres. Each of them is a set of tips: a sphere about a place in the probe's frame, of radius 0 for
// a point.
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

// What the mouse does with its probe besides moving it. A device does neither.
struct ProbeHold {
  bool hovers = false;       // clear of everything: among bodies it is put where its device is, and meets none
  Entity body = kNoEntity;   // soft or rigid, that it pulls: a spring from `point` to where it is; kNoEntity: none
  dvec3 point{0};            // [m] world, on the body's surface when it was taken hold of
  std::uint32_t number = 0;  // another one with every hold that is taken
  bool operator==(const ProbeHold&) const = default;
};

// Rate: touch. Writer: read_devices (pose, velocity), friction_feedback (force).
struct Probe : ProbeParameters {
  Handle<Mesh> shell;         // set at spawn where there are bodies that it meets: its surface, probe frame
  Entity device = kNoEntity;  // has a HapticDevice; kNoEntity: nobody moves it

  dvec3 position{0};           // [m] world
  dquat rotation{1, 0, 0, 0};  // world
  dvec3 velocity{0};           // [m/s] world
  dvec3 previous{0};           // [m] world, one tick ago: the start of the swept segment
  dquat previous_rotation{1, 0, 0, 0};
  bool placed = false;  // false until the device has given a first pose; then `previous` means something
  bool fresh = false;   // this tick's pose is the first one
  ProbeHold hold;       // writer: read_mouse, or who sets its pose

  dvec3 force{0};   // [N] world, on the probe: the sum over its contacts, before the safety layer
  dvec3 torque{0};  // [N m] world, about the probe's position: what its contacts make at their lever
};

inline constexpr Range kProbeLengths{0.0, 1e3};  // [m] radius, length and coordinates of points

}  // namespace pliant
