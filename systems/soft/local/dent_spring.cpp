#include "systems/soft/local/dent_spring.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/model/force_field.h"

namespace pliant {
namespace {

constexpr int kDepthSteps = 100;       // of Newton's method within a bracket
constexpr double kDepthExact = 1e-13;  // [1]
constexpr double kLeastSphere = 1e-3;  // [1] of a tip's radius: depth of Hertz' first slope, which is 0 at none
constexpr double kFirstDepth = 1e-6;   // [m] of a bracket
constexpr double kHardening = 1e-3;    // [1] of a table's mean slope, beyond its last row, and at least within
constexpr double kDeepestDent = 1e3;   // [m]: a softening law has no depth of this force

double share_of_contact(const Deformable& it) {
  return contact_radius(it, it.reach) / it.reach;
}

}  // namespace

DentSpring::DentSpring(const Deformable& it, double step)
    : deformable(it),
      motion(pliant::motion(it, step)),
      shared(share_kernel(it.shape, it.reach, it.volume, share_of_contact(it))),
      damping(it.contact_damping_material ? free_damping(it) * it.stiffness : it.contact_damping) {
  if (const ForceTable& table = it.table; table.count > 1) {
    last = table.rows[table.count - 1][0];
    hardening = kHardening * table.rows[table.count - 1][1] / last;
  }
  deformable.layers = {};  // a probe breaks through a surface, not through tissue
}

ContactLaw DentSpringAt::law() const {
  return contact_law(of->deformable, of->motion, std::max(paint, kLeastPaint), radius);
}

double DentSpringAt::decay() const {
  return step > 0.0 && of->motion.arm() ? std::exp(-step / of->motion.arm_time) : 0.0;
}

double DentSpringAt::share() const {
  return of->motion.arm() ? of->motion.arm_stiffness : 0.0;
}

double DentSpringAt::force(double depth) const {
  const double f = law().force(depth) + paint * of->hardening * std::max(0.0, depth - of->last),
               rate = step > 0.0 ? of->damping * (depth - dented) / step : 0.0;
  return f + share() * decay() * (f - relaxed) + rate;
}

double DentSpringAt::slope(double depth) const {
  ContactLaw it = law();
  it.arm = 0.0;
  const double least = radius > 0.0 ? kLeastSphere * radius : 0.0;
  return (1 + share() * decay()) * std::max(it.slope(std::max(depth, least)), paint * of->hardening) +
         (step > 0.0 ? of->damping / step : 0.0);
}

double DentSpringAt::depth(double wanted) const {
  double low = 0.0, high = std::max(kFirstDepth, dented);
  if (force(low) >= wanted) return 0.0;
  while (force(high) < wanted && high < kDeepestDent) low = high, high *= 2;
  double at = high;
  for (int i = 0; i < kDepthSteps && high - low > kDepthExact * high; ++i) {
    const double over = force(at) - wanted;
    (over > 0.0 ? high : low) = at;
    const double next = at - over / slope(at);
    if (std::abs(next - at) <= kDepthExact * at) return next;
    at = next > low && next < high ? next : 0.5 * (low + high);
  }
  return at;
}

double DentSpringAt::first_compliance() const {
  return 1 / (of->deformable.stiffness * std::max(paint, kLeastPaint));
}

double DentSpringAt::secant_compliance() const {
  const double f = dented > 0.0 ? law().force(dented) : 0.0;
  return f > 0.0 ? dented / f : first_compliance();
}

double DentSpringAt::relaxed_after(double depth) const {
  return relaxed + (1 - decay()) * (law().force(depth) - relaxed);
}

}  // namespace pliant
