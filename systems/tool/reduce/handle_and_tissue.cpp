#include "systems/tool/reduce/handle_and_tissue.h"

#include "systems/tool/reduce/passive.h"

namespace pliant {
namespace {

void describe_handle(const ToolBody& tool, double T, HandleModel& out) {
  const Vector6 w = tool.velocity().tail<6>();
  RigidHandle end = tool.handle();
  end.set_velocity(w);
  end.advance(T);
  out.handle = end.motion();
  out.handle.velocity = w;
  out.centre = end.centre();
  out.soft_step = T;
  out.handle_mass = tool.handle_mass();
  out.handle_load = tool.handle_load();
}

// Wrench of the tool's contacts that were not chosen; their forces are constant.
Vector6 wrench_of_others(const ToolContacts& contacts) {
  const FinishedStep& step = contacts.step();
  const ToolBody& tool = contacts.tool();
  const std::uint32_t index = contacts.tool_index();
  Vector6 out = Vector6::Zero();
  Rows three(3, 6);
  for (std::size_t i = 0; i < step.contacts.size(); ++i) {
    const ContactPoint& p = step.contacts[i];
    if ((p.body_a != index && p.body_b != index) || contacts.chosen(i)) continue;
    three.setZero();
    if (p.body_a == index) tool.handle_rows(p.a, p.axes, 1.0, three);
    if (p.body_b == index) tool.handle_rows(p.b, p.axes, -1.0, three);
    const Eigen::Vector3d impulse(p.impulse.x, p.impulse.y, p.impulse.z);
    out += three.transpose() * impulse / step.T;
  }
  return out;
}

// The tissue moves as Phi w. `wrench`: on the handle, without inertia, damping and the chosen contacts.
void describe_tissue(const ToolBody& tool, double T, const Vector6& wrench, CondensedContacts& out) {
  const StepSplit split{T, tool.damping()};
  const auto [alpha, beta] = split.damping;
  const Eigen::Index tissue = tool.size() - 6;
  Rows weighed;
  tool.weigh(tool.follow(), weighed);
  const auto moved = weighed.topRows(tissue);
  out.tissue_mass = passive(tool.follow().topRows(tissue).transpose() * moved);
  out.tissue_stiffness = passive((tool.tissue_matrix() - split.inertia() * out.tissue_mass) / split.elastic());
  out.tissue_damping = alpha * out.tissue_mass + beta * out.tissue_stiffness;

  const Vector6 w = tool.velocity().tail<6>();
  const Vector6 m_v = moved.transpose() * tool.velocity().head(tissue);
  const Vector6 m_v0 = moved.transpose() * tool.starting_velocity().head(tissue);
  const Vector6 k_v = (tool.tissue_matrix() * w - split.inertia() * m_v) / split.elastic();
  out.tissue_force = wrench + (m_v - m_v0) / T + alpha * m_v + beta * k_v;
}

}  // namespace

void describe_handle_and_tissue(const ToolContacts& contacts, HandleModel& out) {
  const ToolBody& tool = contacts.tool();
  const double T = contacts.step().T;
  const Eigen::Index rows = contacts.rows();
  describe_handle(tool, T, out);
  const Vector6 start = tool.starting_velocity().tail<6>();
  const Vector6 tissue = tool.tissue_wrench() - tool.tissue_matrix() * (out.handle.velocity - start) / T;
  const Vector6 from_contacts = out.contacts.from_handle.topRows(rows).transpose() * out.contacts.force.head(rows);
  const Vector6 elsewhere = wrench_of_others(contacts);
  out.force = tissue + from_contacts + elsewhere;
  describe_tissue(tool, T, tissue + elsewhere, out.contacts);
}

}  // namespace pliant
