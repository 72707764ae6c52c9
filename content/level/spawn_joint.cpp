#include "content/level/spawn_joint.h"

#include "components/soft_body.h"

namespace pliant {
namespace {

bool is_body(const LevelNode& node) {
  return node.in_scene && (node.soft_body || node.rigid_body);
}

Result<Entity> body_of(const SpawnState& state, std::size_t n, const std::string& name) {
  if (name.empty()) return kNoEntity;
  for (std::size_t i = 0; i < state.level.nodes.size(); ++i)
    if (state.level.nodes[i].name == name && is_body(state.level.nodes[i])) return state.entities[i];
  return state.at(n, "joins `" + name.substr(0, 100) + "`, which is no soft or rigid body of the scene",
                  "name one, or remove the joint");
}

// The tool or probe of its grip.
Result<Entity> hand_of(const SpawnState& state, std::size_t n, const std::string& name) {
  if (name.empty()) return kNoEntity;
  for (std::size_t i = 0; i < state.level.nodes.size(); ++i) {
    const LevelNode& node = state.level.nodes[i];
    if (node.in_scene && node.name == name && (node.handle || node.probe)) return state.entities[i];
  }
  return state.at(n, "is driven by the grip of `" + name.substr(0, 100) + "`, which is no tool or probe of the scene",
                  "name one, or remove `grip`");
}

// An animation of its `rest`.
void add_target(const SpawnState& state, std::size_t n, Joint& joint) {
  const NodeMotion asked = state.level.nodes[n].motion.value_or(NodeMotion{});
  joint.repeats = asked.repeat, joint.speed = asked.speed;
  for (const LevelAnimation& animation : state.level.animations) {
    if (!asked.animation.empty() && animation.name != asked.animation) continue;
    for (const LevelChannel& channel : animation.channels)
      if (channel.property == NodeProperty::kKey && channel.node == static_cast<std::int32_t>(n) &&
          channel.key == "rest" && joint.target.empty())
        joint.target = channel.track;
  }
}

}  // namespace

Status add_joints(SpawnState& state) {
  Registry& registry = state.world.registry;
  for (std::size_t n = 0; n < state.level.nodes.size(); ++n) {
    const LevelNode& node = state.level.nodes[n];
    if (!node.joint || !node.in_scene) continue;
    Joint joint = *node.joint;
    if (joint.a.empty())
      return state.at(n, Note{"is a joint without `a`, so it holds no body", "name one", "key.missing", "a"});
    const Result<Entity> a = body_of(state, n, joint.a), b = body_of(state, n, joint.b);
    if (!a) return a.error();
    if (!b) return b.error();
    const Result<Entity> hand = hand_of(state, n, joint.grip);
    if (!hand) return hand.error();
    joint.body_a = *a, joint.body_b = *b, joint.hand = *hand;
    add_target(state, n, joint);
    const Entity entity = state.entities[n];
    registry.add<Joint>(entity, joint);
    if (!registry.has<Pose>(entity)) registry.add<Pose>(entity, rigid_part(state.motions.world[n]));
  }
  return Done{};
}

}  // namespace pliant
