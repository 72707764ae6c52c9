// State sent from the touch clock to the visual clock: the streams of changed zones, the probes, and moving objects.
// Exchanged by TripleBuffer. A snapshot has at most kMaxPublishedZones zones per object, so publishing has a bounded
// cost. Zones that did not fit, or were replaced before the reader saw them, stay dirty and are sent later.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "components/field_feed.h"
#include "components/field_source.h"
#include "components/math.h"
#include "runtime/entity.h"

namespace pliant {

inline constexpr std::uint32_t kMaxPublishedZones = 512;

struct ObjectSnapshot {
  Entity object;                     // has a Deformable
  std::uint32_t zone_count = 0;      // valid entries of `zones`
  std::vector<std::uint32_t> zones;  // zone indices, capacity min(all, kMaxPublishedZones)
  std::vector<vec4> stream;          // kZoneSize (nx, ny, nz, h) for each of them, packed in the same order
  std::uint32_t awake_vertices = 0;
  bool on_gpu = false;  // no zones: the whole field is these sources, evaluated by the GPU
  std::uint32_t term_count = 0;
  std::vector<FieldSource> terms;  // capacity for every source and release
  // Fields that the GPU steps on its copy: their inputs up to this snapshot's tick while `fed`, else `zones` holds the
  // field.
  std::shared_ptr<FieldFeed> feed;
  bool fed = false;
};

// One place where a probe presses.
struct ProbeContact {
  dvec3 position{0};  // [m] world, on the undeformed surface
  dvec3 force{0};     // [N] world, on the probe, before the safety layer
};
inline constexpr std::uint32_t kMostShownContacts = 8;  // of a probe, the first ones

struct ProbeSnapshot {
  Entity probe;
  dvec3 position{0};  // [m] world
  dquat rotation{1, 0, 0, 0};
  dvec3 force{0};  // [N] world, as sent to the hand
  bool touching = false;
  double depth = 0.0;  // [m] below the undeformed surface, of the deepest contact
  dvec3 normal{0};     // [1] of the surface at the deepest contact, world; 0: it touches nothing
  std::uint32_t contact_count = 0;
  std::array<ProbeContact, kMostShownContacts> contacts;
};

// A Drawable moved by a prescribed motion.
struct MovedSnapshot {
  Entity object;
  mat4 to_world{1};  // object frame to world
};

struct Snapshot {
  std::uint64_t tick = 0;
  double time = 0.0;     // [s]
  bool complete = true;  // false: more dirty zones are waiting
  std::vector<ObjectSnapshot> objects;
  std::vector<ProbeSnapshot> probes;
  std::vector<MovedSnapshot> moved;  // all that can move, in every snapshot
};

}  // namespace pliant
