#include "systems/tool/linearise.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/body/tool_body.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/begun_inside.h"
#include "systems/tool/reduce/reduce_tool.h"
#include "systems/tool/reduce/stiff_contacts.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

// Index of the tool's body in the soft step; the number of bodies if it has none.
std::uint32_t body_of(const SoftState& soft, Entity tool) {
  std::uint32_t index = 0;
  while (index < soft.bodies.size() && !(soft.bodies[index]->entity == tool)) ++index;
  return index;
}

// Null if there is no such body, or it has no handle.
ToolBody* tool_body(const SoftState& soft, std::uint32_t index) {
  auto* const body = index < soft.bodies.size() ? soft.bodies[index]->as_tool() : nullptr;
  return body && body->has_handle() ? body : nullptr;
}

// One tick of the model along a known path: the model moves with the handle.
void follow(HandleModel& model, CondensedState& state, const Vector6& velocity, const SweepLimits& limits) {
  const double tick = model.contacts.tick;
  TickHandle handle;
  handle.velocity = model.handle.velocity;
  handle.moved = true;
  handle.next = velocity;
  model.force = condensed_tick(model.contacts, state, limits, handle);
  model.handle.velocity = velocity;
  model.handle.pose.position += tick * linear(velocity);
  model.handle.pose.rotation = glm::normalize(rotation_of(tick * angular(velocity)) * model.handle.pose.rotation);
}

// Rebases the model to its current state: displacements are zero again.
void rebase(HandleModel& model, const CondensedState& state, const Vector6& w0) {
  CondensedContacts& c = model.contacts;
  const Eigen::Index rows = 3 * c.count, modes = c.modes;
  model.linear.force -= model.linear.stiffness * state.d + model.linear.damping * (model.handle.velocity - w0);
  c.tissue_force -= c.tissue_stiffness * state.d + c.modal_stiffness.topRows(modes).transpose() * state.q.head(modes);
  c.load.head(modes) -=
      c.frequency2.head(modes).cwiseProduct(state.q.head(modes)) + c.modal_stiffness.topRows(modes) * state.d;
  c.rate.head(modes) = state.rate.head(modes);
  c.force.head(rows) = state.problem.impulse.head(rows) / c.tick;
  for (int i = 0; i < c.count; ++i)
    if (c.most[static_cast<std::size_t>(i)] < HUGE_VAL)
      c.unbounded[static_cast<std::size_t>(i)] = state.spring[3 * i] / c.flexibility(3 * i, 3 * i);
  c.gap.head(c.count) = state.gap.head(c.count);
  std::copy_n(state.slip.begin(), c.count, c.slip.begin());
  std::copy_n(state.reach.begin(), c.count, c.reach.begin());
  std::copy_n(state.problem.sliding.begin(), c.count, c.sliding.begin());
  model.force -= drop_stiff(model.soft_step, kPenetrationShare, Vector6::Zero(), c);
}

// The handle's ticks since the model's time. At most one ring's length: emptying the path as fast as it fills might
// never end.
void take_path(ToolTouchState& tool, double since) {
  tool.gone.clear();
  HandleStep step;
  for (std::size_t i = 0; i < kPathLength && tool.path.pop(step); ++i)
    if (step.time > since) tool.gone.push_back(step);
}

// Follows the handle's path since the model's time in at most kMostFollowed ticks of the model; at high touch rates,
// several ticks are merged into one.
void bring_up_to_date(ToolTouchState& tool, HandleModel& model, CondensedState& state) {
  const double tick = model.contacts.tick;
  take_path(tool, model.time + 0.5 * tick);
  if (tool.gone.empty()) return;
  const std::size_t together = (tool.gone.size() + kMostFollowed - 1) / kMostFollowed;
  if (together > 1) model.contacts.prepare_tick(static_cast<double>(together) * tick);
  state.start(model.contacts);
  const Vector6 w0 = model.handle.velocity;
  for (std::size_t first = 0; first < tool.gone.size(); first += together) {
    Vector6 mean = Vector6::Zero();
    for (std::size_t i = first; i < std::min(first + together, tool.gone.size()); ++i)
      mean += tool.gone[i].velocity / static_cast<double>(together);
    follow(model, state, mean, sweep_limits(model.contacts, {kTickSweeps, kTickTolerance, 0}));
  }
  model.time = tool.gone.back().time;
  model.handle.velocity = tool.gone.back().velocity;
  rebase(model, state, w0);
  if (together > 1) model.contacts.prepare_tick(tick);
}

// Wrench of tissue and contacts on the handle, mean over the ticks since the last input. Without a new input, it is
// unchanged.
void hear_wrench(ToolTouchState& tool, const ToolInput& input) {
  const double elapsed = input.time - tool.heard_at;
  if (!(elapsed > 0.0)) return;
  tool.expected = (input.impulse - tool.heard) / elapsed;
  tool.heard_at = input.time;
  tool.heard = input.impulse;
}

// Whether the handle moves faster than any hand.
bool got_away(const ToolBody& body) {
  const Vector6& w = body.handle().motion().velocity;
  return length(linear(w)) > kRunaway || length(angular(w)) > kRunawayTurn;
}

