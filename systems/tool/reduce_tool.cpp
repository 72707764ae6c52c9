#include "systems/tool/reduce_tool.h"

#include "systems/tool/reduction/condense_bodies.h"
#include "systems/tool/reduction/handle_and_flesh.h"
#include "systems/tool/reduction/linear_model.h"

namespace pliant {

void reduce_tool(const FinishedStep& step, std::uint32_t tool, double tick, HandleModel& out) {
  const ToolContacts contacts(step, tool);
  describe_contacts(contacts, out.contacts);
  describe_handle_and_flesh(contacts, out);
  const Eigen::MatrixXd W = condense_bodies(contacts, tick, out.contacts);
  out.contacts.prepare_tick(tick);
  out.linear = linear_model(contacts.tool(), out, W);
}

}  // namespace pliant
