// Kinematic objects: what an animation or a script carries is at its place before anything asks where it is. Only nodes
// under a prescribed motion cost anything.
#pragma once

#include <cstdint>
#include <vector>

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

struct TouchState;

// A node that moves, itself or with the node above it. Parents stand before children.
struct MovingNode {
  Entity entity;
  std::int32_t parent = -1;         // among the nodes that move; -1: the node above stands still
  std::int32_t object = -1;         // into TouchState::objects; -1: it cannot be touched
  Handle<PrescribedMotion> motion;  // invalid: it only goes with its parent
  LocalTransform rest;              // where it is in its parent's frame, as far as `motion` does not say
  dmat4 above{1};                   // of the parent that stands still, to world
  dmat4 world{1};                   // node to world
  bool drawn = false;
  bool placed = false;  // a tick has come by: `time` holds
  bool jumped = false;  // in the last tick: without a velocity
  double time = 0.0;    // [s] of the last tick
};

// The nodes that move and have something to carry, where they stand at the start; makes their MovingPose. Called by
// prepare_touch, when `touch` knows its objects.
std::vector<MovingNode> find_moving(World& world, const TouchState& touch);

// Kinematic -> local transforms at the tick's time -> Pose, MovingPose and world box, or WorldTransform where there is
// nothing to touch. Velocities are the mean over the tick, so that what rides along with a surface is at rest on it.
void move_objects(World& world, Tick tick);

// Every drawn one of them, for a snapshot; and where they are now.
std::vector<MovedSnapshot> moved_snapshots(const World& world, const TouchState& touch);
void publish_moved(const World& world, Snapshot& snapshot);

}  // namespace pliant
