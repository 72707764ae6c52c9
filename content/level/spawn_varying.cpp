#include "content/level/spawn_varying.h"

#include <fmt/format.h>

#include <algorithm>

#include "components/varying.h"
#include "content/level/varying_keys.h"

namespace pliant {
namespace {

bool is_painted(const Mesh& mesh) {
  return !mesh.stiffness_factor.empty() || !mesh.damping_factor.empty() || !mesh.relaxation_factor.empty();
}

Status check_key(const SpawnState& state, std::size_t n, const Deformable& deformable, const std::string& key) {
  if (key == "stiffness" && deformable.young > 0.0)
    return state.at(n, "has an animated `stiffness` and `young`, from which it follows", "remove one of them");
  const VaryingKey& its = *find_varying_key(key);
  const bool moves = std::any_of(its.members.begin(), its.members.end(),
                                 [&](const auto member) { return moves_field(deformable, member); });
  if (moves && is_painted(state.world.meshes[deformable.mesh]))
    return state.at(n,
                    fmt::format("has an animated `{}`, which is painted on this surface and read when it opens", key),
                    "remove the paint or the channel");
  return Done{};
}

}  // namespace

Status add_varying(SpawnState& state, std::size_t n) {
  const NodeMotion asked = state.level.nodes[n].motion.value_or(NodeMotion{});
  const Entity entity = state.entities[n];
  Deformable& deformable = state.world.registry.get<Deformable>(entity);
  Varying varying;
  varying.repeats = asked.repeat;
  varying.speed = asked.speed;
  bool twice = false;
  for (const LevelAnimation& animation : state.level.animations) {
    if (!asked.animation.empty() && animation.name != asked.animation) continue;
    for (const LevelChannel& channel : animation.channels) {
      if (channel.property != NodeProperty::kKey || channel.node != static_cast<std::int32_t>(n)) continue;
      if (find_varying_key(channel.key)->of_joint()) continue;
      if (Status s = check_key(state, n, deformable, channel.key); !s) return s;
      const VaryingKey& key = *find_varying_key(channel.key);
      for (const auto member : key.members) {
        const auto same = [&](const ParameterTrack& other) { return other.member == member; };
        if (std::any_of(varying.tracks.begin(), varying.tracks.end(), same))
          twice = true;
        else
          varying.tracks.push_back({member, key.range, channel.track});
      }
      if (channel.key == "contact_damping") deformable.contact_damping_material = false;
    }
  }
  if (varying.tracks.empty()) return Done{};
  if (twice)
    state.notes.push_back("node `" + state.level.nodes[n].name + "` " +
                          sentence_of("has a key that several channels vary: the first counts", "keep one of them"));
  vary(varying, 0.0, deformable);
  state.world.registry.add<Varying>(entity, std::move(varying));
  return Done{};
}

}  // namespace pliant
