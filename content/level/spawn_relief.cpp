#include "content/level/spawn_relief.h"

#include <fmt/format.h>

#include "content/mesh/relief_map.h"

namespace pliant {
namespace {

constexpr double kFadedRelief = 0.02;  // [1] share of the area from which on it is said
constexpr double kUnevenRelief = 1.5;  // [1] stretch from which on it is said

}  // namespace

void add_relief(World& world, std::vector<std::string>* notes) {
  for (auto [entity, deformable] : world.registry.view<const Deformable>()) {
    if (!(deformable.relief > 0.0)) continue;
    const Drawable* const drawn = world.registry.find<Drawable>(entity);
    Mesh& mesh = world.meshes[deformable.mesh];
    if (!drawn || mesh.relief) continue;
    const ReliefMaps found = relief_maps(mesh, world.draw_meshes[drawn->mesh], world.materials, world.images);
    mesh.relief = found.relief;
    if (!notes) continue;
    const Name* const name = world.registry.find<Name>(entity);
    const std::string its = name ? name->value : std::string();
    if (found.faded > kFadedRelief)
      notes->push_back(
          fmt::format("`{}`: its relief fades out towards the seams of its texture coordinates, on {:.0f} % of it; "
                      "fewer seams or smaller triangles there keep more",
                      its, 100 * found.faded));
    if (found.uneven > kUnevenRelief)
      notes->push_back(
          fmt::format("`{0}`: its texture coordinates stretch up to {1:.1f} times their mean, and its relief is felt "
                      "{1:.1f} times as flat there as a normal map draws it; unwrap it more evenly",
                      its, found.uneven));
  }
}

}  // namespace pliant
