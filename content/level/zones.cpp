#include "content/level/zones.h"

namespace pliant {

void build_zones(Mesh& mesh) {
  const std::uint32_t zones = (mesh.vertex_count + kZoneSize - 1) / kZoneSize;
  mesh.zone_box.assign(zones, Box{});

  // Each triangle extends the boxes of its corners' zones; different zones become neighbours.
  std::vector<std::uint64_t> pairs;
  for (const uvec3& t : mesh.triangles) {
    Box box;
    for (int i = 0; i < 3; ++i) box.add(mesh.position(t[i]));
    const uvec3 zone = t / kZoneSize;
    mesh.zone_box[zone.x].add(box);
    if (zone.y != zone.x) mesh.zone_box[zone.y].add(box);
    if (zone.z != zone.x && zone.z != zone.y) mesh.zone_box[zone.z].add(box);
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t a = zone[i], b = zone[(i + 1) % 3];
      if (a == b) continue;
      pairs.push_back((a << 32) | b);
      pairs.push_back((b << 32) | a);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

  mesh.zone_neighbour_first.assign(zones + 1, 0);
  mesh.zone_neighbours.clear();
  mesh.zone_neighbours.reserve(pairs.size());
  for (const std::uint64_t pair : pairs) {
    ++mesh.zone_neighbour_first[(pair >> 32) + 1];
    mesh.zone_neighbours.push_back(static_cast<std::uint32_t>(pair));
  }
  for (std::uint32_t z = 0; z < zones; ++z) mesh.zone_neighbour_first[z + 1] += mesh.zone_neighbour_first[z];
}

}  // namespace pliant
