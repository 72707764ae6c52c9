// The force on every probe: minus the gradient of one stored energy per object (contact_energy.h), a rate term, and
// bristle friction across the normal. Both dissipative terms only remove energy: neither exceeds the pressing force.
// write_devices computes the force sent to the hand.
#include "systems/touch/model/friction_feedback.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "systems/touch/collide/collision.h"
#include "systems/touch/model/damage.h"
#include "systems/touch/model/friction.h"
#include "systems/touch/model/relief.h"
#include "systems/touch/model/shared_dents.h"
#include "systems/touch/model/stored_contact.h"
#include "systems/touch/model/texture.h"

namespace pliant {
namespace {

// Velocity of a contact's tip on the surface, object frame. [m/s]
dvec3 velocity_on(const Registry& registry, const Pose& pose, const Contact& contact, const SourceState& source,
                  Tick tick) {
  const Probe& probe = registry.get<Probe>(contact.probe);
  const dvec3 at = tip_place(probe, source.tip).at(source.axis.along),
              before = tip_place_before(probe, source.tip).at(source.axis.along);
  const dvec3 moving = (at - before) / tick.elapsed() - surface_velocity(registry, contact.object, at);
  return glm::conjugate(pose.rotation) * moving;
}

// Height of roughness and drawn relief at a contact, without what passes too fast to be felt.
Raised raise(World& world, const ObjectState& object, const Deformable& deformable, const Mesh& mesh,
             const Pressing& pressing, Tick tick) {
  const FootBlend& place = pressing.source->place;
  const dvec3 v = pressing.velocity, n = pressing.contact->normal;
  double& finest = pressing.contact->effects.finest;
  finest = finest_felt(finest, length(v - dot(v, n) * n), tick.elapsed());
  Raised out;
  if (const Texture& texture = object.texture; texture.count > 0) {
    const double share = detail_share(texture.wavelength, finest);
    const double rides = riding_share(deformable.texture_amplitude * std::numbers::sqrt2, texture.wavelength,
                                      pressing.source->tip.radius);
    const Raised wave = texture.at(place.p, share);
    out.height += rides * wave.height;
    out.gradient += rides * (glm::transpose(with_axis(place.moves, pressing.source->axis)) * wave.gradient);
    if (share < 1) world.dropped |= kDroppedDetail;
  }
  if (mesh.relief && deformable.relief > 0) {
    const FeltRelief felt = felt_relief(*mesh.relief, place, finest);
    out.height += deformable.relief * felt.height;
    out.gradient += deformable.relief * with_axis(felt.gradient, pressing.source->axis);
    if (felt.faded) world.dropped |= kDroppedDetail;
  }
  return out;
}

// A knock: a decaying sinusoid along the normal that an impact starts. Its amplitude is in proportion to the speed of
// the impact (Okamura, Cutkosky & Dennerlein 2001). It gives back no more than the hand has put into it, as seen one
// tick later. Returns it outwards, `normal` [N] what it is added to; `inward` [m/s].
double knock(ContactEffects& now, const Deformable& deformable, double inward, double normal, double dt) {
  now.knock_account += now.knock_force * inward * dt;
  const double left = now.knock * std::exp(-deformable.transient_decay * now.knock_time);
  if (!now.pressed && deformable.transient_amplitude * inward > left &&
      deformable.transient_frequency * dt <= kMostKnock) {
    now.knock = deformable.transient_amplitude * inward;
    now.knock_time = 0.0;
  } else if (left < 1e-6) {  // [N]
    now.knock = 0.0;
  }
  now.knock_force = 0.0;
  if (now.knock == 0.0) return 0.0;
  now.knock_time += dt;
  const double t = now.knock_time;
  double force = now.knock * std::exp(-deformable.transient_decay * t) *
                 std::sin(2 * std::numbers::pi * deformable.transient_frequency * t);
  const double gives = -force * inward * dt;
  if (gives > now.knock_account) force *= std::max(0.0, now.knock_account / gives);
  now.knock_force = std::max(-normal, force);
  return now.knock_force;
}

// [J] that a contact has gained as its surface's stiffness changed in this tick, by no hand. Of the linear law
// 1/2 dk d0 d1, d0 and d1 the depths before and now: with the trapezoids of the force's work it is exact.
double gained(const Contact& contact, const LoadedContact& loaded, const Pressing& pressing) {
  const double before = pressing.energy_before, now = pressing.stored.energy;
  if (before == now || !(before > 0.0) || !(now > 0.0) || !(contact.share > 0.0)) return 0.0;
  const double was = contact.load / contact.share / std::sqrt(2.0 * before);
  return 0.5 * loaded.load * loaded.load / loaded.share * (1.0 - before / now) * was;
}

// One object's contacts of a tick.
struct Pressed {
  Room<Pressing, kMaxContactsPerObject> room;
  std::span<Pressing> pressing{room.all};
  std::size_t count = 0;
  SharedDents dents;
};

// Depth without a hand's motion stores no energy that was not there: a contact that begins beside others, or goes over
// to a deeper place, takes over their load, and only what is beyond counts as unpushed. It is the next of `pressed`.
bool settle(const ContactSearch& search, const Deformable& deformable, Pressed& pressed,
            std::span<LoadedContact> loaded) {
  constexpr int kHalvings = 24;
  Pressing& pressing = pressed.pressing[pressed.count];
  Contact& contact = *pressing.contact;
  const auto energy = [&](double unpushed) {
    contact.unpushed = unpushed;
    const bool stores = store(search, deformable, pressing, loaded[pressed.count]);
    const std::size_t count = pressed.count + (stores ? 1 : 0);
    if (count == 0) return 0.0;
    return share_load(loaded.first(count), search.object.kernel, pressed.dents.of(pressed.pressing.first(count)));
  };
  pressed.dents.add(search, pressed.pressing.first(pressed.count + 1));
  double none = 0.0, enough = contact.unpushed;
  const double had = energy(enough), others = energy(-contact.height), allowed = std::max(had, others) * (1 + 1e-12);
  if (energy(none) <= allowed) enough = none;
  for (int i = 0; i < kHalvings && enough > none; ++i) {
    const double middle = 0.5 * (none + enough);
    (energy(middle) <= allowed ? enough : none) = middle;
  }
  contact.unpushed = enough;
  pressing.source->settled = true;
  return store(search, deformable, pressing, loaded[pressed.count]);
}

// Rate term and friction on top of the elastic force; world frame.
void feel(World& world, const Deformable& deformable, const Mesh& mesh, ObjectState& object, const Pose& pose,
          const LoadedContact& loaded, Pressing& pressing, Tick tick) {
  Registry& registry = world.registry;
  Contact& contact = *pressing.contact;
  const FootBlend& place = pressing.source->place;
  const double along = length(place.gradient);
  double normal = loaded.share * pressing.stored.force * along;
  const double damping = painted(place, mesh, mesh.damping_factor).value;
  const double c = damping * (deformable.contact_damping_material ? object.motion.damping * deformable.stiffness
                                                                  : deformable.contact_damping);
  const double rate = (contact.previous_height - contact.height) / tick.elapsed();
  const double damped = std::max(-normal, loaded.share * c * rate);
  normal += damped;
  double beside = damped;
  if (deformable.transient_amplitude > 0) {
    beside += knock(contact.effects, deformable, along > 0 ? -dot(pressing.velocity, place.gradient) / along : 0.0,
                    normal, tick.elapsed());
    normal += contact.effects.knock_force;
  }
  contact.effects.pressed = true;
  if (object.stiffness_before > 0.0) {
    const double gain = gained(contact, loaded, pressing);
    for (std::size_t h = 0; h < object.accounts.size() && gain != 0.0 && std::isfinite(gain); ++h) {
      ProbeState& hand = world.touch->probes[h];
      if (hand.entity != contact.probe) continue;
      hand.stiffened += gain;
      object.accounts[h].given += gain;
    }
  }
  dvec3 force = loaded.force + (along > 0 ? beside / along : 0.0) * place.gradient;
  contact.load = loaded.load;
  contact.share = loaded.share;
  contact.normal_force = normal;
  contact.state = normal > 0 ? ContactState::kTouching : ContactState::kInside;

  // Friction in the tangent plane of this tick; the last tick's deflection is projected onto it.
  const double factor = painted(place, mesh, mesh.friction_factor).value;
  const double K = kBristleStiffness * deformable.stiffness * pressing.stiffness.value, B = K * kBristleDampingTime;
  Bristle bristle{contact.bristle - dot(contact.bristle, contact.normal) * contact.normal, contact.sliding};
  const dvec3 slip = pressing.velocity - dot(pressing.velocity, contact.normal) * contact.normal;
  const SlidingFriction friction{deformable.friction_static, deformable.friction_sliding, deformable.friction_stribeck,
                                 deformable.friction_viscous};
  const double speed = friction.stribeck > 0 || friction.viscous > 0 ? length(slip) : 0.0;
  const double sliding = factor * friction.at(speed) * normal;
  force -= step_bristle(bristle, slip, K, B, std::max(factor * deformable.friction_static * normal, sliding), sliding,
                        tick.elapsed());
  contact.bristle = bristle.deflection;
  contact.sliding = bristle.sliding;
  contact.force = pose.rotation * force;
  contact.gradient = pose.rotation * pressing.gradient;
  contact.stiffness = loaded.share * pressing.slope;
  contact.damping = damped > -(normal - damped) ? loaded.share * c : 0.0;
  contact.bristle_stiffness = bristle.sliding ? 0.0 : K;
  contact.bristle_damping = bristle.sliding ? factor * normal * std::max(0.0, friction.slope(speed)) : B;
  Probe& probe = registry.get<Probe>(contact.probe);
  const AxisPlace& axis = pressing.source->axis;
  const dvec3 at = tip_place(probe, pressing.source->tip).at(axis.along);
  probe.force += contact.force;
  probe.torque += cross(at - probe.position, contact.force);
  if (axis.curvature > 0) {  // a turn moves the place along the axis, where the depth is stationary and all else is not
    const double depth = loaded.share * pressing.stored.force * dot(place.gradient, axis.axis);
    const double by_along = (depth - dot(loaded.force, axis.axis)) / (1 + dot(axis.shift, axis.axis));
    probe.torque += pose.rotation * (by_along / axis.curvature * cross(axis.axis, place.gradient));
  }
}

// The force of a dent that two contacts of a capsule share acts at the ridge, too; each has half of it.
void turn_at_ridge(Registry& registry, const Pose& pose, const SharedDent& dent, const Pressing& a, const Pressing& b) {
  if (!a.source->tip.is_capsule()) return;
  const dvec3 halves = 0.5 * cross(a.source->x + b.source->x, dent.slope);
  registry.get<Probe>(a.contact->probe).torque += pose.rotation * (dent.pull * (dent.turning - halves));
}

void release(Contact& contact) {
  contact.state = contact.height < 0 ? ContactState::kInside : ContactState::kFree;
  contact.load = contact.share = contact.normal_force = 0.0;
  contact.force = contact.bristle = contact.gradient = dvec3(0);
  contact.stiffness = contact.damping = contact.bristle_stiffness = contact.bristle_damping = 0.0;
  contact.sliding = false;
  contact.effects = {.finest = contact.effects.finest};
  contact.damage.yields = false;
}

// Friction of every tip in its hole, also of those that no layer presses on.
void grip_tips(World& world, const ObjectState& object, const Deformable& deformable, const Pose& pose, Tick tick) {
  Registry& registry = world.registry;
  for (const TrackedTip& tip : object.tips) {
    const SourceState& source = object.sources[tip.source];
    if (!source.tracked || source.tip.drawn) continue;
    Contact& contact = registry.get<Contact>(source.contact);
    const dvec3 force = pose.rotation * grip(deformable, source.place, contact, tick.elapsed());
    if (force == dvec3(0)) continue;
    Probe& probe = registry.get<Probe>(contact.probe);
    contact.state = ContactState::kTouching;
    if (contact.gradient == dvec3(0)) contact.gradient = pose.rotation * source.place.gradient;
    contact.force += force;
    probe.force += force;
    probe.torque += cross(tip_place(probe, source.tip).at(source.axis.along) - probe.position, force);
  }
}

// The contacts that store energy, settled ones first.
void press_contacts(const ContactSearch& search, const Deformable& deformable, const Pose& pose, Pressed& pressed,
                    std::vector<LoadedContact>& loaded) {
  World& world = search.world;
  Registry& registry = world.registry;
  ObjectState& object = search.object;
  const Mesh& mesh = search.mesh;
  const bool uneven = object.texture.count > 0 || (mesh.relief && deformable.relief > 0);
  const std::span<Pressing> pressing = pressed.pressing;
  std::size_t& count = pressed.count;
  SharedDents& dents = pressed.dents;
  for (const bool settled : {true, false}) {
    for (const TrackedTip& tip : object.tips) {
      SourceState& source = object.sources[tip.source];
      if (!source.tracked || source.tip.drawn || source.settled != settled) continue;
      Contact& contact = registry.get<Contact>(source.contact);
      advance_free_surface(contact, source.place, mesh, object.motion);
      pressing[count] = {&source, &contact, {}, 0.0, {}, 0.0, {}, {}, source.place.gradient, {}};
      if (contact.height < 0) pressing[count].velocity = velocity_on(registry, pose, contact, source, search.tick);
      if (contact.height < 0 && uneven) {
        pressing[count].raised = raise(world, object, deformable, mesh, pressing[count], search.tick);
        pressing[count].gradient -= pressing[count].raised.gradient;
      }
      if (contact.height < 0 && !object.sets.empty()) {
        const Raised set = set_under(object, source.place, source.axis);
        pressing[count].raised.height += set.height;
        pressing[count].raised.gradient += set.gradient;
        pressing[count].gradient -= set.gradient;
      }
      const bool stores = contact.height < 0 && (settled ? store(search, deformable, pressing[count], loaded[count])
                                                         : settle(search, deformable, pressed, loaded));
      if (stores) {
        ++count;
        if (settled) dents.add(search, pressing.first(count));
      } else {
        dents.remove(count);
        if (contact.height < 0 && !std::isfinite(pressing[count].stored.energy)) world.dropped |= kDroppedNonFinite;
        release(contact);
      }
    }
  }
}

}  // namespace

void friction_feedback(World& world, Tick tick) {
  Registry& registry = world.registry;
  for (auto [entity, probe] : registry.view<Probe>()) probe.force = probe.torque = dvec3(0);
  for (ProbeState& hand : world.touch->probes) hand.stiffened = 0.0;
  world.touch->events.clear();
  world.touch->events_over = 0;
  for (const std::uint32_t slot : world.touch->awake) {
    ObjectState& object = world.touch->objects[slot];
    const Deformable& deformable = registry.get<Deformable>(object.entity);
    const Mesh& mesh = world.meshes[deformable.mesh];
    const HeightField& field = world.fields[deformable.field];
    const ContactSearch search{world, object, mesh, field, tick};
    const Pose& pose = registry.get<Pose>(object.entity);
    std::vector<LoadedContact>& loaded = world.touch->loaded;
    Pressed pressed;
    const std::span<Pressing> pressing = pressed.pressing;
    press_contacts(search, deformable, pose, pressed, loaded);
    const std::size_t count = pressed.count;
    SharedDents& dents = pressed.dents;
    object.stored = 0.0;
    const bool gives_way = !deformable.layers.empty() || deformable.yield_force > 0;
    if (count == 0) {
      if (object.stiffness_before > 0.0) object.stiffness_before = deformable.stiffness;
      if (gives_way) grip_tips(world, object, deformable, pose, tick);
      continue;
    }
    std::span<SharedDent> shared;
    for (std::size_t pass = 0, left = 1; left > 0 && pass <= kMostLayers; ++pass) {  // a layer in a pass
      shared = dents.of(pressing.first(count));
      object.stored = share_load({loaded.data(), count}, object.kernel, shared);
      left = 0;
      for (std::size_t i = 0; gives_way && i < count; ++i)
        if (give_way(search, deformable, pressing[i], loaded[i])) ++left;
    }
    if (!std::isfinite(object.stored)) {  // from a registered law or shape
      world.dropped |= kDroppedNonFinite;
      object.stored = 0.0;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (loaded[i].share > 0) {
        feel(world, deformable, mesh, object, pose, loaded[i], pressing[i], tick);
      } else {
        release(*pressing[i].contact);
      }
    }
    if (object.stiffness_before > 0.0) object.stiffness_before = deformable.stiffness;
    for (const SharedDent& dent : shared) turn_at_ridge(registry, pose, dent, pressing[dent.a], pressing[dent.b]);
    if (gives_way) grip_tips(world, object, deformable, pose, tick);
  }
}

}  // namespace pliant
