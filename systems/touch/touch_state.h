// The touch tick's working memory: everything is sized by prepare_touch, so that a tick never allocates.
// Writer: the touch clock.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "components/world.h"
#include "systems/device/safety.h"
#include "systems/touch/local_model.h"
#include "systems/touch/press.h"
#include "systems/touch/shape.h"
#include "systems/touch/surface_distance.h"

namespace pliant {

inline constexpr std::uint32_t kMaxContactsPerObject = 64;  // one bit each in ObjectState::zone_sources

// A contact's share in its object's field.
struct SourceState {
  Entity contact;                    // has a Contact; one without a probe is a press
  bool active = false;               // the contact touched in the last tick
  FieldSource now, before;           // this tick's and the last tick's: their difference is the target's rate
  std::vector<std::uint32_t> zones;  // within reach; capacity: all zones
  std::vector<vec3> offset;          // [m] Distance::kSurface only, per vertex: see surface_distance.h
  std::vector<MarchItem> heap;       // working memory of the march; its capacity is what matters
};

// Card only: what a contact left behind at a moment. See field.h.
struct Release {
  FieldSource now, before;  // the target at that moment and one tick earlier
  double arm = 0.0;         // [1] how much of the standard linear solid's arm was stretched, per unit of height
  double time = 0.0;        // [s] of that moment
};
inline constexpr std::size_t kMaxReleases = 64;

// A contact without a probe: flesh of a tool presses here.
struct PressState {
  Entity contact;  // has a Contact
  bool used = false;
  PressPoint point;
};

// At rest: heights below this share of the reach, normals turned by less than this angle [rad]. Nobody sees or feels
// it.
inline constexpr float kRest = 1e-6f;

// One Deformable, as the systems need it.
struct ObjectState {
  Entity entity;
  Motion motion;
  Box world_box;                            // of the rest surface, for the broad phase
  bool on_card = false;                     // the field is drawn by the card from `terms`; there is no HeightField
  std::vector<Release> releases;            // card only; capacity kMaxReleases
  std::vector<FieldSource> terms;           // card only: the whole field at `time`
  double time = 0.0;                        // [s] end of the last tick
  float peak = 0.0f;                        // [m] how high any part of the field stands above rest, last tick
  std::vector<SourceState> sources;         // one per probe, then one per press; capacity kMaxContactsPerObject
  std::vector<PressState> presses;          // empty unless the level has something soft or rigid that moves
  std::vector<std::uint64_t> zone_sources;  // per zone: which sources reach it this tick
  std::vector<std::uint32_t> visited;       // per zone: stamp of the last flood that came by
  std::uint32_t stamp = 0;
  std::vector<std::uint32_t> dirty;    // zones whose stream has not been published since it changed
  std::vector<std::uint32_t> waiting;  // zones of the last snapshot, in case the reader never sees it
};

struct ProbeState {
  Entity entity;
  SafetyState safety;
  std::vector<Entity> contacts;  // one per object
};

struct TouchState {
  std::vector<ObjectState> objects;
  std::vector<ProbeState> probes;
  std::uint32_t unseen = 0;                        // snapshots in a row that nobody took
  double extent = 1.0;                             // [m] diagonal of everything that can be touched
  double dt = 1e-3;                                // [s] the step that `motion` was computed for
  std::unique_ptr<TripleBuffer<Presses>> presses;  // soft clock -> touch clock; null where nothing could press
  double pressed_at = 0.0;                         // [s] when the newest of them came
};

}  // namespace pliant
