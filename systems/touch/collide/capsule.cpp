#include "systems/touch/collide/capsule.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/collide/contact_place.h"
#include "systems/touch/collide/over_seams.h"

namespace pliant {
namespace {

constexpr int kCapsuleSteps = 24;
constexpr double kExactly = 1e-10;  // [1] of the axis
constexpr int kMostClimbs = 4;

// A bent axis.
struct Axis {
  TipPlace tip;
  double bend;  // [m]

  Axis(const TipPlace& place, double radius)
      : tip(place), bend(std::max(kBend * radius, kLeastBend * length(place.axis))) {}
  double same_dent(double radius) const { return std::max(kSameDent * radius, 4 * bend); }
  double raised(double along) const { return 4 * bend * (along - 0.5) * (along - 0.5); }
};

// One sphere of a capsule.
struct AxisSphere {
  Foot foot;
  FootBlend place;
  double along = 0.0;
  double slope = 0.0, curvature = 0.0;  // [m] of the height by `along`
  bool on_surface = true;               // not behind the rim of an open surface
};

AxisSphere sphere_at(const ContactSearch& s, const Axis& axis, const Foot& at, double along) {
  const dvec3 x = axis.tip.at(along);
  const Foot foot = foot_over_seam(s, at, x);
  AxisSphere out{foot, contact_place(s.object, s.mesh, foot, x), along};
  out.slope = dot(out.place.gradient, axis.tip.axis) + 8 * axis.bend * (along - 0.5);
  out.curvature = dot(axis.tip.axis, out.place.turns * axis.tip.axis) + 8 * axis.bend;
  out.on_surface = foot.height >= 0 || (!beyond_border(s.mesh, foot, x) && !past_seam(s, foot, x));
  return out;
}

AxisSphere sphere_at(const ContactSearch& s, const Axis& axis, const AxisSphere& from, double along) {
  return sphere_at(s, axis, follow_foot(s, from.foot, axis.tip.at(from.along), axis.tip.at(along)), along);
}

// A zero of the slope between 0 and 1 where it rises, or an end. Newton's method within a bracket. The first steps are
// short: they follow one minimum.
AxisSphere lowest(const ContactSearch& s, const Axis& axis, AxisSphere at) {
  double farthest = std::min(0.25, std::max(1e-3, static_cast<double>(s.mesh.mean_edge) / length(axis.tip.axis)));
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kCapsuleSteps; ++i) {
    const bool back = at.slope > 0;
    (back ? high : low) = at.along;
    double way = back ? -farthest : farthest;
    if (at.curvature > 0) way = std::clamp(-at.slope / at.curvature, -farthest, farthest);
    if (std::abs(way) == farthest) farthest = std::min(0.25, 2 * farthest);
    double to = std::clamp(at.along + way, low, high);
    if (to == (back ? low : high) && to != 0.0 && to != 1.0) to = 0.5 * (low + high);
    if (!(std::abs(to - at.along) > kExactly)) break;
    AxisSphere next = sphere_at(s, axis, at, to);
    if (!next.on_surface) {  // the surface ends at its rim
      (back ? low : high) = to;
      if (high - low < kExactly) break;
      next = sphere_at(s, axis, at, 0.5 * (at.along + to));
      if (!next.on_surface) continue;
    }
    at = next;
  }
  return at;
}

// A deeper sphere than `at` on the same dent: up to where a ridge is kSameDent lower. Of the spheres half a radius
// apart, and then downhill. The contact is at the deepest one as soon as that is deeper, so that its energy depends on
// the pose alone.
bool climb(const ContactSearch& s, const Axis& axis, double radius, AxisSphere& at) {
  constexpr double kMostSpheres = 64;
  const double size = length(axis.tip.axis), edge = static_cast<double>(s.mesh.mean_edge),
               step = std::max(0.5 * (radius > 0 ? radius : edge) / size, 1 / kMostSpheres),
               same = axis.same_dent(radius), begun = at.foot.height + axis.raised(at.along);
  Foot found = at.foot;
  double lowest_height = begun, along = at.along;
  for (const double way : {-step, step}) {
    Foot foot = at.foot;
    for (double from = at.along; from != (way < 0 ? 0.0 : 1.0);) {
      const double to = std::clamp(from + way, 0.0, 1.0);
      const dvec3 x = axis.tip.at(to);
      foot = foot_over_seam(s, follow_foot(s, foot, axis.tip.at(from), x), x);
      from = to;
      const double height = foot.height + axis.raised(to);
      if (height > begun + same || (foot.height < 0 && (beyond_border(s.mesh, foot, x) || past_seam(s, foot, x))))
        break;
      if (height < lowest_height) {
        lowest_height = height;
        found = foot;
        along = to;
      }
    }
  }
  if (along == at.along) return false;
  const AxisSphere other = lowest(s, axis, sphere_at(s, axis, found, along));
  const auto height = [&](const AxisSphere& sphere) { return sphere.place.height + axis.raised(sphere.along); };
  if (!(height(other) < height(at) - kExactly * size)) return false;
  at = other;
  return true;
}

}  // namespace

