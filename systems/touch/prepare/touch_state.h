// The touch tick's working memory. All of it is sized by prepare_touch, so that a tick never allocates. Writer: the
// touch clock.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "components/touch_event.h"
#include "components/world.h"
#include "systems/safety/safety.h"
#include "systems/touch/collide/box_tree.h"
#include "systems/touch/collide/foot_blend.h"
#include "systems/touch/collide/surface_distance.h"
#include "systems/touch/feed/feed_field.h"
#include "systems/touch/feed/press.h"
#include "systems/touch/model/contact_energy.h"
#include "systems/touch/model/local_model.h"
#include "systems/touch/model/painted_motion.h"
#include "systems/touch/model/shape.h"
#include "systems/touch/model/texture.h"
#include "systems/touch/prepare/move_objects.h"

namespace pliant {

inline constexpr std::uint32_t kMaxContactsPerObject = 64;  // one bit each in ObjectState::zone_sources

// A sphere of a probe, or a capsule: all spheres with centres place + s axis, 0 <= s <= 1. A capsule touches with its
// deepest ones (collide/capsule.h).
struct Tip {
  dvec3 place{0};      // [m] probe frame
  dvec3 axis{0};       // [m] the same; zero: a sphere
  double radius = 0;   // [m] 0: a point, or a line
  bool drawn = false;  // it dents the surface that is drawn, and bears no force: a sphere of a capsule
  bool is_capsule() const { return axis != dvec3(0); }
};

// Where a tip is, in any frame.
struct TipPlace {
  dvec3 end{0}, axis{0};  // [m]
  dvec3 at(double along) const { return end + along * axis; }
};

// Around a tip nothing of the surface is nearer to `at` than `radius`. Object frame.
struct ClearBall {
  dvec3 at{0};          // [m]
  double radius = 0.0;  // [m]
};

// Identifies a source by its object and index.
struct SourceLink {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t object = kNone, source = kNone;
  bool valid() const { return object != kNone; }
  bool operator==(const SourceLink&) const = default;
};

// Where on its axis a capsule touches, and how that moves. Of a sphere: zero.
struct AxisPlace {
  double along = 0.0;      // [1] s
  double curvature = 0.0;  // [m] d2 height / ds2; 0: the place does not move along the axis
  dvec3 axis{0};           // [m] object frame
  dvec3 shift{0};          // [1/m] ds/dx
};

// Foot of a contact whose tip was behind the surface: the tip may return through a wall that it was pressed through.
// It stays when the contact slips round a rim, until the tip is clear of the surface.
struct HeldFoot {
  std::uint64_t tick = 0;  // number of the tick that wrote it, plus 1
  Entity probe;
  std::uint8_t tip = 0;
  dvec3 p{0};            // [m] object frame
  dvec3 normal{0};       // [1] of the contact
  double depth = 0.0;    // [m] of the contact
  bool slipped = false;  // its contact slipped round a rim, and its tip is not clear yet
  dvec3 in{0};           // [m] where that tip came in,
  dvec3 entered{0};      // [1] and the normal of the wall there
};

// One entry of an object's pool: a contact, its place, and its part in the object's field.
struct SourceState {
  Entity contact;                    // has a Contact
  std::uint64_t born = 0;            // number of the tick of its first contact, plus 1
  bool tracked = false;              // tracked by collision: a probe's contact, near the surface or behind it
  bool settled = true;               // false: it has depth of which friction_feedback tells how much counts as unpushed
  dvec3 x{0};                        // [m] the tip's centre last tick, object frame
  Tip tip;                           // the tip in contact
  AxisPlace axis;                    // of a capsule
  FootBlend place;                   // of the tip's centre
  dvec3 side{0};                     // [1] from which the tip came, object frame: follows the normal (follow_contact.h)
  dvec3 in{0};                       // [m] where the tip came in: follows strokes alone
  dvec3 entered{0};                  // [1] normal of the wall there
  HeldFoot held;                     // written where its contact is tracked
  bool active = false;               // the contact dented the surface in the last tick
  FieldSource now, before;           // of this tick and of the last: their difference is the target's rate
  std::vector<std::uint32_t> zones;  // within reach; capacity: all zones
  Offsets offset;                    // Distance::kSurface only: see surface_distance.h
  Chart chart;                       // the same; of the contact's triangle, or of an earlier one
  std::uint32_t feed_number = 0;     // index of the dent in the feed (feed_field.h)
  SourceLink of;                     // of an echo: its source in a neighbour (seam_dents.h)
  std::uint64_t echoed = 0;          // number of the last tick in which it was one, plus 1
};

// GPU only: the dent that a contact left. See field.h.
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

// At rest: heights below this share of the reach, normals rotated by less than this angle [rad]. Imperceptible.
inline constexpr float kRest = 1e-6f;

// Two objects that are flush with each other at one relative pose. While they are elsewhere their seams are open.
struct Bond {
  std::uint32_t first = 0, second = 0;  // indices into TouchState::objects
  Pose relative;                        // of the second in the first's frame
  double slack = 0.0;                   // [m] farthest that a point of the second may be from there
  bool open = false;
};

// An edge at which another surface continues: a node flush with this one, or the far side of a crack (seams.h).
struct Seam {
  static constexpr std::uint32_t kCrack = 0xffffffffu;
  std::uint32_t edge = 0;       // 3 * triangle + edge
  std::uint32_t object = 0;     // index into TouchState::objects
  std::uint32_t triangle = 0;   // of that object, at the other side
  std::uint32_t bond = kCrack;  // index into TouchState::bonds; kCrack: a crack in one mesh is always closed
};

// A zone beside a seam, and the zone on the other side.
struct SeamZones {
  std::uint32_t zone = 0;
  std::uint32_t object = 0;  // index into TouchState::objects
  std::uint32_t other = 0;   // of that object
  auto operator<=>(const SeamZones&) const = default;
};

// The seams of an object at all relative poses, found at preparation.
struct SeamsFound {
  struct ClosedEdge {
    std::uint32_t edge = 0, bond = 0;
    auto operator<=>(const ClosedEdge&) const = default;
  };
  struct InnerWall {
    std::uint32_t triangle = 0, bond = 0;
    auto operator<=>(const InnerWall&) const = default;
  };
  struct Zones {
    SeamZones zones;
    std::uint32_t bond = 0;
    auto operator<=>(const Zones&) const = default;
  };
  std::vector<Seam> seams;             // by edge, ascending
  BoxTree boxes;                       // of `seams`, object frame, as wide as a crack
  std::vector<ClosedEdge> closed;      // ascending
  std::vector<InnerWall> inner_walls;  // ascending
  std::vector<Zones> zones;            // ascending
  std::vector<std::uint32_t> bonds;
};

// A place where a probe broke layers. Object frame.
struct Hole {
  dvec3 p{0};                // [m] on the rest surface
  double radius = 0.0;       // [m]
  std::uint32_t broken = 0;  // layers, from the surface down
};
inline constexpr std::size_t kMostHoles = 64;

// A dent that stays: the depth at distance r is depth * phi(r), phi the object's ShareKernel. Object frame.
struct SetDent {
  dvec3 p{0}, normal{0, 1, 0};  // [m] on the rest surface, [1]
  double depth = 0.0;           // [m]
};
inline constexpr std::size_t kMostSets = 256;

// A source that tracks a tip of a probe.
struct TrackedTip {
  Entity probe;
  std::uint8_t tip = 0;
  std::uint8_t source = 0;  // index into ObjectState::sources
};

// Energy between one hand and one object (systems/device/tissue_account.h). [J] of the world
struct TissueAccount {
  double given = 0.0;   // by the hand so far, beside what it got back
  double stored = 0.0;  // in its contacts now
  dvec3 force{0};       // [N] of the object on the probe in the last tick
};

// Touch state of one Deformable.
struct ObjectState {
  Entity entity;
  Motion motion;                  // of unpainted vertices
  double stiffness_before = 0.0;  // [N/m] last tick's, of a surface that varies (components/varying.h); 0: constant
  PaintedMotion painted;
  std::vector<float> felt_stiffness;  // the painted factors as a contact feels them (smooth_paint.h)
  std::vector<float> felt_relaxation;
  std::vector<float> flush_stiffness;  // the same while its seams are closed: that of what is flush with it counts too
  SeamsFound found;                    // all that may be; the next lists have those that are closed now
  std::vector<Seam> seams;             // by edge, ascending
  std::vector<SeamZones> seam_zones;   // to other objects, each pair once
  std::vector<std::uint32_t> joined;   // objects in which a dent may continue, over any number of seams, each once
  std::vector<SeamZones> cracks;       // to zones of the same object
  std::vector<std::uint32_t> neighbours;    // objects beyond its seams, each once
  std::vector<std::uint32_t> closed;        // edges of seams, from both sides, ascending: no foot crosses them
  std::vector<std::uint32_t> inner_walls;   // triangles that are covered (inner_walls.h), ascending: no contact begins
  BoxTree crease_boxes;                     // of `creases`, object frame
  std::vector<std::uint32_t> creases;       // convex ones, from both sides: 3 * triangle + edge
  Texture texture;                          // roughness; no waves: none
  ShareKernel kernel;                       // sharing of the load between contacts
  Box world_box;                            // of the rest surface, for the broad phase
  std::uint32_t probe_sources = 0;          // number of `sources` for probes; presses follow
  std::vector<TrackedTip> tips;             // by source; some may have ended since this tick began. Capacity: all
  std::uint64_t slipped = 0;                // newest HeldFoot::tick of a contact that slipped round a rim
  std::vector<Hole> holes;                  // capacity kMostHoles if it has layers
  std::vector<SetDent> sets;                // capacity kMostSets if it yields
  std::vector<std::uint32_t> set_zones;     // working memory; capacity: all zones if it yields
  double stored = 0.0;                      // [J] U: elastic energy of all its contacts (contact_energy.h)
  std::vector<TissueAccount> accounts;      // per probe
  bool listed = false;                      // it is in TouchState::awake
  std::vector<TipPlace> searched;           // per tip of every probe: place of the last search for walls
  std::vector<ClearBall> clear;             // per tip of every probe: around the place of its last search
  bool on_gpu = false;                      // the field is `terms`, drawn by the GPU; there is no HeightField
  std::vector<Release> releases;            // GPU only; capacity kMaxReleases
  std::vector<FieldSource> terms;           // GPU only: the whole field at `time`
  FeedWriter feed_writer;                   // feeds a GPU that steps a copy of the field
  double time = 0.0;                        // [s] end of the last tick
  SurfaceWays ways;                         // Distance::kSurface only
  March march;                              // the same: working memory
  std::vector<SourceState> sources;         // a pool for probes, one per press, echoes; at most kMaxContactsPerObject
  std::uint32_t first_echo = 0;             // index into `sources`
  std::vector<PressState> presses;          // empty unless the level has a moving soft or rigid body
  std::vector<ZoneBlocks> blocks;           // per zone
  std::vector<std::uint64_t> zone_sources;  // per zone: bits of the sources that reach it this tick
  std::vector<std::uint32_t> visited;       // per zone: stamp of the last flood fill that visited it
  std::uint32_t stamp = 0;
  std::vector<std::uint32_t> dirty;    // zones whose stream has not been published since it changed
  std::vector<std::uint32_t> waiting;  // zones of the last snapshot, in case it is replaced unseen
};

struct ProbeState {
  Entity entity;
  SafetyState safety, torque_safety;
  double lever = 0.0;  // [m] farthest that a tip is from its place
  dvec3 turned{0};     // [rad] sum of the small rotations
  std::vector<Tip> tips;
  std::uint32_t first_tip = 0;  // index of its first tip in ObjectState::searched and clear
  double stiffened = 0.0;       // [J] of the world: energy that its contacts gained in this tick as stiffness changed
  double stiffened_sum = 0.0;   // [J] of the hand: the sum of what it gained so far and may get back
};

// A contact of a probe that this tick has.
struct TrackedContact {
  Entity probe, contact;  // has a Contact
};

// Calls visit(SourceState&) for what the tip of the probe touches on the object, by source, until it returns true.
template <class Object, class Visit>
bool any_source_of(Object& object, Entity probe, std::uint8_t tip, Visit visit) {
  for (const TrackedTip& at : object.tips)
    if (at.probe == probe && at.tip == tip && object.sources[at.source].tracked && visit(object.sources[at.source]))
      return true;
  return false;
}

struct TouchState {
  std::vector<ObjectState> objects;
  BoxTree object_boxes;  // world boxes of the objects over the tick, with room for curved patches
  std::vector<Bond> bonds;
  double crack = 0.0;  // [m] no crack that is ignored is wider (seams.h)
  std::vector<ProbeState> probes;
  std::vector<std::uint32_t> awake;                // objects with a tracked contact or a moving field; capacity: all
  std::uint32_t unseen = 0;                        // number of successive snapshots that were not taken
  double extent = 1.0;                             // [m] diagonal of all touchable objects
  double dt = 1e-3;                                // [s] the step that `motion` was computed for
  std::vector<MovingNode> moving;                  // every node under a prescribed motion that carries something
  std::unique_ptr<TripleBuffer<Presses>> presses;  // soft clock -> touch clock; null if nothing can press
  std::vector<LoadedContact> loaded;               // of the current object; size kMaxContactsPerObject
  std::vector<TouchEvent> events;                  // of this tick; capacity kMostEventsInATick (feed/touch_events.h)
  double pressed_at = 0.0;                         // [s] arrival of the newest presses
  std::uint64_t events_over = 0, events_lost = 0;  // of this tick, of all: `events` was full
  std::vector<TrackedContact> tracked;  // by probe, then object; of collision; some may have ended since. Capacity: all
};

}  // namespace pliant
