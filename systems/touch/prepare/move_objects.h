// Kinematic objects: animated and scripted nodes are moved before any system reads their pose. Only nodes under a
// prescribed motion cost time.
#pragma once

#include <cstdint>
#include <vector>

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

struct TouchState;

// A node that moves, by itself or with an ancestor. Parents precede children.
struct MovingNode {
  Entity entity;
  std::int32_t parent = -1;         // index among the moving nodes; -1: the parent does not move
  std::int32_t object = -1;         // index into TouchState::objects; -1: not touchable
  Handle<PrescribedMotion> motion;  // invalid: it only moves with its parent
  LocalTransform rest;              // rest transform in its parent's frame, for what `motion` does not prescribe
  dmat4 above{1};                   // of a parent that does not move, to world
  dmat4 world{1};                   // node to world
  bool drawn = false;
  bool placed = false;  // placed by an earlier tick: `time` is valid
  bool jumped = false;  // jumped in the last tick: no velocity
  double time = 0.0;    // [s] of the last tick
};

// The moving nodes that carry something, at their initial pose; adds their MovingPose. Called by prepare_touch, when
// `touch` has its objects.
std::vector<MovingNode> find_moving(World& world, const TouchState& touch);

// Every time of a key of their motions, ascending. [s]
std::vector<double> key_times(const World& world, const std::vector<MovingNode>& nodes);
// Poses and boxes of the nodes' objects at that time, without velocities. For preparation.
void place_at(World& world, TouchState& touch, std::vector<MovingNode> nodes, double time);

// Kinematic -> local transforms at the tick's time -> Pose, MovingPose and world box; for untouchable nodes ->
// WorldTransform. Velocities are the mean over the tick, so that a probe riding on a surface is at rest on it.
void move_objects(World& world, Tick tick);

// Snapshot entries of all drawn moving nodes; publish_moved updates them.
std::vector<MovedSnapshot> moved_snapshots(const World& world, const TouchState& touch);
void publish_moved(const World& world, Snapshot& snapshot);

}  // namespace pliant
