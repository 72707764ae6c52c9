#include "content/level/spawn_carried.h"

#include <fmt/format.h>

#include "components/soft_body.h"
#include "content/level/carried_parts.h"

namespace pliant {
namespace {

constexpr double kDentDepth = 1.5;  // [1] of a surface's reach: depth up to which a dent moves carried parts below it

// Rebuilds the part's mesh in the frame of its carrier.
Status carry_part(SpawnState& state, std::size_t by, std::size_t part, const dmat4& to_object) {
  World& world = state.world;
  const LevelNode& node = state.level.nodes[part];
  const LevelMesh& mesh = state.level.meshes[static_cast<std::size_t>(node.mesh)];
  if (Status s = state.count_triangles(part, state.budget.of(node.mesh).triangles); !s) return s;
  Result<BuiltMesh> built =
      build_mesh(node.name, mesh.primitives, mat4(to_object * state.motions.world[part]), {0.0, {}, false});
  if (!built) return state.at(part, built.error().message());
  const Entity entity = state.entities[part], carrier = state.entities[by];
  Carried carried{carrier, {}, {}};
  if (const SoftBody* const soft = world.registry.find<SoftBody>(carrier)) {
    TetMesh& tets = world.tet_meshes[soft->tets];
    CarriedPart& to = tets.parts.emplace_back();
    to.entity = entity;
    embed_part(built->mesh, tets, to);
    carried.mesh = to.mesh = world.meshes.add(std::move(built->mesh));
  } else {
    const Deformable& surface = world.registry.get<Deformable>(carrier);
    carried.mesh = surface.mesh;
    carried.share = dent_shares(built->draw, world.meshes[surface.mesh], kDentDepth * surface.reach);
  }
  world.registry.add<Carried>(entity, std::move(carried));
  world.registry.get<Drawable>(entity).mesh = world.draw_meshes.add(std::move(built->draw));
  const Pose pose = rigid_part(state.motions.world[by]);
  if (Pose* const its = world.registry.find<Pose>(entity))
    *its = pose;
  else
    world.registry.add<Pose>(entity, pose);
  return Done{};
}

Status carry_parts_of(SpawnState& state, std::size_t n) {
  World& world = state.world;
  const LevelNode& node = state.level.nodes[n];
  if (!node.in_scene) return Done{};
  const SoftBody* const soft = world.registry.find<SoftBody>(state.entities[n]);
  const Deformable* const surface = world.registry.find<Deformable>(state.entities[n]);
  const bool carries = soft ? soft->carries == Carries::kInside : surface && surface->carries == Carries::kInside;
  if (!soft && !carries) return Done{};  // a dent is local: parts that stay need no note
  const Mesh& mesh = world.meshes[soft ? soft->collision_mesh : surface->mesh];
  const dmat4 to_object = world_to(rigid_part(state.motions.world[n]));
  std::vector<std::int32_t> parts =
      find_parts(state.level, static_cast<std::int32_t>(n), mesh, to_object, soft ? soft->fill : Fill::kSolid);
  std::erase_if(parts, [&](std::int32_t part) {
    const auto p = static_cast<std::size_t>(part);
    return state.motions.moves[p] || !world.registry.has<Drawable>(state.entities[p]) ||
           world.registry.has<Carried>(state.entities[p]);
  });
  if (parts.empty()) return Done{};
  if (!carries) {
    std::string finding = fmt::format(
        "leaves behind what lies inside of it and is only drawn ({}); set `carries` to "
        "`inside`, and it goes along",
        names_of(state.level, parts));
    state.notes.push_back("`" + node.name + "`: " + finding);
    world.tet_meshes[soft->tets].report.findings.push_back(std::move(finding));
    return Done{};
  }
  for (const std::int32_t part : parts)
    if (Status s = carry_part(state, n, static_cast<std::size_t>(part), to_object); !s) return s;
  return Done{};
}

}  // namespace

Status carry_parts(SpawnState& state) {
  for (std::size_t n = 0; n < state.level.nodes.size(); ++n)
    if (Status s = carry_parts_of(state, n); !s) return s;
  return Done{};
}

}  // namespace pliant
