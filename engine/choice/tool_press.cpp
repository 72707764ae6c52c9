#include "engine/choice/tool_press.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "content/tets/step_cost.h"
#include "engine/choice/alone.h"
#include "runtime/clock.h"
#include "systems/device/path.h"
#include "systems/prepare_world.h"
#include "systems/schedule.h"
#include "systems/soft/body/coupling.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/tool_step.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

constexpr double kRestTime = 0.01, kPress = 0.1, kDraw = 0.14;  // [s] rest, descent, drag
constexpr double kDepth = 0.02;                                 // [1] of the tool's diagonal
constexpr double kGap = 0.1, kWay = 2.0;                        // [1] of the depth: above the plate; along it
constexpr double kPlate = 2.0;                                  // [1] of the tool's diagonal: half the plate's side
constexpr std::size_t kMostTruthSteps = 500;                    // 0.5 ms each
constexpr double kMostWork = 60e3;                              // [ms] of all soft steps, counted (step_cost.h)
constexpr std::size_t kForces = 3;                              // models pressed in addition, in the level's steps

struct PressFrame {
  dvec3 down, along, across;
};
PressFrame frame_of(dvec3 gravity) {
  const dvec3 down = length(gravity) > 0.0 ? normalize(gravity) : dvec3(0, -1, 0);
  const dvec3 other = std::abs(down.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 0, 1);
  const dvec3 along = normalize(other - dot(other, down) * down);
  return {down, along, cross(down, along)};
}

// A plate with its upper face around `top`.
LevelMesh plate(dvec3 top, const PressFrame& f, double half) {
  Primitive box;
  for (const double below : {0.0, 0.5})
    for (const dvec2 at : {dvec2(-1, -1), dvec2(1, -1), dvec2(1, 1), dvec2(-1, 1)})
      box.position.emplace_back(top + half * (at.x * f.along + at.y * f.across + below * f.down));
  // Outward, for along x across = down.
  box.index = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t a = i, b = (i + 1) % 4;
    for (const std::uint32_t corner : {a, b, b + 4, a, b + 4, a + 4}) box.index.push_back(corner);
  }
  LevelMesh mesh;
  mesh.name = "plate";
  mesh.primitives.push_back(std::move(box));
  return mesh;
}

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Ticks per step of the reference; 0: too many steps to measure. The step must be shorter than the one that it is
// compared with, unless it has the touch rate.
std::size_t stride_of(std::size_t ticks, std::size_t length, std::size_t tetrahedra) {
  const double step = step_ms(tetrahedra, 1.0);
  const double models = static_cast<double>(kForces * (ticks / length + 1)) * step;
  const double room = std::max(0.0, kMostWork - models) / step;  // steps
  const double steps = std::min(static_cast<double>(kMostTruthSteps), room);
  if (steps < 1.0) return 0;
  const auto stride = static_cast<std::size_t>(std::ceil(static_cast<double>(ticks) / steps));
  return stride <= 1 ? 1 : 2 * stride <= length ? stride : 0;
}

Status prepare_all(World& world) {
  return prepare_world(world);
}

ToolTouchState& tool_of(World& world) {
  return *world.tools->tools[0];
}

// The scripted state of the device.
RigidMotion device_at(const World& world, Entity device, double time, double dt) {
  const Path& path = world.paths[world.registry.get<HapticDevice>(device).path];
  const PathRow now = sample_path(path, time), before = sample_path(path, std::max(0.0, time - dt));
  return {{now.position, now.rotation}, join((now.position - before.position) / dt, dvec3(0))};
}

void note_model(const HandleModel& model, ToolPress::Felt& out) {
  const CondensedContacts& c = model.contacts;
  out.contacts = std::max(out.contacts, c.count);
  out.modes = std::max(out.modes, c.modes);
  const Eigen::Index rows = 3 * c.count, modes = c.modes;
  if (rows == 0) return;
  const double rest = c.flexibility.topLeftCorner(rows, rows).trace();
  double kept = 0.0;
  for (Eigen::Index m = 0; m < modes; ++m)
    if (c.frequency2[m] > 0.0) kept += c.from_modes.col(m).head(rows).squaredNorm() / c.frequency2[m];
  if (rest + kept > 0.0) out.left_out = std::max(out.left_out, rest / (rest + kept));
}

}  // namespace

