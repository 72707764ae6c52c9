#include "systems/tool/tool_reading.h"

#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

// [N] sum of the contacts' normal forces: the soft step's, or the last tick's for stiff contacts. A translation of the
// handle moves a contact by the first three entries of its normal row.
dvec3 pushed_by(const CondensedContacts& contacts, const CondensedState& state) {
  dvec3 sum(0);
  for (int i = 0; i < contacts.count; ++i) {
    if (contacts.held[static_cast<std::size_t>(i)] != 0) continue;
    const dvec3 normal(contacts.from_handle(3 * i, 0), contacts.from_handle(3 * i, 1), contacts.from_handle(3 * i, 2));
    const bool stiff = contacts.stiff[static_cast<std::size_t>(i)] != 0;
    sum += (stiff ? state.problem.impulse[3 * i] / contacts.tick : contacts.force[3 * i]) * normal;
  }
  return sum;
}

// [N] The contacts of bodies that are joined to the handle, which do not push it themselves.
double pushed_through_joints(const CondensedContacts& contacts) {
  bool joined = false;
  double sum = 0.0;
  for (int i = 0; i < contacts.count; ++i) {
    const bool joint = contacts.held[static_cast<std::size_t>(i)] != 0;
    joined = joined || joint;
    if (!joint) sum += contacts.force[3 * i];
  }
  return joined ? sum : 0.0;
}

// Contact, normal and depth of a tool; false if no force of at least `least` [N] pushes it, nor what is joined to it.
bool read_contact(const ToolTouchState& tool, double least, ProbeReading& out) {
  const HandleModel& model = tool.model.read();
  const dvec3 push = pushed_by(model.contacts, tool.contacts);
  const bool pushed = length(push) > least;
  if (!tool.placed() || !(pushed || pushed_through_joints(model.contacts) > least)) return false;
  out.in_contact = true;
  out.normal = pushed ? normalize(push) : length(out.force) > 0.0 ? normalize(out.force) : dvec3(0);
  out.depth = tool.sensing ? length(tool.sensed.at(model.centre).pose.position - tool.handle.pose.position) : 0.0;
  return true;
}

// Normal and tangential parts of the force.
void split_force(ProbeReading& out) {
  const double along = dot(out.force, out.normal);
  out.normal_force = std::abs(along);
  out.tangential_force = length(out.force - along * out.normal);
}

}  // namespace

ProbeReading tool_reading(const World& world, Entity entity) {
  ProbeReading out;
  const ToolTouchState* const tool = find_tool(world, entity);
  if (!tool) return out;
  const HapticDevice& device = world.registry.get<HapticDevice>(tool->device);
  out.position = device.position;
  out.force = device.force_sent;
  read_contact(*tool, 0.0, out);
  split_force(out);
  return out;
}

namespace {

// A probe that pulls a body counts as touching it, whatever the direction of the force.
bool read_pull(const World& world, const ToolTouchState& tool, ProbeReading& out) {
  const ProbeHold& hold = world.registry.get<Probe>(tool.entity).hold;
  const double force = length(out.force);
  if (hold.body == kNoEntity || tool.model.read().pull.number != hold.number || !(force > 0.0)) return false;
  out.in_contact = true;
  out.object = kNoEntity;
  out.depth = out.height = 0.0;
  out.normal = out.force / force;
  split_force(out);
  return true;
}

}  // namespace

void add_body_reading(const World& world, Entity probe, ProbeReading& out) {
  const ToolTouchState* const tool = find_tool(world, probe);
  if (!tool || read_pull(world, *tool, out) || !read_contact(*tool, out.in_contact ? out.normal_force : 0.0, out))
    return;
  out.object = kNoEntity;
  out.height = 0.0;
  split_force(out);
}

}  // namespace pliant
