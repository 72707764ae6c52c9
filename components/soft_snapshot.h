// State sent from the soft clock to the visual clock: positions of collision meshes, tetrahedra, rigid bodies and
// contacts.
#pragma once

#include <cstdint>
#include <vector>

#include "components/math.h"
#include "components/transform.h"
#include "runtime/entity.h"

namespace pliant {

inline constexpr std::size_t kMaxShownContacts = 512;

// One SoftBody or RigidBody that moves.
struct SoftObjectSnapshot {
  Entity object;
  Pose pose;                   // RigidBody: world. SoftBody: of its handle, or identity
  std::vector<vec3> position;  // [m] world, per collision mesh vertex; empty: the rest shape under `pose`
  std::vector<vec3> normal;    // [1] world, unit, per collision mesh vertex
  std::vector<vec3> nodes;     // [m] world, of the tetrahedra; empty for rigid bodies
};

// One side of a contact: a point of a collision mesh.
struct ContactPlace {
  Entity entity;
  std::uint32_t triangle = 0;
  vec3 barycentric{1, 0, 0};  // [1]
};

struct ContactMark {
  vec3 position{0};  // [m] world
  vec3 normal{0};    // [1] world, from body b towards body a
  vec3 force{0};     // [N] world, on body a
  bool sliding = false;
  float depth = 0.0f;  // [m] of a in b at the beginning of the step; below 0: still apart
  ContactPlace a, b;
};

// A tool's state on the soft clock.
struct HandleMark {
  Entity tool;  // has a Handle6
  Pose pose;
  vec3 force{0}, torque{0};   // [N], [N m] world, that tissue and contacts put on the handle
  vec3 middle{0}, wanted{0};  // [m] world, of the handle: its centre, and the centre prescribed by the device
};

struct SoftSnapshot {
  std::uint64_t step = 0;
  double time = 0.0;     // [s]
  double step_ms = 0.0;  // [ms] cost of the last step
  std::vector<SoftObjectSnapshot> objects;
  std::uint32_t contact_count = 0;    // found; `contacts` has the first kMaxShownContacts of them
  std::vector<ContactMark> contacts;  // capacity kMaxShownContacts
  std::vector<HandleMark> handles;
};

}  // namespace pliant
