#include "systems/tool/tool_reading.h"

#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

// [N] sum of the contacts' normal forces: the soft step's, or the last tick's where only a tick can tell. Moving the
// handle as a whole moves a contact by its normal row's first three.
dvec3 pushed_by(const CondensedContacts& contacts, const CondensedState& state) {
  dvec3 sum(0);
  for (int i = 0; i < contacts.count; ++i) {
    const dvec3 normal(contacts.from_handle(3 * i, 0), contacts.from_handle(3 * i, 1), contacts.from_handle(3 * i, 2));
    const bool stiff = contacts.stiff[static_cast<std::size_t>(i)] != 0;
    sum += (stiff ? state.problem.impulse[3 * i] / contacts.tick : contacts.force[3 * i]) * normal;
  }
  return sum;
}

}  // namespace

ProbeReading tool_reading(const World& world, Entity entity) {
  ProbeReading out;
  if (!world.tools) return out;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools) {
    if (tool->entity != entity) continue;
    const HapticDevice& device = world.registry.get<HapticDevice>(tool->device);
    const HandleModel& model = tool->model.read();
    out.position = device.position;
    out.force = device.force_sent;
    const dvec3 push = pushed_by(model.contacts, tool->contacts);
    out.in_contact = dot(push, push) > 0.0;
    if (out.in_contact) {
      out.normal = normalize(push);
      if (tool->placed && tool->sensing)
        out.depth = length(tool->sensed.at(model.centre).pose.position - tool->handle.pose.position);
    }
  }
  const double along = dot(out.force, out.normal);
  out.normal_force = std::abs(along);
  out.tangential_force = length(out.force - along * out.normal);
  return out;
}

}  // namespace pliant
