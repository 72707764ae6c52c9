#include "systems/tool/hash_soft.h"

#include "components/hash_vector.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

void add(Hash& hash, const Vector6& v) {
  for (const double x : v) hash.add(x);
}

}  // namespace

void hash_soft(const World& world, Hash& hash) {
  if (world.soft) {
    for (const std::unique_ptr<Body>& body : world.soft->bodies) {
      for (const dvec3 x : body->surface_position) add(hash, x);
      for (const double v : body->velocity()) hash.add(v);
    }
    for (const ContactPoint& contact : world.soft->contacts) {
      hash.add(contact.key);
      add(hash, contact.impulse);
    }
  }
  if (!world.tools) return;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools) {
    add(hash, tool->handle.pose.position);
    add(hash, tool->handle.velocity);
    add(hash, tool->wrench);
  }
}

void hash_tool_forces(const World& world, Hash& hash) {
  if (!world.tools) return;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools) {
    const HapticDevice& device = world.registry.get<HapticDevice>(tool->device);
    add(hash, device.force_sent);
    add(hash, device.torque_sent);
  }
}

}  // namespace pliant
