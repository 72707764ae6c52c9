#include "systems/touch/collide/seam_entry.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "systems/touch/collide/seams.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {

bool bears_between(const ContactSearch& s, const Foot& foot, dvec3 x) {
  const Seam* const seam = seam_at(s.object, foot);
  if (!seam) return false;
  const Registry& registry = s.world.registry;
  const ObjectState& other = s.world.touch->objects[seam->object];
  const Mesh& mesh = s.world.meshes[registry.get<Deformable>(other.entity).mesh];
  const Pose &own = registry.get<Pose>(s.object.entity), &pose = registry.get<Pose>(other.entity);
  const dvec3 there = &other == &s.object ? x : pose.to_local(own.to_world(x));
  const Foot far = descend(mesh, seam->triangle, closest_on_triangle(mesh, seam->triangle, there).barycentric, there,
                           true, other.closed);
  if (!seam_at(other, far)) return false;
  if (&other != &s.object) return &s.object < &other;
  return std::tie(foot.p.x, foot.p.y, foot.p.z) <= std::tie(far.p.x, far.p.y, far.p.z);
}

std::optional<SeamEntry> seam_entry(const ContactSearch& s, dvec3 from, dvec3 to) {
  std::optional<SeamEntry> first;
  double earliest = 2.0;
  const double wide = crack_of(s.mesh);
  Box way;
  way.add(vec3(from));
  way.add(vec3(to));
  s.object.found.boxes.visit(way, [&](std::uint32_t i) {
    const std::uint32_t key = s.object.found.seams[i].edge, t = key / 3, e = key % 3;
    if (!std::binary_search(s.object.closed.begin(), s.object.closed.end(), key)) return;
    const uvec3 corner = s.mesh.triangles[t];
    const dvec3 a(s.mesh.position(corner[static_cast<int>(e)])),
        along = dvec3(s.mesh.position(corner[static_cast<int>((e + 1) % 3)])) - a,
        outward = normalize(cross(along, dvec3(s.mesh.position(corner[static_cast<int>((e + 2) % 3)])) - a));
    const double above = dot(from - a, outward), below = dot(to - a, outward);
    if (above < 0 || below >= 0) return;
    const double fraction = above / (above - below);
    const dvec3 x = from + fraction * (to - from);
    const double share = std::clamp(dot(x - a, along) / dot(along, along), 0.0, 1.0);
    if (fraction >= earliest || length(x - a - share * along) > wide) return;
    dvec3 barycentric(0);
    barycentric[static_cast<int>(e)] = 1 - share;
    barycentric[static_cast<int>((e + 1) % 3)] = share;
    if (!bears_between(s, s.downhill(t, barycentric, x), x)) return;
    earliest = fraction;
    first = {t, barycentric, x, outward};
  });
  return first;
}

}  // namespace pliant
