// The mouse as a device: the visual clock says where the pointing hand is, some 60 times a second; the touch clock
// needs it a thousand times a second and must notice when nobody speaks any more.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

inline constexpr double kMouseSilence = 0.25;      // [s] unheard for so long: no more poses, so safety sends no force
inline constexpr double kMouseSlowestFrame = 0.1;  // [s] a pose that came later than this is reached as if it had not

// [m/s] Faster, and a jump of the pointer is felt as a blow. Pictures that were held up come in ticks that follow each
// other, so that no way may be as short in time as what lies between them.
inline constexpr double kMouseFastest = 0.5;

// Where the pointing hand wants the probe. Written by the visual clock every frame, also when nothing moved.
struct MouseSample {
  dvec3 position{0};         // [m] world
  bool free = true;          // it hovers: it is put there, and does not travel through whatever lies on the way
  Entity takes = kNoEntity;  // a device that the hand has taken hold of: script or orbit lead it no longer
  ProbeHold hold;            // of a probe
};

// One mouse. While it presses, its probe runs straight from pose to pose, each in the time since the pose before: at
// most a frame late, where that is no faster than kMouseFastest. After a stall that safety eases in from, the way
// began before it.
struct MouseInput {
  explicit MouseInput(dvec3 start) : from(start), position(start), to(start) {}

  TripleBuffer<MouseSample> samples;  // visual clock -> touch clock
  // Touch clock's.
  bool heard = false;
  bool free = true;          // the newest pose hovers
  double heard_at = 0.0;     // [s] when the newest pose came
  double began_at = 0.0;     // [s] when the way to it began
  double lasts = 1e-3;       // [s] how long that takes
  dvec3 from, position, to;  // [m] world
};

// Gives World::mouse to every device whose driver is `mouse`. Without one, those devices keep still and grow stale.
void read_mouse(World& world, Tick tick);

// Puts a mouse at `start` [m] into the world before the touch clock runs; its devices are lost until it is first heard.
void add_mouse(World& world, dvec3 start);

}  // namespace pliant