Result<ToolPress> ToolPress::make(const Level& level, std::size_t node) {
  Level alone = level_alone(level, node);
  auto bare = spawn_level(alone);
  if (!bare) return bare.error();
  if (const Status ready = prepare_all(*bare); !ready) return ready.error();
  if (!bare->soft || bare->tools->tools.empty())
    return Error{level.nodes[node].name, "could not be held to measure its force", "leave out `error`"};
  const PressFrame f = frame_of(level.simulation.gravity);
  double low = -std::numeric_limits<double>::max();
  Box box;
  for (const dvec3& p : bare->soft->bodies[0]->surface_position) {
    box.add(vec3(p));
    low = std::max(low, dot(p, f.down));
  }
  ToolPress out;
  const double size = static_cast<double>(box.diagonal());
  out.depth_ = kDepth * size;
  const dvec3 middle(0.5f * (box.min + box.max));
  const dvec3 top = middle + (low + kGap * out.depth_ - dot(middle, f.down)) * f.down;

  LevelNode below;
  below.name = "plate";
  below.mesh = static_cast<std::int32_t>(alone.meshes.size());
  below.rigid_body.emplace();
  below.rigid_body->fixed = true;
  alone.meshes.push_back(plate(top, f, kPlate * size));
  alone.nodes.push_back(std::move(below));
  auto world = spawn_level(alone);
  if (!world) return world.error();
  out.world_ = std::move(world).value();
  out.tick_ = 1 / level.simulation.touch_rate;
  out.length_ =
      static_cast<std::size_t>(std::max(1LL, std::llround(level.simulation.soft_step * level.simulation.touch_rate)));
  out.ticks_ = static_cast<std::size_t>(std::lround((kRestTime + kPress + kDraw) / out.tick_));
  std::size_t tetrahedra = 0;
  for (auto [entity, body] : bare->registry.view<const SoftBody>())
    tetrahedra += bare->tet_meshes[body.tets].tets.size();
  out.stride_ = stride_of(out.ticks_, out.length_, tetrahedra);
  const double step = level.simulation.soft_step;
  if (step < (1 - 1e-9) * out.tick_)
    out.unmeasured_ = fmt::format("a soft step of {:.3g} ms is shorter than a tick; name a longer one", 1e3 * step);
  else if (out.stride_ == 0)
    out.unmeasured_ = fmt::format(
        "{} tetrahedra in soft steps of {:.3g} ms cannot be measured in a minute; name a "
        "longer soft_step or a larger `cell`",
        tetrahedra, 1e3 * step);
  if (!out.unmeasured_.empty()) return out;

  if (const Status ready = prepare_all(out.world_); !ready) return ready.error();
  out.tool_ = tool_of(out.world_).entity;
  HapticDevice& device = out.world_.registry.get<HapticDevice>(tool_of(out.world_).device);
  Path path;
  for (std::size_t i = 0; i <= out.ticks_; ++i) {
    const double t = static_cast<double>(i) * out.tick_;
    const double down = (1 + kGap) * smooth((t - kRestTime) / kPress),
                 along = kWay * smooth((t - kRestTime - kPress) / kDraw);
    path.rows.push_back({t, device.position + out.depth_ * (down * f.down + along * f.along), device.rotation});
  }
  device.driver = DriverKind::kScript;
  device.path = out.world_.paths.add(std::move(path));
  return out;
}

Status ToolPress::prepare(ToolForce force) {
  world_.registry.get<Handle6>(tool_).force = force;
  return prepare_all(world_);
}

Result<ToolPress::Felt> ToolPress::truth(ChoiceProgress& progress) {
  if (const Status ready = prepare(ToolForce::kHeld); !ready) return ready.error();
  Felt out;
  Schedule<World> schedule(soft_schedule());
  ToolTouchState& tool = tool_of(world_);
  const Handle6& settings = world_.registry.get<Handle6>(tool_);
  const std::uint64_t begin = now_ns();
  const double step = truth_step();
  for (std::size_t i = 0; i < ticks_ / stride_; ++i) {
    progress.say("measuring the force of a tool");
    const double time = static_cast<double>(i) * step;
    const RigidMotion device = device_at(world_, tool.device, time, step);
    ToolInput& input = tool.input.write();
    input.status = DeviceStatus::kReady;
    input.time = time;
    input.device = device;
    tool.input.publish();
    run_soft_step(schedule, world_, {i, step, time});
    const HandleModel& model = tool.pending;
    out.wrench.push_back(-coupling_force(settings, model.handle, device.at(model.centre)).wrench);
  }
  out.ms = static_cast<double>(now_ns() - begin) * 1e-6 / static_cast<double>(out.wrench.size());
  return out;
}

Result<ToolPress::Felt> ToolPress::touched(ToolForce force) {
  if (const Status ready = prepare(force); !ready) return ready.error();
  Felt out;
  std::vector<System<World>> steps = soft_schedule(), last;
  for (const System<World>& each : steps)
    if (each.name == "publish_tools") last.push_back(each);
  std::erase_if(steps, [](const System<World>& each) { return each.name == "publish_tools"; });
  Schedule<World> soft(std::move(steps)), publish(std::move(last)), touch(touch_schedule());
  const ToolTouchState& tool = tool_of(world_);
  const double T = static_cast<double>(length_) * tick_;
  for (std::size_t i = 0; i < ticks_; ++i) {
    const double time = static_cast<double>(i) * tick_;
    if (i % length_ == 0) {
      const std::uint64_t n = i / length_;
      if (i > 0) publish.run(world_, {n - 1, T, time - T});
      run_soft_step(soft, world_, {n, T, time});
      if (i == 0) publish.run(world_, {n, T, time});  // gives a force until the second model arrives
      note_model(tool.pending, out);
    }
    touch.run(world_, {i, tick_, time});
    out.wrench.push_back(Vector6(join(linear(tool.device_wrench), dvec3(0))));
  }
  for (std::size_t i = 0; i < touch.systems().size(); ++i)
    if (touch.systems()[i].name == "tool_feedback") out.ms = 1e-3 * touch.cost(i).percentile_us(0.5);
  return out;
}

}  // namespace pliant
