#include "systems/touch/model/damage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/touch/feed/touch_events.h"
#include "systems/touch/model/dent.h"
#include "systems/touch/model/friction.h"
#include "systems/touch/model/stored_contact.h"

namespace pliant {
namespace {

constexpr double kSamePlace = 0.07;  // [1] of the reach: nearer presses deepen the same dent
constexpr double kAgain = 0.5;       // [1] of the yield force: below it the next yielding is another event

void tell(const ContactSearch& search, const Pressing& pressing, FeltKind kind, std::int32_t index, double force) {
  const Pose& pose = search.world.registry.get<Pose>(search.object.entity);
  add_event(*search.world.touch, {kind, index, search.tick.index, search.tick.time, pressing.contact->probe,
                                  search.object.entity, pose.to_world(pressing.source->place.p), force});
}

void remember_hole(const ContactSearch& search, dvec3 p, double radius, std::uint32_t broken) {
  for (Hole& hole : search.object.holes)
    if (hole.radius >= radius && length(hole.p - p) <= hole.radius) {
      hole.broken = std::max(hole.broken, broken);
      return;
    }
  if (search.object.holes.size() < kMostHoles)
    search.object.holes.push_back({p, radius, broken});
  else
    search.world.dropped |= kDroppedHoles;
}

// Stores the contact anew; one that stores nothing bears no load.
void store_again(const ContactSearch& search, const Deformable& deformable, Pressing& pressing, LoadedContact& loaded) {
  if (store(search, deformable, pressing, loaded)) return;
  loaded.energy = loaded.load = 0.0;
  loaded.pull = dvec3(0);
}

bool breaks(const ContactSearch& search, const Deformable& deformable, Pressing& pressing, LoadedContact& loaded) {
  ContactDamage& damage = pressing.contact->damage;
  const ContactLaw& law = pressing.law;
  if (damage.broken >= law.layers.size()) return false;
  const Layer& layer = law.layers[damage.broken];
  const double depth = pressing.raised.height - pressing.contact->height;
  const double force =
      loaded.share * (law.layer_force(damage.broken, depth) - law.layer_force(damage.broken, law.free_depth));
  const double energy = loaded.share * law.layer_energy(damage.broken, depth);
  if (!(layer.force > 0 && force >= layer.force) && !(layer.energy > 0 && energy >= layer.energy)) return false;
  tell(search, pressing, FeltKind::kBroke, static_cast<std::int32_t>(damage.broken),
       loaded.share * pressing.stored.force);
  damage.relaxes = damage.relaxes || damage.broken == 0;
  ++damage.broken;
  remember_hole(search, pressing.source->place.p, std::max(deformable.hole_radius, pressing.source->tip.radius),
                damage.broken);
  store_again(search, deformable, pressing, loaded);
  return true;
}

// phi(|p - p_j|) max(0, n.n_j) of a dent of depth 1, and its derivatives by p and n.
struct DentAt {
  double value;    // [1]
  dvec3 by_place;  // [1/m]
  dvec3 by_normal;
};
DentAt dent_at(const ShareKernel& kernel, const SetDent& dent, dvec3 p, dvec3 n) {
  const dvec3 d = p - dent.p;
  const double r2 = dot(d, d), facing = dot(n, dent.normal);
  if (!(facing > 0) || r2 >= kernel.outer * kernel.outer) return {0.0, dvec3(0), dvec3(0)};
  const double phi = kernel.at(r2);
  return {phi * facing, facing * kernel.slope(r2) * d, phi * dent.normal};
}

// Dents that overlap make a groove, not a deeper dent: s = (sum v_j^p)^(1/p), p = 16, v_j of one dent.
double to_the_16th(double v) {
  v *= v, v *= v, v *= v;
  return v * v;
}
double root_16th(double v) {
  return std::sqrt(std::sqrt(std::sqrt(std::sqrt(v))));
}

// The deepest one is drawn, which needs no sum per vertex: at most a few percent of the depth less.
void draw_set(const ContactSearch& search, const SourceState& source, const SetDent& dent) {
  const Mesh& mesh = search.mesh;
  ObjectState& object = search.object;
  HeightField& field = search.world.fields[search.world.registry.get<Deformable>(object.entity).field];
  const uvec3 corner = mesh.triangles[source.place.main().triangle];
  const std::array<std::uint32_t, 3> own{corner.x / kZoneSize, corner.y / kZoneSize, corner.z / kZoneSize};
  flood(mesh, vec3(dent.p), object.kernel.outer, own, object, object.set_zones);
  for (const std::uint32_t zone : object.set_zones) {
    wake(field, zone, kZoneResidual);
    for (std::uint32_t v = mesh.zone_begin(zone); v < mesh.zone_end(zone); ++v) {
      const dvec3 n(mesh.normal(v));
      const DentAt at = dent_at(object.kernel, dent, dvec3(mesh.position(v)), n);
      if (!(dent.depth * at.value > -static_cast<double>(field.set[v].w))) continue;
      const dvec3 slope = at.by_place - dot(at.by_place, n) * n;  // the normal turns by -grad h, h = -depth phi
      field.set[v] = vec4(vec3(dent.depth * slope), static_cast<float>(-dent.depth * at.value));
    }
  }
}

// Makes the set at the foot `depth` deep. False: the list is full.
bool deepen(const ContactSearch& search, const Deformable& deformable, const SourceState& source, double depth) {
  ObjectState& object = search.object;
  const dvec3 p = source.place.p, n = source.place.normal;
  SetDent* nearest = nullptr;
  double least = kSamePlace * deformable.reach;
  for (SetDent& dent : object.sets) {
    const double far = length(dent.p - p);
    if (far > least || dot(dent.normal, n) < 0.9) continue;
    least = far;
    nearest = &dent;
  }
  if (!nearest) {
    if (object.sets.size() == kMostSets) return false;
    object.sets.push_back({p, n, 0.0});
    nearest = &object.sets.back();
  }
  double others = 0.0;
  for (const SetDent& dent : object.sets)
    if (&dent != nearest) others += to_the_16th(dent.depth * dent_at(object.kernel, dent, p, n).value);
  nearest->depth = root_16th(std::max(0.0, to_the_16th(depth) - others)) / dent_at(object.kernel, *nearest, p, n).value;
  draw_set(search, source, *nearest);
  return true;
}

bool yields(const ContactSearch& search, const Deformable& deformable, Pressing& pressing, LoadedContact& loaded) {
  ContactDamage& damage = pressing.contact->damage;
  const Raised before = set_under(search.object, pressing.source->place, pressing.source->axis);
  const double limit = deformable.yield_force - deformable.yield_hardening * before.height;
  const double force = loaded.share * pressing.stored.force;
  if (force < kAgain * limit) damage.yields = false;
  if (!(force > limit * (1 + 1e-9))) return false;
  // Return mapping: the set s for which the elastic force of the depth that is left is the yield force.
  const double depth = pressing.raised.height - pressing.contact->height;
  double low = 0.0, high = depth;
  for (int i = 0; i < 60 && high - low > 1e-14 * depth; ++i) {
    const double middle = 0.5 * (low + high);
    const double left = loaded.share * pressing.law.stored(depth - middle).force;
    (left > limit + deformable.yield_hardening * middle ? low : high) = middle;
  }
  if (!deepen(search, deformable, *pressing.source, high - before.height)) {
    search.world.dropped |= kDroppedSets;
    return false;
  }
  if (!damage.yields) tell(search, pressing, FeltKind::kYielded, 0, limit);
  damage.yields = true;
  const Raised after = set_under(search.object, pressing.source->place, pressing.source->axis);
  pressing.raised.height += after.height - before.height;
  pressing.raised.gradient += after.gradient - before.gradient;
  pressing.gradient -= after.gradient - before.gradient;
  store_again(search, deformable, pressing, loaded);
  return true;
}

}  // namespace

void find_hole(const ObjectState& object, const SourceState& source, Contact& contact) {
  ContactDamage& damage = contact.damage;
  for (const Hole& hole : object.holes) {
    if (hole.broken <= damage.broken || source.tip.radius > hole.radius ||
        length(hole.p - source.place.p) > hole.radius)
      continue;
    damage.relaxes = damage.relaxes || damage.broken == 0;
    damage.broken = hole.broken;
  }
}

Raised set_under(const ObjectState& object, const FootBlend& place, const AxisPlace& axis) {
  double sum = 0.0;
  dvec3 by_place(0), by_normal(0);  // of the sum, over p
  for (const SetDent& dent : object.sets) {
    const DentAt at = dent_at(object.kernel, dent, place.p, place.normal);
    if (!(at.value > 0.0) || !(dent.depth > 0.0)) continue;
    const double power = to_the_16th(dent.depth * at.value);
    sum += power;
    by_place += power / at.value * at.by_place;
    by_normal += power / at.value * at.by_normal;
  }
  Raised out;
  if (!(sum > 0.0)) return out;
  const double depth = root_16th(sum), scale = depth / sum;
  out.height = -depth;
  out.gradient = -scale * (glm::transpose(with_axis(place.moves, axis)) * by_place +
                           glm::transpose(with_axis(place.turns, axis)) * by_normal);
  return out;
}

bool give_way(const ContactSearch& search, const Deformable& deformable, Pressing& pressing, LoadedContact& loaded) {
  if (!(loaded.share > 0)) return false;
  if (!deformable.layers.empty()) return breaks(search, deformable, pressing, loaded);
  return deformable.yield_force > 0 && yields(search, deformable, pressing, loaded);
}

dvec3 grip(const Deformable& deformable, const FootBlend& place, Contact& contact, double dt) {
  double limit = 0.0, top = 0.0;
  for (std::size_t i = 0; i < contact.damage.broken && i < deformable.layers.size(); ++i) {
    const Layer& layer = deformable.layers[i];
    limit += layer.grip * std::clamp(-contact.height - top, 0.0, layer.thickness);
    top += layer.thickness;
  }
  const double along = length(place.gradient);
  if (!(limit > 0) || !(along > 0)) {
    contact.damage.grip = 0.0;
    contact.damage.slides = false;
    return dvec3(0);
  }
  double stiffest = 0.0;
  for (const Layer& layer : deformable.layers) stiffest = std::max(stiffest, layer.stiffness);
  const double K = kBristleStiffness * stiffest, B = K * kBristleDampingTime;
  const double rate = (contact.height - contact.previous_height) / dt;
  Bristle bristle{dvec3(contact.damage.grip, 0, 0), contact.damage.slides};
  const double force = step_bristle(bristle, dvec3(rate, 0, 0), K, B, limit, limit, dt).x;
  contact.damage.grip = bristle.deflection.x;
  contact.damage.slides = bristle.sliding;
  contact.stiffness += bristle.sliding ? 0.0 : K;
  contact.damping += bristle.sliding ? 0.0 : B;
  return -force / along * place.gradient;
}

}  // namespace pliant
