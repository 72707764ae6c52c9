// A level in memory: one registry, the stores of large data, and the touch tick's working memory.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "components/appearance.h"
#include "components/contact.h"
#include "components/deformable.h"
#include "components/haptic_device.h"
#include "components/height_field.h"
#include "components/kinematic.h"
#include "components/mesh.h"
#include "components/name.h"
#include "components/probe.h"
#include "components/range.h"
#include "components/snapshot.h"
#include "components/soft_snapshot.h"
#include "components/tet_mesh.h"
#include "components/transform.h"
#include "pliant/parameters.h"
#include "runtime/clock.h"
#include "runtime/exchange.h"
#include "runtime/hierarchy.h"
#include "runtime/registry.h"
#include "runtime/result.h"
#include "runtime/store.h"

namespace pliant {

// Parts that a step had to drop, as bits; each with its cure.
enum DroppedBit : std::uint32_t {  // 8 was used by an earlier bit and stays unused
  kDroppedContacts = 1,   // more contacts on one object than it has room for: use fewer probes, or split the object
  kDroppedNonFinite = 2,  // a pose or force was not a number and was replaced by zero: check device and registered laws
  kDroppedTravel = 4,     // a probe moved farther in a tick than the level is large: check the device's units
  kDroppedReleases = 32,  // more dents were recovering at once than the GPU's list can hold: the oldest vanished
  kDroppedFactor = 64,    // a body's step could not be solved and it did not move: raise `young` or `density`, or mend
                          // its mesh
  kDroppedMotion = 128,   // a body's motion was not a number and it was stopped: reduce `soft_step`
  kDroppedStale = 16,     // a device's pose was stale and its force went to zero: check its connection
  kDroppedJump = 256,  // a device jumped farther than a hand can move, and its force went to zero: check its tracking
  kDroppedInside = 2048,  // a probe began inside an object, and gets no force until it has left: move it
  kDroppedDetail = 1024,  // a texture passed faster than the touch rate resolves, and was smoothed: raise `touch_rate`
  kDroppedHoles = 4096,   // a surface was broken in more places than it remembers: the last ones close again
  kDroppedSets = 8192,    // a surface yielded in more places than it remembers: there it stays elastic
  kDroppedRim = 16384,    // a probe slipped round the rim of a part thinner than its depth, and was let go
  kDroppedGain = 32768,   // tissue with a law for large strain moved less in a step than it should: reduce `soft_step`
  kDroppedSetBack = 512,  // a tool got away from its device and was set back to it: reduce `soft_step`
};

struct MouseInput;  // systems/device/mouse.h: mouse input of a window
struct SoftState;   // systems/soft/soft_state.h: working memory of the soft step, made by prepare_soft
struct ToolTouch;   // systems/tool/tool_touch_state.h: tools on the touch clock, made by prepare_tools
struct TouchState;  // systems/touch/prepare/touch_state.h: working memory of the touch tick, made by prepare_touch

inline constexpr Range kTouchRateRange{10.0, 100000.0};  // [Hz] of Simulation::touch_rate
inline constexpr Range kSoftStepRange{1e-4, 1.0};        // [s] of Simulation::soft_step
inline constexpr Range kGravityRange{-1e3, 1e3};         // [m/s2] of each of its components

// Where height fields are stored (systems/touch/model/field.h).
enum class FieldPlace : std::uint8_t { kProcessor, kGpu };

struct World {
  World();
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  std::string name;
  Registry registry;
  Hierarchy hierarchy;
  Store<Mesh> meshes;
  Store<TetMesh> tet_meshes;
  Store<DrawMesh> draw_meshes;
  Store<HeightField> fields;
  Store<Path> paths;
  Store<PrescribedMotion> motions;
  std::vector<Material> materials;
  std::vector<Image> images;
  Environment environment;
  Simulation simulation;
  FieldPlace field_place =
      FieldPlace::kProcessor;         // kGpu: of every object whose parameters allow it; read by prepare_touch
  std::uint32_t dropped = 0;          // DroppedBit
  std::shared_ptr<TouchState> touch;  // null until prepare_touch
  std::shared_ptr<SoftState> soft;    // null in levels without soft or rigid bodies, and until prepare_soft
  std::shared_ptr<ToolTouch> tools;   // null in levels without tools, and until prepare_tools
  std::shared_ptr<MouseInput> mouse;  // null unless a window drives a probe
  std::unique_ptr<TripleBuffer<Snapshot>> snapshots;           // touch clock -> visual clock; null until prepare_touch
  std::unique_ptr<TripleBuffer<SoftSnapshot>> soft_snapshots;  // soft clock -> visual clock; null until prepare_soft
};

// The first entity with this name, or kNoEntity.
Entity find_by_name(const World& world, const std::string& name);
// One sentence per set bit of `dropped`.
std::vector<Note> explain_dropped(std::uint32_t dropped);

}  // namespace pliant
