// The touch tick's working memory: everything is sized by prepare_touch, so that a tick never allocates.
// Writer: the touch clock.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "components/world.h"
#include "systems/safety/safety.h"
#include "systems/touch/box_tree.h"
#include "systems/touch/contact_energy.h"
#include "systems/touch/feed_field.h"
#include "systems/touch/foot_blend.h"
#include "systems/touch/local_model.h"
#include "systems/touch/move_objects.h"
#include "systems/touch/painted_motion.h"
#include "systems/touch/press.h"
#include "systems/touch/shape.h"
#include "systems/touch/surface_distance.h"

namespace pliant {

inline constexpr std::uint32_t kMaxContactsPerObject = 64;  // one bit each in ObjectState::zone_sources

// A sphere that a probe touches with.
struct Tip {
  dvec3 place{0};     // [m] its centre, probe frame
  double radius = 0;  // [m] 0: a point
};

// A source of an object, by their places.
struct SourceLink {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t object = kNone, source = kNone;
  bool valid() const { return object != kNone; }
  bool operator==(const SourceLink&) const = default;
};

// Where a contact's tip was behind the surface: it may come back through a wall that it was pressed through.
struct HeldFoot {
  std::uint64_t tick = 0;  // after which it was
  Entity probe;
  std::uint8_t tip = 0;
  dvec3 p{0};  // [m] object frame
};

// One place of an object's pool: a contact, where it is, and its share in the object's field.
struct SourceState {
  Entity contact;                    // has a Contact
  std::uint64_t born = 0;            // tick after which it was first followed
  bool tracked = false;              // collision follows it: a probe's, near the surface or behind it
  dvec3 x{0};                        // [m] the tip's centre last tick, object frame
  Tip tip;                           // which the contact is of
  FootBlend place;                   // of the tip's centre
  HeldFoot held;                     // written where its contact is followed
  bool active = false;               // the contact dented the surface in the last tick
  FieldSource now, before;           // this tick's and the last tick's: their difference is the target's rate
  std::vector<std::uint32_t> zones;  // within reach; capacity: all zones
  std::vector<vec3> offset;          // [m] Distance::kSurface only, per vertex: see surface_distance.h
  std::uint32_t told = 0;            // number of the dent in the feed (feed_field.h)
  SourceLink of;                     // an echo: of this source of a neighbour (seam_dents.h)
  std::uint64_t echoed = 0;          // tick after which it last was one
  std::vector<MarchItem> heap;       // working memory of the march; its capacity is what matters
};

// GPU only: what a contact left behind at a moment. See field.h.
struct Release {
  FieldSource now, before;  // the target at that moment and one tick earlier
  double time = 0.0;        // [s] of that moment
};
inline constexpr std::size_t kMaxReleases = 64;

// A contact without a probe: tissue of a tool presses here.
struct PressState {
  Entity contact;  // has a Contact
  bool used = false;
  PressPoint point;
};

// At rest: heights below this share of the reach, normals turned by less than this angle [rad]. Nobody sees or feels
// it.
inline constexpr float kRest = 1e-6f;

// An edge where another surface goes on: a node flush with this one, or the far side of a crack (seams.h).
struct Seam {
  std::uint32_t edge = 0;      // 3 * triangle + edge
  std::uint32_t object = 0;    // its place in TouchState::objects
  std::uint32_t triangle = 0;  // of that object, where it goes on
};

// A zone that a seam leads out of, and the zone where it goes on.
struct SeamZones {
  std::uint32_t zone = 0;
  std::uint32_t object = 0;  // its place in TouchState::objects
  std::uint32_t other = 0;   // of that object
  auto operator<=>(const SeamZones&) const = default;
};

// One Deformable, as the systems need it.
struct ObjectState {
  Entity entity;
  Motion motion;  // where nothing is painted
  PaintedMotion painted;
  std::vector<Seam> seams;                  // by edge, ascending
  std::vector<SeamZones> seam_zones;        // to other objects, each pair once
  std::vector<std::uint32_t> joined;        // objects that a dent may go on in, over any number of seams, each once
  std::vector<SeamZones> cracks;            // to zones of its own
  std::vector<std::uint32_t> neighbours;    // objects that seams lead to, each once
  std::vector<std::uint32_t> closed;        // edges of seams, from both sides, ascending: no foot goes over them
  BoxTree crease_boxes;                     // of `creases`, object frame
  std::vector<std::uint32_t> creases;       // convex ones, from both sides: 3 * triangle + edge
  ShareKernel kernel;                       // how contacts share their load
  Box world_box;                            // of the rest surface, for the broad phase
  std::uint32_t probe_sources = 0;          // how many of `sources` are for probes; presses come after
  double stored = 0.0;                      // [J] U: elastic energy of all its contacts (contact_energy.h)
  bool listed = false;                      // it stands in TouchState::awake
  std::vector<dvec3> searched;              // [m] per tip of every probe: where other walls were last looked for
  bool on_gpu = false;                      // the field is `terms`, drawn by the GPU; there is no HeightField
  std::vector<Release> releases;            // GPU only; capacity kMaxReleases
  std::vector<FieldSource> terms;           // GPU only: the whole field at `time`
  FieldTeller teller;                       // where the GPU steps a copy of the field
  double time = 0.0;                        // [s] end of the last tick
  std::vector<SourceState> sources;         // a pool for probes, one per press, echoes; at most kMaxContactsPerObject
  std::uint32_t first_echo = 0;             // of sources
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
  std::vector<Tip> tips;
  std::uint32_t first_tip = 0;  // of all probes' tips: its place in ObjectState::searched
};

struct TouchState {
  std::vector<ObjectState> objects;
  BoxTree object_boxes;  // world boxes of the objects, with room for curved patches
  std::vector<ProbeState> probes;
  std::vector<std::uint32_t> awake;  // objects with a tracked contact or a field that moves; capacity: all
  std::uint32_t unseen = 0;          // snapshots in a row that nobody took
  double extent = 1.0;               // [m] diagonal of everything that can be touched
  double dt = 1e-3;                  // [s] the step that `motion` was computed for
  std::vector<MovingNode> moving;    // every node under a prescribed motion that carries something
  std::unique_ptr<TripleBuffer<Presses>> presses;  // soft clock -> touch clock; null where nothing could press
  std::vector<LoadedContact> loaded;               // of the object in hand; size kMaxContactsPerObject
  double pressed_at = 0.0;                         // [s] when the newest of them came
};

}  // namespace pliant
