#include "systems/soft/publish_soft.h"

#include <algorithm>

#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/body/tool_body.h"
#include "systems/soft/local/drawn_dents.h"
#include "systems/soft/soft_state.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

ContactPlace place(const SoftState& soft, std::uint32_t body, const SurfacePoint& point) {
  return {soft.bodies[body]->entity, point.triangle, vec3(point.barycentric)};
}

ContactMark mark(const SoftState& soft, const ContactPoint& contact, double T) {
  return {vec3(0.5 * (contact.a.position + contact.b.position)),
          vec3(contact.normal),
          vec3(contact.axes * contact.impulse / T),
          contact.sliding,
          static_cast<float>(contact.depth > 0.0 ? contact.depth : -std::max(contact.gap, 0.0)),
          place(soft, contact.body_a, contact.a),
          place(soft, contact.body_b, contact.b)};
}

void show_bodies(const SoftState& soft, double T, SoftSnapshot& out) {
  std::size_t handle = 0, object = 0;
  for (const std::uint32_t i : soft.moving) {
    const Body& body = *soft.bodies[i];
    if (body.kind == BodyKind::kProbe) continue;
    SoftObjectSnapshot& shown = out.objects[object++];
    body.show(shown);
    draw_dents(soft.bodies, i, soft.contacts, T, shown);
    if (const auto* tissue = body.as_tissue())
      for (std::size_t part = 0; part < tissue->part_count(); ++part) tissue->show_part(part, out.objects[object++]);
    const auto* tool = body.as_tool();
    if (!tool || !tool->has_handle()) continue;
    const Vector6 wrench = tool->handle_wrench();
    const vec3 middle(tool->handle().motion().pose.position), wanted(tool->device_target().pose.position);
    out.handles[handle++] = {
        body.entity, tool->handle().object_pose(), vec3(linear(wrench)), vec3(angular(wrench)), middle, wanted};
  }
}

// Pushing contacts first; then, while there is room, those that are only near.
void show_contacts(const SoftState& soft, double T, SoftSnapshot& out) {
  out.contact_count = static_cast<std::uint32_t>(soft.contacts.size());
  out.contacts.clear();
  for (const bool pushing : {true, false})
    for (const ContactPoint& contact : soft.contacts)
      if (contact.hold.joint < 0 && (contact.impulse.x > 0.0) == pushing && out.contacts.size() < kMaxShownContacts)
        out.contacts.push_back(mark(soft, contact, T));
}

}  // namespace

void publish_soft(World& world, Tick tick) {
  if (!world.soft) return;
  SoftState& soft = *world.soft;
  SoftSnapshot& out = world.soft_snapshots->write();
  out.step = soft.steps;
  out.time = tick.time;
  out.step_ms = soft.times.total;
  show_bodies(soft, tick.dt, out);
  show_contacts(soft, tick.dt, out);
  world.soft_snapshots->publish();

  if (soft.yielding.empty()) return;
  Presses& presses = world.touch->presses->write();
  presses.soft_step = tick.dt;
  for (const std::uint32_t i : soft.yielding) {
    YieldingBody& surface = soft.surface(i);
    surface.list_presses(soft.contacts, soft.bodies, tick.dt, presses.objects[surface.slot()]);
  }
  world.touch->presses->publish();
}

}  // namespace pliant
