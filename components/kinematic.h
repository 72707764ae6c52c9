// Nodes whose motion is prescribed: by an animation of the level's file or by a script. Such a node moves itself and
// all that hangs below it, whatever pushes against it: a kinematic body.
#pragma once

#include <cstdint>
#include <vector>

#include "components/math.h"
#include "components/transform.h"
#include "runtime/store.h"

namespace pliant {

// Between two keys, as glTF 2.0 (appendix C) has it.
enum class Interpolation : std::uint8_t { kLinear, kStep, kCubicSpline };

// One property of a node over time. Rotations are quaternions x, y, z, w; translations and scales leave w at 0.
struct Track {
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<double> times;       // [s] ascending, from 0 on; empty: the property does not move
  std::vector<glm::dvec4> values;  // one a key; kCubicSpline: in-tangent [1/s], value and out-tangent of each key
  double length = 0.0;             // [s] after which a motion that repeats starts over; at least the last time
  bool empty() const { return times.empty(); }
};

// A node's local transform over time: relative to its parent, like LocalTransform. In World::motions.
struct PrescribedMotion {
  Track translation;    // [m]
  Track rotation;       // slerp between keys that are linear
  Track scale;          // [1] empty above and at what can be touched: scale is baked into its mesh
  bool repeats = true;  // else the last key holds
  double speed = 1.0;   // [1] of the motion's own clock against simulated time, >= 0
};

// On a node that moves by itself. Rate: never changes. Writer: content at spawn.
struct Kinematic {
  Handle<PrescribedMotion> motion;
};

// The time on the track's own clock at `time` seconds after the start, and how often it has started over until then.
struct TrackTime {
  double time = 0.0;  // [s] 0..length where it repeats
  double laps = 0.0;  // [1] whole ones
};
TrackTime track_time(const Track& track, const PrescribedMotion& motion, double time);

// The value at `time` [s] of the track's own clock: before the first key the first, after the last the last. Not
// normalised. The track has a key.
glm::dvec4 sample_vector(const Track& track, double time);
// The same for rotations: slerp along the shorter arc, splines on the components; a unit quaternion.
dquat sample_rotation(const Track& track, double time);

// The node's local transform at `time` [s]; what does not move is as `rest` says.
struct LocalFrame {
  dvec3 translation{0};  // [m]
  dquat rotation{1, 0, 0, 0};
  dvec3 scale{1};  // [1]
  dmat4 matrix() const;
};
LocalFrame local_frame(const LocalTransform& rest);
LocalFrame sample_motion(const PrescribedMotion& motion, const LocalTransform& rest, double time);

// Whether a motion jumps between two times: a lap ended and the motion does not end as it begins, or it goes in steps
// and came to another. What jumps has no velocity: it is placed anew.
bool jumps_between(const PrescribedMotion& motion, double before, double after);

// The rigid part of an affine frame, by Gram-Schmidt on its columns: exact where there is only rotation and scale;
// shear, mirroring and a scale of zero stay in what is left, Pose^-1 * frame.
Pose rigid_part(const dmat4& frame);

}  // namespace pliant