// Sets the tool back to the device: if the touch clock requests it, or if the handle got away in the last step.
bool set_back(SoftState& soft, ToolTouchState& tool, const ToolInput& input, ToolBody& body) {
  const bool away = got_away(body);
  if (!away && input.set_backs == tool.set_back) return false;
  tool.set_back = input.set_backs;
  if (away) soft.dropped |= kDroppedSetBack;
  body.release_device();
  body.set_device(input.device.pose, Vector6::Zero());
  body.set_back();
  if (body.absent) body.absent = begins_inside(soft, body_of(soft, tool.entity));
  ++tool.pending.set_backs;
  return true;
}

// Tools that are placed inside a body have no contacts until they have left it. A probe is placed by set_back.
void find_whether_inside(SoftState& soft, const ToolTouchState& tool, ToolBody& body) {
  const std::uint32_t index = body_of(soft, tool.entity);
  if (soft.steps == 0 && !tool.is_probe) body.absent = begins_inside(soft, index);
  if (body.absent && (tool.set_back > 0 || !tool.is_probe)) body.absent = still_inside(soft, index);
}

// Interpolates towards the touch clock's handle by `share`.
RigidMotion on_the_way(const RigidMotion& from, const RigidMotion& to, double share) {
  if (share == 1.0) return to;
  RigidMotion out = to;
  out.pose.position = glm::mix(from.pose.position, to.pose.position, share);
  out.pose.rotation = glm::slerp(from.pose.rotation, to.pose.rotation, share);
  return out;
}

void bring(ToolTouchState& tool, const ToolInput& input, double share, ToolBody& body) {
  const RigidMotion end = on_the_way(body.handle().motion(), input.handle, share);
  if (input.status == DeviceStatus::kReady)
    body.bring_handle(end, tool.expected, input.tick);
  else
    body.prescribe_handle(end);  // no device: the handle stays at its pose
}

// The touch clock's pose is void if the handle has been set back since.
bool says_where(const ToolTouchState& tool, const ToolInput& input) {
  return input.placed && input.seen == tool.pending.set_backs;
}

}  // namespace

double farthest_way(World& world) {
  double farthest = 0.0;
  if (!world.tools || !world.soft) return farthest;
  for (const auto& tool : world.tools->tools) {
    tool->input.acquire();
    const ToolInput& input = tool->input.read();
    const ToolBody* const body = tool_body(*world.soft, body_of(*world.soft, tool->entity));
    if (!body) continue;
    const dvec3 from = body->handle().motion().pose.position;
    if (says_where(*tool, input))
      farthest = std::max(farthest, length(input.handle.pose.position - from));
    else if (tool->wanted == ToolForce::kHeld && input.status == DeviceStatus::kReady)
      farthest = std::max(farthest, length(input.device.at(body->handle().centre()).pose.position - from));
  }
  return farthest;
}

void take_inputs(World& world, double T) {
  if (!world.tools || !world.soft) return;
  SoftState& soft = *world.soft;
  for (const auto& tool : world.tools->tools) {
    ToolBody* const body = tool_body(soft, body_of(soft, tool->entity));
    if (!body) continue;
    if (soft.part == 0) tool->input.acquire();
    const ToolInput& input = tool->input.read();
    soft.joints.set_grip(tool->entity, input.grip);
    const double left = T * (soft.parts - soft.part);  // [s] of the whole step
    Pose before = input.device.pose;
    before.position -= left * linear(input.device.velocity);
    before.rotation = glm::normalize(rotation_of(-left * angular(input.device.velocity)) * before.rotation);
    body->set_device(before, input.device.velocity);
    tool->pending.time = input.time;
    tool->pending.aside = tool->is_probe && (input.hold.hovers || !(input.hold.body == kNoEntity));
    if (tool->pending.aside) {
      body->halt();
      if (soft.part == 0) set_back(soft, *tool, input, *body);
      body->absent = true;
      continue;
    }
    if (soft.part == 0 && set_back(soft, *tool, input, *body)) continue;
    if (soft.part == 0) find_whether_inside(soft, *tool, *body);
    if (!says_where(*tool, input)) continue;
    if (soft.part == 0) hear_wrench(*tool, input);
    bring(*tool, input, 1.0 / (soft.parts - soft.part), *body);
  }
}

void linearise(World& world, double T) {
  if (!world.tools || !world.soft) return;
  SoftState& soft = *world.soft;
  const double tick = 1.0 / world.simulation.touch_rate;
  const double undone = soft.report.left_inside ? 0.0 : soft.undone_in(T);
  const FinishedStep step{soft.bodies, soft.contacts, soft.delassus, soft.problem, T, undone};
  for (const auto& tool : world.tools->tools) {
    const std::uint32_t index = body_of(soft, tool->entity);
    const ToolBody* const body = tool_body(soft, index);
    if (!body || !body->solvable()) continue;
    if (tool->wanted == ToolForce::kHeld)
      describe_tool(step, index, tick, tool->pending);
    else
      reduce_tool(step, index, tick, tool->pending);
    tool->pending.soft_step = std::max(soft.step, tick);  // time until the next one is used
    ++tool->pending.step;
  }
}

void publish_models(World& world) {
  if (!world.tools) return;
  for (const auto& tool : world.tools->tools) {
    if (tool->pending.step == 0) continue;
    tool->pending.fed = world.soft->joints.fed() + world.soft->tally.fed;  // of this step too
    bring_up_to_date(*tool, tool->pending, tool->replay);
    tool->model.write() = tool->pending;
    tool->model.publish();
  }
}

}  // namespace pliant
