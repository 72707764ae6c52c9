#include "content/level/tissue_cavities.h"

#include <fmt/format.h>

#include "content/level/tissue_materials.h"
#include "content/tets/lattice_inside.h"
#include "content/tets/tet_hollows.h"

namespace pliant {
namespace {

constexpr const char* kCavitiesKey = "PLIANT_soft_body/cavities";

// Whether most of a wall's corners lie in a closed mesh.
bool lies_in(const std::vector<uvec3>& wall, const TetMesh& mesh, const Inside& inside) {
  std::size_t in = 0;
  for (const uvec3& t : wall) in += inside(mesh.nodes[t.x]);
  return 2 * in > wall.size();
}

}  // namespace

Status set_cavities(const Level& level, const LevelNode& node, const dmat4& to_object, const std::vector<dmat4>& world,
                    SoftParts& parts) {
  const std::vector<Cavity>& wanted = node.soft_body->cavities;
  if (wanted.empty()) return Done{};
  TetMesh& mesh = parts.tets;
  std::vector<std::vector<uvec3>> walls = hollows_of(mesh);
  if (walls.empty())
    return Error{kCavitiesKey, "asks for a pressure, and the tissue has no closed hollow",
                 "give its mesh a closed inner surface, with `fill` `wall` if its wall is thin"};
  for (const bool named : {true, false})  // "" takes the remaining ones
    for (const Cavity& cavity : wanted) {
      if (cavity.name.empty() == named) continue;
      const std::size_t before = mesh.cavities.size();
      std::optional<BuiltMesh> around;
      if (named) {
        Result<std::optional<BuiltMesh>> found = mesh_in_body(cavity.name, level, to_object, world);
        if (!found) return found.error();
        around = std::move(*found);
        if (!around)
          return Error{kCavitiesKey, fmt::format("names `{}`, which is no node with a mesh", cavity.name),
                       "name a node whose closed mesh encloses the hollow, or leave out `name`"};
      }
      const std::optional<Inside> inside = around ? std::optional<Inside>(std::in_place, around->mesh) : std::nullopt;
      std::erase_if(walls, [&](std::vector<uvec3>& wall) {
        if (inside && !lies_in(wall, mesh, *inside)) return false;
        mesh.cavities.push_back({std::move(wall), cavity.pressure, cavity.bulk});
        return true;
      });
      if (mesh.cavities.size() == before)
        return Error{kCavitiesKey,
                     named ? fmt::format("names `{}`, which encloses no hollow of the tissue", cavity.name)
                           : std::string("has an item without a name, and no hollow remains for it"),
                     named ? "move it around the hollow, or leave out `name`" : "leave it out"};
    }
  return Done{};
}

}  // namespace pliant
