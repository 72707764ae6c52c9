#include "systems/touch/prepare/move_objects.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/effect.h"
#include "systems/touch/collide/seams.h"
#include "systems/touch/prepare/prepare.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

// [rad/s] of the shortest rotation from one orientation to another within dt.
dvec3 angular_velocity(const dquat& from, const dquat& to, double dt) {
  dquat turn = to * glm::conjugate(from);
  if (turn.w < 0.0) turn = -turn;
  const dvec3 axis(turn.x, turn.y, turn.z);  // length: sin(angle/2)
  const double sine = length(axis);
  if (sine == 0.0) return dvec3(0);
  return axis * (2.0 * std::atan2(sine, turn.w) / (sine * dt));
}

// The object's box over the tick: from its previous pose to the current one. Between them a point is off the line that
// joins its places by at most the sagitta of its arc.
Box swept_box(const Mesh& mesh, const ObjectState& object, const MovingPose& moving) {
  Box swept = touch_box(mesh, moving.previous);
  swept.add(object.world_box.min);
  swept.add(object.world_box.max);
  const double half = 0.5 * std::min(length(moving.angular_velocity) * moving.dt, std::numbers::pi);
  const vec3 farthest = glm::max(glm::abs(mesh.box.min), glm::abs(mesh.box.max));
  const vec3 sagitta(static_cast<float>((1 - std::cos(half)) * double{length(farthest)}));
  swept.min -= sagitta;
  swept.max += sagitta;
  return swept;
}

// A touchable node's scale is in its mesh and does not change.
void place_object(World& world, const MovingNode& node, double dt) {
  Pose& pose = world.registry.get<Pose>(node.entity);
  MovingPose& moving = world.registry.get<MovingPose>(node.entity);
  const Pose now = rigid_part(node.world);
  if (node.jumped) {
    moving = {now, dvec3(0), dvec3(0), dt};
  } else {
    moving.dt = dt;
    moving.previous = pose;
    moving.velocity = (now.position - pose.position) / dt;
    moving.angular_velocity = angular_velocity(pose.rotation, now.rotation, dt);
  }
  pose = now;
  if (node.object < 0) return;
  ObjectState& object = world.touch->objects[static_cast<std::size_t>(node.object)];
  if (object.world_box.empty()) return;  // the object is removed
  const Mesh& mesh = world.meshes[world.registry.get<Deformable>(node.entity).mesh];
  object.world_box = touch_box(mesh, pose);
  world.touch->object_boxes.move(static_cast<std::uint32_t>(node.object), swept_box(mesh, object, moving));
}

bool carries_something(const Registry& registry, Entity entity) {
  return registry.has<Deformable>(entity) || registry.has<Drawable>(entity) || registry.has<Effect>(entity);
}

}  // namespace

std::vector<MovingNode> find_moving(World& world, const TouchState& touch) {
  Registry& registry = world.registry;
  const std::vector<Hierarchy::Link>& order = world.hierarchy.order();
  std::vector<dmat4> to_world(order.size());
  std::vector<bool> moves(order.size(), false), carries(order.size(), false);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t parent = static_cast<std::size_t>(order[i].parent);
    const LocalTransform* local = registry.find<LocalTransform>(order[i].entity);
    to_world[i] =
        (order[i].parent < 0 ? dmat4(1) : to_world[parent]) * local_frame(local ? *local : LocalTransform{}).matrix();
    moves[i] = registry.has<Kinematic>(order[i].entity) || (order[i].parent >= 0 && moves[parent]);
  }
  for (std::size_t i = order.size(); i-- > 0;) {
    if (carries_something(registry, order[i].entity)) carries[i] = true;
    if (carries[i] && order[i].parent >= 0) carries[static_cast<std::size_t>(order[i].parent)] = true;
  }

  std::vector<MovingNode> found;
  std::vector<std::int32_t> row(order.size(), -1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!moves[i] || !carries[i]) continue;
    MovingNode node;
    node.entity = order[i].entity;
    if (order[i].parent >= 0) {
      const std::size_t parent = static_cast<std::size_t>(order[i].parent);
      node.parent = row[parent];
      if (node.parent < 0) node.above = to_world[parent];
    }
    if (const LocalTransform* local = registry.find<LocalTransform>(node.entity)) node.rest = *local;
    if (const Kinematic* kinematic = registry.find<Kinematic>(node.entity)) node.motion = kinematic->motion;
    node.drawn = registry.has<Drawable>(node.entity);
    for (std::size_t o = 0; o < touch.objects.size(); ++o)
      if (touch.objects[o].entity == node.entity) node.object = static_cast<std::int32_t>(o);
    node.world = to_world[i];
    row[i] = static_cast<std::int32_t>(found.size());
    found.push_back(node);
  }
  for (const MovingNode& node : found) {
    const Pose* pose = registry.find<Pose>(node.entity);
    if (pose && !registry.has<MovingPose>(node.entity)) registry.add<MovingPose>(node.entity, {*pose});
  }
  return found;
}

