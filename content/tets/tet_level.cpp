#include "content/tets/tet_level.h"

#include <fmt/format.h>

#include "content/tets/tet_boundary.h"
#include "content/tets/tet_file.h"

namespace pliant {

Result<Level> import_tets(const std::filesystem::path& path) {
  Result<TetFile> file = load_tets(path);
  if (!file) return file.error();
  Level level;
  level.notes = std::move(file->notes);
  level.notes.push_back(
      fmt::format("the mesh is the boundary of {} tetrahedra; as tissue, name the file in PLIANT_soft_body/mesh",
                  file->tets.size()));
  // Only boundary nodes, in their order.
  constexpr std::uint32_t kInside = 0xffffffffu;
  const std::vector<uvec3> triangles = boundary_triangles(file->tets);
  std::vector<std::uint32_t> number(file->nodes.size(), kInside);
  for (const uvec3& t : triangles) number[t.x] = number[t.y] = number[t.z] = 0;
  Primitive boundary;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] == kInside) continue;
    number[n] = static_cast<std::uint32_t>(boundary.position.size());
    boundary.position.emplace_back(file->nodes[n]);
  }
  for (const uvec3& t : triangles) boundary.index.insert(boundary.index.end(), {number[t.x], number[t.y], number[t.z]});
  const std::string name = path.stem().string();
  level.meshes.push_back({name, {std::move(boundary)}});
  LevelNode node;
  node.name = name;
  node.mesh = 0;
  level.nodes.push_back(std::move(node));
  return level;
}

}  // namespace pliant
