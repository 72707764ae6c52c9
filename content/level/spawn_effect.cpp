#include "content/level/spawn_effect.h"

#include <fmt/format.h>

#include <cmath>

#include "content/files/file_io.h"
#include "content/level/node_error.h"

namespace pliant {
namespace {

constexpr std::size_t kMostRows = 100000;  // of a path that guides
constexpr double kFarthestPoint = 1e6;     // [m] of its points, each coordinate

// `name` of the file or program.
Status check_points(const SpawnState& state, std::size_t n, const Path& points, const std::string& name) {
  if (points.rows.size() > kMostRows)
    return state.at(n, fmt::format("is guided by {}, which has {} rows", name, points.rows.size()),
                    fmt::format("reduce it to {}", kMostRows));
  bool differ = false;
  for (const PathRow& row : points.rows) {
    const dvec3 far = glm::abs(row.position);
    if (!(far.x <= kFarthestPoint && far.y <= kFarthestPoint && far.z <= kFarthestPoint))
      return state.at(n, fmt::format("is guided by {}, which has a point beyond {:g} m", name, kFarthestPoint),
                      "correct it");
    differ = differ || row.position != points.rows.front().position;
  }
  if (!differ)
    return state.at(n, fmt::format("is guided by {}, which is a single point", name),
                    "give it two different points, or use the kind attraction");
  return Done{};
}

Result<Handle<Path>> read_points(SpawnState& state, std::size_t n) {
  const std::string& file = state.level.nodes[n].effect->path;
  const Path* points = &state.level.nodes[n].effect_path;
  if (points->rows.empty()) {
    if (file.empty()) return state.at(n, "is an effect of the kind guidance without a `path`", "name a CSV file");
    const Result<std::filesystem::path> path = confined_path(state.folder, file);
    if (!path) return node_error_around(state.level, n, path.error());
    const Result<const Path*> read = state.scripts.read(*path, true);
    if (!read) return node_error_around(state.level, n, read.error());
    points = *read;
  }
  const std::string name = points == &state.level.nodes[n].effect_path ? "a path" : file.substr(0, 100);
  if (Status s = check_points(state, n, *points, name); !s) return s.error();
  return state.world.paths.add(*points);
}

}  // namespace

Status add_effect(SpawnState& state, std::size_t n) {
  const LevelNode& node = state.level.nodes[n];
  if (node.soft_body || node.rigid_body || node.handle)
    return state.at(n, "has PLIANT_effect and is a soft or rigid body, which is not supported",
                    "put the effect on a node of its own");
  Effect effect = *node.effect;
  if (effect.region == EffectRegion::kBox && effect.box.empty() && reads_key(effect.kind, "region"))
    return state.at(n, "is an effect in the region box without a `box`", "give one, or choose another region");
  if (effect.kind == EffectKind::kForbidden && effect.region == EffectRegion::kEverywhere)
    return state.at(n, "forbids the region everywhere, so that no probe could be anywhere",
                    "choose sphere, box or half_space");
  if (effect.kind == EffectKind::kGuidance) {
    const Result<Handle<Path>> points = read_points(state, n);
    if (!points) return points.error();
    effect.points = *points;
  }
  Registry& registry = state.world.registry;
  const Entity entity = state.entities[n];
  registry.add<Effect>(entity, effect);
  if (!registry.has<Pose>(entity)) registry.add<Pose>(entity, rigid_part(state.motions.world[n]));
  return Done{};
}

}  // namespace pliant
