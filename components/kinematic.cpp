#include "components/kinematic.h"

#include <algorithm>
#include <cmath>

#include "runtime/assert.h"

namespace pliant {
namespace {

using glm::dvec4;

constexpr double kSame = 1e-6;  // [1] relative: a motion whose end differs from its beginning by less is closed

// The keys on both sides of a time, and its position between them.
struct Span {
  std::size_t from = 0, to = 0;
  double share = 0.0;    // [1] 0..1
  double seconds = 0.0;  // [s] between them
};

Span span_at(const Track& track, double time) {
  ASSERT(!track.empty());
  const std::vector<double>& times = track.times;
  if (time <= times.front()) return {};
  const std::size_t last = times.size() - 1;
  if (time >= times.back()) return {last, last, 0.0, 0.0};
  const std::size_t to = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  const double seconds = times[to] - times[to - 1];
  return {to - 1, to, (time - times[to - 1]) / seconds, seconds};
}

dvec4 key(const Track& track, std::size_t i) {
  return track.values[track.interpolation == Interpolation::kCubicSpline ? 3 * i + 1 : i];
}

// glTF 2.0, appendix C.5: the cubic Hermite spline through v_k and v_{k+1}, with the out-tangent b_k and the in-tangent
// a_{k+1}.
dvec4 spline(const Track& track, const Span& span) {
  const double t = span.share, t2 = t * t, t3 = t2 * t, td = span.seconds;
  const dvec4 v0 = track.values[3 * span.from + 1], b0 = track.values[3 * span.from + 2];
  const dvec4 a1 = track.values[3 * span.to], v1 = track.values[3 * span.to + 1];
  return (2 * t3 - 3 * t2 + 1) * v0 + td * (t3 - 2 * t2 + t) * b0 + (-2 * t3 + 3 * t2) * v1 + td * (t3 - t2) * a1;
}

dquat unit(const dvec4& q, const dquat& otherwise) {
  const double norm = length(q);
  return norm > 0.0 && std::isfinite(norm) ? dquat(q.w, q.x, q.y, q.z) * (1.0 / norm) : otherwise;
}

// The direction of v. If v has none: the part of an axis perpendicular to `avoid`; the axis is x, or y where `avoid` is
// near x.
dvec3 direction(dvec3 v, dvec3 avoid) {
  const double l = length(v);
  if (l > 0.0 && std::isfinite(l)) return v / l;
  const dvec3 axis = std::abs(avoid.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return normalize(axis - avoid * dot(axis, avoid));
}

// A quaternion and its negative are the same rotation.
bool closed(const Track& track, bool rotation) {
  const dvec4 first = sample_vector(track, 0.0), last = sample_vector(track, track.length);
  const double size = std::max({1e-12, length(first), length(last)});
  return length(first - last) <= kSame * size || (rotation && length(first + last) <= kSame * size);
}

}  // namespace

TrackTime track_time(const Track& track, const PrescribedMotion& motion, double time) {
  const double here = time * motion.speed;
  if (!motion.repeats || !(track.length > 0.0) || here <= track.length) return {here, 0.0};
  const double laps = std::floor(here / track.length);
  return {std::clamp(here - laps * track.length, 0.0, track.length), laps};
}

glm::dvec4 sample_vector(const Track& track, double time) {
  const Span span = span_at(track, time);
  if (span.share == 0.0 || track.interpolation == Interpolation::kStep) return key(track, span.from);
  if (track.interpolation == Interpolation::kCubicSpline) return spline(track, span);
  const dvec4 a = key(track, span.from), b = key(track, span.to);
  return a + span.share * (b - a);
}

dquat sample_rotation(const Track& track, double time) {
  const Span span = span_at(track, time);
  const dquat a = unit(key(track, span.from), dquat(1, 0, 0, 0));
  if (span.share == 0.0 || track.interpolation == Interpolation::kStep) return a;
  if (track.interpolation == Interpolation::kCubicSpline) return unit(spline(track, span), a);
  return normalize(glm::slerp(a, unit(key(track, span.to), a), span.share));
}

dmat4 LocalFrame::matrix() const {
  dmat4 m = glm::mat4_cast(rotation);
  for (int i = 0; i < 3; ++i) m[i] *= scale[i];
  m[3] = dvec4(translation, 1.0);
  return m;
}

LocalFrame local_frame(const LocalTransform& rest) {
  return {dvec3(rest.translation), normalize(dquat(rest.rotation)), dvec3(rest.scale)};
}

LocalFrame sample_motion(const PrescribedMotion& motion, const LocalTransform& rest, double time) {
  LocalFrame frame = local_frame(rest);
  const auto at = [&](const Track& track) { return track_time(track, motion, time).time; };
  if (!motion.translation.empty()) frame.translation = dvec3(sample_vector(motion.translation, at(motion.translation)));
  if (!motion.rotation.empty()) frame.rotation = sample_rotation(motion.rotation, at(motion.rotation));
  if (!motion.scale.empty()) frame.scale = dvec3(sample_vector(motion.scale, at(motion.scale)));
  return frame;
}

bool jumps_between(const PrescribedMotion& motion, double before, double after) {
  const auto jumps = [&](const Track& track, bool rotation) {
    if (track.empty()) return false;
    const TrackTime from = track_time(track, motion, before), to = track_time(track, motion, after);
    if (from.laps != to.laps && !closed(track, rotation)) return true;
    return track.interpolation == Interpolation::kStep &&
           sample_vector(track, from.time) != sample_vector(track, to.time);
  };
  return jumps(motion.translation, false) || jumps(motion.rotation, true) || jumps(motion.scale, false);
}

Pose rigid_part(const dmat4& frame) {
  const dvec3 x = direction(dvec3(frame[0]), dvec3(0));
  const dvec3 along_y(frame[1]);
  const dvec3 y = direction(along_y - x * dot(x, along_y), x);
  return {dvec3(frame[3]), glm::normalize(glm::quat_cast(dmat3(x, y, cross(x, y))))};
}

}  // namespace pliant
