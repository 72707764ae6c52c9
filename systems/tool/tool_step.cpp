#include "systems/tool/tool_step.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/soft_state.h"
#include "systems/tool/linearise.h"

namespace pliant {
namespace {

// [m] Largest motion of a handle in one soft step; faster motions are split into up to kMostParts shorter steps. A step
// must not pass through a finger's width.
constexpr double kMostWay = 0.01;
constexpr int kMostParts = 8;
constexpr double kMostTurn = 1.0;  // [rad] the same for the turn of a rigid body, whose points move on arcs
constexpr int kMoreParts = 4;      // additional parts of a step to avoid crossings

double fastest_turn(const SoftState& soft) {  // [rad/s] of rigid bodies
  double most = 0.0;
  for (const std::uint32_t i : soft.moving)
    if (const auto path = soft.bodies[i]->path()) most = std::max(most, length(path->angular));
  return most;
}

}  // namespace

void run_soft_step(Schedule<World>& schedule, World& world, Tick tick) {
  if (!world.soft) return schedule.run(world, tick);
  SoftState& soft = *world.soft;
  const double parts = std::max(farthest_way(world) / kMostWay, fastest_turn(soft) * tick.dt / kMostTurn);
  soft.parts = std::clamp(static_cast<int>(std::ceil(parts)), 1, kMostParts);
  soft.more = kMoreParts;
  double done = 0.0;
  for (soft.part = 0; soft.part < soft.parts; ++soft.part) {
    const double dt = (tick.dt - done) / (soft.parts - soft.part);
    schedule.run(world, {tick.index, dt, tick.time + done});
    done += soft.share * dt;
  }
  if (soft.share < 1.0) soft.tally.halted_for += tick.dt - done;
  soft.parts = 1, soft.part = 0, soft.more = 0;
}

void read_tool_input(World& world, Tick tick) {
  if (!world.soft) return;
  SoftState& soft = *world.soft;
  if (soft.part == 0) {
    soft.began = now_ns();
    soft.step = tick.dt * soft.parts;
    soft.settled = true;
  }
  take_inputs(world, tick.dt);
}

void linearise_tools(World& world, Tick tick) {
  if (!world.soft || world.soft->part + 1 < world.soft->parts) return;
  const std::uint64_t begin = now_ns();
  linearise(world, tick.dt);
  world.soft->times.linearise = ms_since(begin);
}

void publish_tools(World& world, Tick) {
  if (!world.soft || world.soft->part + 1 < world.soft->parts) return;
  publish_models(world);
  ++world.soft->steps;
  world.soft->times.total = ms_since(world.soft->began);
}

}  // namespace pliant
