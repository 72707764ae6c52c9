#include "systems/soft/body/kinematic_body.h"

#include <algorithm>

#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/contact/contact_point.h"

namespace pliant {
namespace {

Pose pose_at(const World& world, const KinematicBody& led, double time) {
  dmat4 to_world(1.0);
  for (const KinematicBody::Link& link : led.links)
    to_world = to_world * (link.motion.valid() ? sample_motion(world.motions[link.motion], link.rest, time)
                                               : local_frame(link.rest))
                              .matrix();
  return rigid_part(to_world);
}

bool jumps(const World& world, const KinematicBody& led, double from, double to) {
  return std::any_of(led.links.begin(), led.links.end(), [&](const KinematicBody::Link& link) {
    return link.motion.valid() && jumps_between(world.motions[link.motion], from, to);
  });
}

}  // namespace

std::vector<KinematicBody::Link> links_of(const World& world, Entity entity) {
  const std::vector<Hierarchy::Link>& order = world.hierarchy.order();
  std::vector<KinematicBody::Link> links;
  bool moves = false;
  const auto at = std::find_if(order.begin(), order.end(), [&](const auto& link) { return link.entity == entity; });
  for (std::int64_t i = at == order.end() ? -1 : at - order.begin(); i >= 0;
       i = order[static_cast<std::size_t>(i)].parent) {
    const Entity node = order[static_cast<std::size_t>(i)].entity;
    const LocalTransform* const rest = world.registry.find<LocalTransform>(node);
    const Kinematic* const kinematic = world.registry.find<Kinematic>(node);
    links.push_back({kinematic ? kinematic->motion : Handle<PrescribedMotion>{}, rest ? *rest : LocalTransform{}});
    moves = moves || kinematic;
  }
  if (!moves) links.clear();
  std::reverse(links.begin(), links.end());
  return links;
}

void lead(const World& world, const KinematicBody& led, FixedBody& body, Tick tick) {
  const double end = tick.time + tick.dt;
  const Pose to = pose_at(world, led, end);
  if (jumps(world, led, tick.time, end)) {
    body.set_velocity(dvec3(0), dvec3(0));
    body.place(to);
    return;
  }
  const Pose& from = body.pose();
  body.set_velocity((to.position - from.position) / tick.dt,
                    vector_of(to.rotation * glm::conjugate(from.rotation)) / tick.dt);
}

double energy_given(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts) {
  double sum = 0.0;
  for (const ContactPoint& c : contacts) {
    const Body &a = *bodies[c.body_a], &b = *bodies[c.body_b];
    if (!a.prescribed() && !b.prescribed()) continue;
    const dvec3 impulse = c.axes * c.impulse;  // on a
    if (b.prescribed()) sum += dot(impulse, b.velocity_of(c.b));
    if (a.prescribed()) sum -= dot(impulse, a.velocity_of(c.a));
  }
  return sum;
}

}  // namespace pliant
