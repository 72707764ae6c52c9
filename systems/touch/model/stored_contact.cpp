#include "systems/touch/model/stored_contact.h"

#include <algorithm>

#include "systems/touch/model/field_kernels.h"
#include "systems/touch/model/smooth_paint.h"

namespace pliant {
namespace {

// A shallower contact stores no energy: its share would divide by it. [1] of the reach
constexpr double kLeastDepth = 1e-9;

// [1] Of a table's plateau, whose memory has no slope.
constexpr double kLeastSlope = 1e-3;

// q, the relaxed depth of the tissue at a place (as the law's force, contact_law.h), and its slope. The slope is that
// of the dent, which the field stores with every height (its normal correction is -dh/dx). The slope of the
// interpolated heights would be as jagged as the mesh.
Painted relaxed_depth(const FootBlend& place, const Mesh& mesh, const Motion& motion, const HeightField& field) {
  const RestoringLaw& law = motion.law;
  Painted sum{0.0, dvec3(0)};
  for (std::uint32_t f = 0; f < place.count; ++f) {
    const Foot& foot = place.foot[f];
    double depth = 0.0;
    dvec3 slope(0);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh.triangles[foot.triangle][i];
      const float r1 = arm_stiffness(motion, mesh, v);
      // Under the targets, plus the part taken over by the residual: its arm is r1 (force - z).
      const vec4 z = field.relaxed[v] + (r1 > 0 ? law.strained(field.residual[v]) - field.arm[v] / r1 : vec4(0));
      // Between vertices as a height, which is smoother than the force of a law that stiffens.
      const double h = law.height_of(static_cast<double>(z.w));
      depth -= foot.barycentric[i] * h;
      slope += foot.barycentric[i] / std::max(law.slope(h), kLeastSlope) * dvec3(z);
    }
    sum.value += place.weight[f] * depth;
    sum.gradient += place.weight[f] * (glm::transpose(foot.moves) * slope) + depth * place.weight_slope[f];
  }
  return {-law.force(-sum.value), law.slope(-sum.value) * sum.gradient};
}

// Of a surface that varies: with last tick's stiffness; k3 of the cubic law and the arm stay.
double energy_before(const ObjectState& object, const Deformable& deformable, const ContactLaw& law, double depth,
                     double energy) {
  if (object.stiffness_before == 0.0 || object.stiffness_before == deformable.stiffness) return energy;
  const double share = object.stiffness_before / deformable.stiffness;
  ContactLaw before = law;
  RestoringLaw curve = *law.law;
  curve.cubic /= share;
  before.law = &curve;
  before.stiffness *= share;
  before.unlayered *= share;
  before.arm /= share;
  return before.stored(depth).energy;
}

}  // namespace

void advance_free_surface(Contact& contact, const FootBlend& place, const Mesh& mesh, const Motion& motion) {
  if (contact.free_height == 0.0 && contact.free_velocity == 0.0) return;
  const HeightState y =
      step_free(motion, painted(place, mesh, mesh.stiffness_factor).value,
                painted(place, mesh, mesh.damping_factor).value, {contact.free_height, contact.free_velocity});
  contact.free_height = y.height < -1e-12 ? y.height : 0.0;
  contact.free_velocity = contact.free_height < 0 ? y.velocity : 0.0;
}

bool store(const ContactSearch& search, const Deformable& deformable, Pressing& pressing, LoadedContact& out) {
  const ObjectState& object = search.object;
  const Mesh& mesh = search.mesh;
  const HeightField& field = search.field;
  const FootBlend& place = pressing.source->place;
  const Contact& contact = *pressing.contact;
  const double depth = pressing.raised.height - contact.height;
  const bool flush = !object.flush_stiffness.empty() && !object.neighbours.empty();
  pressing.stiffness = smooth_painted(place, mesh, flush ? object.flush_stiffness : object.felt_stiffness);
  ContactLaw law = contact_law(deformable, object.motion, pressing.stiffness.value, pressing.source->tip.radius);
  law.free_depth = std::max(-contact.free_height, contact.unpushed);
  law.broken = contact.damage.broken;
  Painted relaxed{0.0, dvec3(0)}, relaxation;
  if (!field.arm.empty() && law.arm > 0) {
    relaxation = smooth_painted(place, mesh, object.felt_relaxation);
    law.arm *= relaxation.value;
    relaxed = relaxed_depth(place, mesh, object.motion, field);
    if (relaxed.value < 0) relaxed = {0.0, dvec3(0)};  // no tensile force
    law.relaxed = relaxed.value;
  }
  pressing.law = law;
  pressing.stored = law.stored(depth);
  pressing.slope = law.slope(depth);
  pressing.energy_before = energy_before(object, deformable, law, depth, pressing.stored.energy);
  const double least = kLeastDepth * deformable.reach;
  if (!(pressing.stored.energy > 0.5 * law.stiffness * least * least)) return false;
  out.energy = pressing.stored.energy;
  // W is proportional to the painted stiffness; its dependence on q adds q's slope, that of the arm's own paint its
  // slope.
  const AxisPlace& axis = pressing.source->axis;
  const dvec3 painted =
      (pressing.stored.energy / std::max(pressing.stiffness.value, 1e-12)) * pressing.stiffness.gradient +
      pressing.stored.by_relaxed * relaxed.gradient +
      pressing.stored.by_arm * (law.arm / std::max(relaxation.value, 1e-12)) * relaxation.gradient;
  out.pull = pressing.stored.force * pressing.gradient - with_axis(painted, axis);
  out.p = place.p;
  out.normal = place.normal;
  out.moves = with_axis(place.moves, axis);
  out.turns = with_axis(place.turns, axis);
  out.load = contact.load;
  return true;
}

}  // namespace pliant
