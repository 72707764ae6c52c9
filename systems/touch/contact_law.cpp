#include "systems/touch/contact_law.h"

namespace pliant {

double law_force(const RestoringLaw& law, double stiffness, double depth) {
  return -stiffness * law.force(-depth);
}

double painted(const std::vector<float>& factor, const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric) {
  if (factor.empty()) return 1.0;
  const uvec3 t = mesh.triangles[triangle];
  return barycentric.x * factor[t.x] + barycentric.y * factor[t.y] + barycentric.z * factor[t.z];
}

double advance_contact_law(Contact& contact, const Deformable& deformable, const Motion& motion, double stiffness,
                           double rest_height) {
  if (!contact.just_touched) {
    HeightState y{contact.free_height - rest_height, contact.free_velocity};
    if (motion.nonlinear()) {
      y = step_restoring(motion.law, y, motion.mass, motion.damping, 1.0, 0.0, motion.dt);
    } else {
      y = {motion.linear.hh * y.height + motion.linear.hv * y.velocity,
           motion.linear.vh * y.height + motion.linear.vv * y.velocity};
    }
    contact.free_height = y.height + rest_height;
    contact.free_velocity = y.velocity;
  }
  // On the tick of touch the spring has been pressed from y to t within the tick.
  const double from = contact.just_touched ? contact.free_height : contact.previous_height;
  const double pressed = from - contact.height;  // [m] > 0: deeper
  double force =
      law_force(motion.law, stiffness, -contact.height) - law_force(motion.law, stiffness, -contact.free_height);
  if (motion.law.kind == SpringLaw::kStandardLinearSolid) {
    // q' = k1 h' - q/tau, exact for a constant rate over the tick.
    const double k1 = motion.arm_stiffness * stiffness, E = motion.arm_decay;
    contact.arm_force = contact.arm_force * E + k1 * (motion.arm_time / motion.dt) * (1 - E) * pressed;
    force += contact.arm_force;
  }
  const double c = deformable.contact_damping_material ? motion.damping * stiffness : deformable.contact_damping;
  return force + c * pressed / motion.dt;
}

}  // namespace pliant
