// The mouse as a device. The visual clock samples the pointer about 60 times a second; the touch clock needs it a
// thousand times a second and must detect when samples stop.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

inline constexpr double kMouseSilence = 0.25;      // [s] time-out without a sample: no poses, so safety sends no force
inline constexpr double kMouseSlowestFrame = 0.1;  // [s] a pose that arrives later than this is reached in this time

// [m/s] Faster, a jump of the pointer would be felt as a blow. Delayed frames arrive in successive ticks, so the time
// between samples alone does not bound the speed.
inline constexpr double kMouseFastest = 0.5;

// Target of the probe under the pointer. Written by the visual clock every frame, also without motion.
struct MouseSample {
  dvec3 position{0};         // [m] world
  bool free = true;          // hovering: the probe is placed there without crossing obstacles on the way
  Entity takes = kNoEntity;  // a device taken over by the hand: its script or orbit ends
  ProbeHold hold;            // of a probe
};

// One mouse. While it presses, its probe runs straight from pose to pose, each in the time since the pose before: at
// most a frame late, where that is no faster than kMouseFastest. Ticks that are skipped are no reason to wait: the way
// began before them.
struct MouseInput {
  explicit MouseInput(dvec3 start) : from(start), position(start), to(start) {}

  TripleBuffer<MouseSample> samples;  // visual clock -> touch clock
  // Owned by the touch clock.
  bool heard = false;
  bool free = true;          // the newest pose hovers
  double heard_at = 0.0;     // [s] when the newest pose came
  double began_at = 0.0;     // [s] when the way to it began
  double lasts = 1e-3;       // [s] how long that takes
  dvec3 from, position, to;  // [m] world
};

// Passes World::mouse to every device whose driver is `mouse`. Without one, those devices keep their pose and become
// stale.
void read_mouse(World& world, Tick tick);

// Adds a mouse at `start` [m] to the world before the touch clock runs; its devices are lost until the first sample.
void add_mouse(World& world, dvec3 start);

}  // namespace pliant
