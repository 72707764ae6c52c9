#include "systems/tool/reduce/reduce_tool.h"

#include <algorithm>

#include "systems/tool/reduce/catch_up.h"
#include "systems/tool/reduce/condense_bodies.h"
#include "systems/tool/reduce/handle_and_tissue.h"
#include "systems/tool/reduce/linear_model.h"
#include "systems/tool/reduce/stiff_contacts.h"

namespace pliant {

void reduce_tool(const FinishedStep& step, std::uint32_t tool, double tick, HandleModel& out) {
  const ToolContacts contacts(step, tool);
  describe_contacts(contacts, out.contacts);
  describe_handle_and_tissue(contacts, out);
  const Eigen::MatrixXd W = condense_bodies(contacts, tick, out.contacts);
  mark_stiff(W, out.contacts);
  const Vector6 left = contacts.tool().short_of_prescribed(out.handle);
  const Vector6 by_inertia = catch_up(contacts, left, W, out);
  out.contacts.prepare_tick(tick);
  out.linear = linear_model(contacts.tool(), out, W);
  const Vector6 dropped = drop_stiff(step.T, step.beta, left, out.contacts);
  out.force -= dropped;
  out.linear.force += by_inertia - dropped;
}

void describe_tool(const FinishedStep& step, std::uint32_t tool, double tick, HandleModel& out) {
  const ToolContacts contacts(step, tool);
  describe_contacts(contacts, out.contacts);
  describe_handle_and_tissue(contacts, out);
  out.contacts.modes = 0;
  out.contacts.tick = tick;
  std::fill(out.contacts.stiff.begin(), out.contacts.stiff.end(), std::uint8_t{0});
  out.passed_on = -contacts.tool().coupling_at(out.handle) - out.handle_load;
}

}  // namespace pliant
