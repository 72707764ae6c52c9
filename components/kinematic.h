// Nodes with prescribed motion: by an animation of the level's file or by a script. Such a node is a kinematic body: it
// moves itself and all its descendants, independent of any force.
#pragma once

#include <cstdint>
#include <vector>

#include "components/math.h"
#include "components/transform.h"
#include "runtime/store.h"

namespace pliant {

// Interpolation between two keys, as defined by glTF 2.0 (appendix C).
enum class Interpolation : std::uint8_t { kLinear, kStep, kCubicSpline };

// One property of a node over time. Rotations are quaternions x, y, z, w; translations and scales leave w at 0.
struct Track {
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<double> times;       // [s] ascending, from 0 on; empty: the property does not move
  std::vector<glm::dvec4> values;  // one per key; kCubicSpline: in-tangent [1/s], value and out-tangent of each key
  double length = 0.0;             // [s] after which a repeating motion starts over; at least the last time
  bool empty() const { return times.empty(); }
};

// A node's local transform over time: relative to its parent, like LocalTransform. In World::motions.
struct PrescribedMotion {
  Track translation;    // [m]
  Track rotation;       // slerp between linear keys
  Track scale;          // [1] empty on touchable nodes and their ancestors: their scale is baked into the mesh
  bool repeats = true;  // else the last key is kept
  double speed = 1.0;   // [1] of the motion's own clock against simulated time, >= 0
};

// On a kinematic node. Rate: never changes. Writer: content at spawn.
struct Kinematic {
  Handle<PrescribedMotion> motion;
};

// The time on the track's clock at `time` seconds after the start, and the number of completed laps.
struct TrackTime {
  double time = 0.0;  // [s] 0..length if it repeats
  double laps = 0.0;  // [1] a whole number
};
TrackTime track_time(const Track& track, const PrescribedMotion& motion, double time);

// The value at `time` [s] of the track's clock, clamped to the first and last key. Not normalised. The track has a key.
glm::dvec4 sample_vector(const Track& track, double time);
// The same for rotations: slerp along the shorter arc, splines on the components; a unit quaternion.
dquat sample_rotation(const Track& track, double time);

// The node's local transform at `time` [s]; properties without a track are those of `rest`.
struct LocalFrame {
  dvec3 translation{0};  // [m]
  dquat rotation{1, 0, 0, 0};
  dvec3 scale{1};  // [1]
  dmat4 matrix() const;
};
LocalFrame local_frame(const LocalTransform& rest);
LocalFrame sample_motion(const PrescribedMotion& motion, const LocalTransform& rest, double time);

// Whether a motion jumps between two times: either a lap ended and the motion is not closed, or it is a step track that
// reached another key. A jump has no velocity: the object is placed anew.
bool jumps_between(const PrescribedMotion& motion, double before, double after);

// The rigid part of an affine frame, by Gram-Schmidt on its columns. Exact for rotation and scale; shear, mirroring and
// a scale of zero remain in the rest, Pose^-1 * frame.
Pose rigid_part(const dmat4& frame);

}  // namespace pliant
