// The force on the probe: local law along the interpolated normal, bristle friction across it. Summed over the probe's
// contacts; what leaves for the hand is write_devices' business.
#include "systems/touch/friction_feedback.h"

#include "systems/touch/contact_law.h"
#include "systems/touch/friction.h"
#include "systems/touch/touch_state.h"

namespace pliant {
namespace {

void release(Contact& contact) {
  contact.state = contact.height < 0 ? ContactState::kInside : ContactState::kFree;
  contact.normal_force = 0.0;
  contact.force = dvec3(0);
  contact.bristle = dvec3(0);
  contact.sliding = false;
  contact.just_touched = false;
}

}  // namespace

void friction_feedback(World& world, Tick tick) {
  Registry& registry = world.registry;
  for (auto [entity, probe] : registry.view<Probe>()) probe.force = dvec3(0);
  for (auto [entity, contact] : registry.view<Contact>()) {
    if (contact.state != ContactState::kTouching || contact.probe == kNoEntity) continue;
    const Deformable& deformable = registry.get<Deformable>(contact.object);
    const Mesh& mesh = world.meshes[deformable.mesh];
    const ObjectState& object = world.touch->objects[contact.object_slot];
    const double stiffness =
        deformable.stiffness * painted(mesh.stiffness_factor, mesh, contact.triangle, contact.barycentric);

    const double pushed = advance_contact_law(contact, deformable, object.motion, stiffness, contact.rim_height);
    if (pushed <= 0 && !contact.just_touched) {  // it would pull
      release(contact);
      continue;
    }
    contact.just_touched = false;
    contact.normal_force = pushed > 0 ? pushed : 0.0;

    // Friction in the tangent plane of this tick; the deflection is carried over from the last one's.
    Probe& probe = registry.get<Probe>(contact.probe);
    const Pose& pose = registry.get<Pose>(contact.object);
    const dvec3 velocity = glm::conjugate(pose.rotation) * probe.velocity;
    const double factor = painted(mesh.friction_factor, mesh, contact.triangle, contact.barycentric);
    const double K = kBristleStiffness * stiffness, B = K * kBristleDampingTime;
    Bristle bristle{contact.bristle - dot(contact.bristle, contact.normal) * contact.normal, contact.sliding};
    const dvec3 f = step_bristle(bristle, velocity - dot(velocity, contact.normal) * contact.normal, K, B,
                                 factor * deformable.friction_static * contact.normal_force,
                                 factor * deformable.friction_sliding * contact.normal_force, tick.dt);
    contact.bristle = bristle.deflection;
    contact.sliding = bristle.sliding;
    contact.force = pose.rotation * (contact.normal_force * contact.normal - f);
    probe.force += contact.force;
  }
}

}  // namespace pliant