TipContact deepest_on_tip(const ContactSearch& s, const TipPlace& tip, double radius, Foot foot, double along,
                          const FootBlend* before) {
  if (tip.axis == dvec3(0)) return {contact_place(s.object, s.mesh, foot, tip.end, before), {}, tip.end};
  const Axis axis(tip, radius);
  AxisSphere at = lowest(s, axis, sphere_at(s, axis, foot, along));
  for (int i = 0; i < kMostClimbs && climb(s, axis, radius, at);) ++i;
  TipContact out{at.place, {at.along, 0.0, tip.axis}, tip.at(at.along), axis.raised(at.along)};
  if (at.along > 0 && at.along < 1 && at.curvature > 0) {
    out.axis.curvature = at.curvature;
    out.axis.shift = -(glm::transpose(at.place.turns) * tip.axis) / at.curvature;
  }
  return out;
}

Ridge ridge_along(const ContactSearch& s, const SourceState& a, const SourceState& b) {
  constexpr double kNear = 1e-7;  // [1] of the axis
  const double radius = a.tip.radius, sense = b.axis.along > a.axis.along ? 1.0 : -1.0;
  const Axis axis({a.x - a.axis.along * a.axis.axis, a.axis.axis}, radius);
  AxisSphere from = sphere_at(s, axis, a.place.main(), a.axis.along),
             to = sphere_at(s, axis, b.place.main(), b.axis.along);
  // Where the height stops rising on the way: from either end, as long as it rises.
  for (int i = 0; i < kCapsuleSteps && std::abs(to.along - from.along) > kNear; ++i) {
    const double middle = 0.5 * (from.along + to.along);
    AxisSphere next = sphere_at(s, axis, from, middle);
    if (sense * next.slope > 0)
      from = next;
    else
      to = sphere_at(s, axis, to, middle);
  }
  const double raised = axis.raised(from.along), same = 1e-3 * static_cast<double>(s.mesh.mean_edge);
  const dvec3 x = axis.tip.at(from.along);
  Ridge ridge;
  if (length(from.foot.p - to.foot.p) < same + std::abs(to.along - from.along) * length(axis.tip.axis)) {
    ridge = {radius - from.place.height - raised, -from.place.gradient, x};
  } else if (radius > 0.0) {
    ridge = ridge_between(s.mesh, from.place, to.place, x, radius);
    ridge.depth -= raised;
  } else {
    return {};
  }
  ridge.depth += axis.same_dent(radius);
  const auto depth = [&](const SourceState& source) {
    return radius - source.place.height - axis.raised(source.axis.along);
  };
  const SourceState& shallower = depth(a) < depth(b) ? a : b;
  if (ridge.depth >= depth(shallower)) return {depth(shallower), -shallower.place.gradient, shallower.x};
  return ridge;
}

}  // namespace pliant
