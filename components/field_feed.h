// The inputs of a field that the GPU steps on its copy: the loads on the surface, tick by tick, in order. For fields
// without a closed form (has_closed_form). Zones that only recover send nothing.
//
// A tick is: changed folds, sources and zones, then kTick. Values that are not sent stay unchanged. The copy starts at
// kReset, with the whole surface at rest.
#pragma once

#include <array>
#include <atomic>

#include "components/field_source.h"
#include "components/mesh.h"
#include "runtime/exchange.h"

namespace pliant {

struct FieldEvent {
  enum Kind : std::uint32_t {
    kReset,        // everything is at rest
    kFoldBefore,   // source `index` ended: its target one tick earlier
    kFoldNow,      // ... and its last target: both go into the residual of the zones that it reached in the last tick
    kSource,       // source `index` has this value from now on
    kZone,         // zone `index` is awake, and the sources in `mask` reach it from now on
    kOffsets,      // the next FieldOffsets are of zone `index` and source `mask`, for this tick
    kFoldOffsets,  // the same for a fold
    kTick,         // end of tick number `mask`
  };
  // Flags of a zone.
  static constexpr std::uint32_t kRests = 1;   // at the end of this tick its residual is set to zero
  static constexpr std::uint32_t kSleeps = 2;  // after this tick it is no longer awake

  Kind kind = kTick;
  std::uint32_t index = 0;
  std::uint64_t mask = 0;
  std::uint32_t flags = 0;
  FieldSource source;
};

// Distance::kSurface: offsets of a zone's vertices from a source (systems/touch/collide/surface_distance.h). [m]
struct FieldOffsets {
  std::array<vec3, kZoneSize> offset;
};

// One per such field. Writer: touch. Reader: visual.
struct FieldFeed {
  FieldFeed(std::size_t event_capacity, std::size_t offset_capacity)
      : events(event_capacity), offsets(offset_capacity) {}
  Ring<FieldEvent> events;
  Ring<FieldOffsets> offsets;
  std::atomic<bool> wants_reset{false};  // set by a reader that has no state yet
};

}  // namespace pliant