std::vector<double> key_times(const World& world, const std::vector<MovingNode>& nodes) {
  std::vector<double> times;
  for (const MovingNode& node : nodes) {
    if (!node.motion.valid()) continue;
    const PrescribedMotion& motion = world.motions[node.motion];
    if (!(motion.speed > 0)) continue;
    for (const Track* track : {&motion.translation, &motion.rotation})
      for (const double time : track->times)  // just before the last key, where a motion that repeats begins again
        times.push_back((time - 1e-9 * track->length) / motion.speed);
  }
  std::sort(times.begin(), times.end());
  const auto same = [](double a, double b) { return b - a < 1e-8 * (1 + std::abs(b)); };
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
  return times;
}

void place_at(World& world, TouchState& touch, std::vector<MovingNode> nodes, double time) {
  for (MovingNode& node : nodes) {
    const LocalFrame local =
        node.motion.valid() ? sample_motion(world.motions[node.motion], node.rest, time) : local_frame(node.rest);
    node.world = (node.parent < 0 ? node.above : nodes[static_cast<std::size_t>(node.parent)].world) * local.matrix();
    if (node.object < 0) continue;
    world.registry.get<Pose>(node.entity) = rigid_part(node.world);
    renew_box(world, touch, static_cast<std::uint32_t>(node.object));
  }
}

void move_objects(World& world, Tick tick) {
  std::vector<MovingNode>& nodes = world.touch->moving;
  for (MovingNode& node : nodes) {
    const MovingNode* parent = node.parent < 0 ? nullptr : &nodes[static_cast<std::size_t>(node.parent)];
    LocalFrame local = local_frame(node.rest);
    node.jumped = !node.placed || (parent && parent->jumped);
    if (node.motion.valid()) {
      const PrescribedMotion& motion = world.motions[node.motion];
      local = sample_motion(motion, node.rest, tick.time);
      node.jumped = node.jumped || jumps_between(motion, node.time, tick.time);
    }
    node.world = (parent ? parent->world : node.above) * local.matrix();
    node.placed = true;
    node.time = tick.time;
    if (world.registry.has<Pose>(node.entity))
      place_object(world, node, tick.elapsed());
    else if (WorldTransform* transform = world.registry.find<WorldTransform>(node.entity))
      transform->matrix = mat4(node.world);
  }
  for (const MovingNode& node : nodes)
    if (node.object >= 0) move_seams(world, *world.touch, static_cast<std::uint32_t>(node.object));
}

std::vector<MovedSnapshot> moved_snapshots(const World& world, const TouchState& touch) {
  std::vector<MovedSnapshot> moved;
  for (const MovingNode& node : touch.moving)
    if (node.drawn) moved.push_back({node.entity, mat4(node.world)});
  for (const ObjectState& object : touch.objects) {  // a program may place it elsewhere
    const auto listed = std::any_of(moved.begin(), moved.end(),
                                    [&](const MovedSnapshot& other) { return other.object == object.entity; });
    if (!listed && world.registry.has<Drawable>(object.entity)) moved.push_back({object.entity, mat4(1)});
  }
  for (MovedSnapshot& object : moved)
    if (const Pose* pose = world.registry.find<Pose>(object.object)) object.to_world = pose->matrix();
  return moved;
}

void publish_moved(const World& world, Snapshot& snapshot) {
  for (MovedSnapshot& object : snapshot.moved) {
    if (const Pose* pose = world.registry.find<Pose>(object.object))
      object.to_world = pose->matrix();
    else
      object.to_world = world.registry.get<WorldTransform>(object.object).matrix;
  }
}

}  // namespace pliant
