#include "systems/touch/collide/seams.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

constexpr double kOff = 0.3;         // [1] of the search distance: largest distance of the other surface from there
constexpr double kAlongSeam = 0.76;  // [1] cosine of 40 degrees: largest angle between the two surfaces

struct SeamPlace {
  dvec3 p, normal;  // world
};

dvec3 facet_normal(const Mesh& mesh, std::uint32_t t) {
  const uvec3 c = mesh.triangles[t];
  const dvec3 a(mesh.position(c.x));
  return normalize(cross(dvec3(mesh.position(c.y)) - a, dvec3(mesh.position(c.z)) - a));
}

// The triangle of `mesh` that passes within `within` of p and faces like p's surface, or kBorder. `self`: the triangle
// of p, if the mesh is the same.
std::uint32_t goes_on(const Mesh& mesh, const Pose& pose, const SeamPlace& at, double within, std::uint32_t self) {
  const dvec3 x = pose.to_local(at.p), n = glm::conjugate(pose.rotation) * at.normal;
  std::uint32_t found = kBorder;
  double nearest = within;
  visit_near(
      mesh, x, [&] { return nearest; },
      [&](std::uint32_t t) {
        if (t == self) return;
        const double d = std::sqrt(closest_on_triangle(mesh, t, x).distance2);
        if (d > nearest || dot(facet_normal(mesh, t), n) < kAlongSeam) return;
        nearest = d;
        found = t;
      });
  return found;
}

// A dent continues in both directions, wherever a foot may, over all connected seams.
void join_zones(TouchState& touch) {
  for (std::uint32_t i = 0; i < touch.objects.size(); ++i)
    for (const SeamZones& seam : std::vector<SeamZones>(touch.objects[i].seam_zones))
      touch.objects[seam.object].seam_zones.push_back({seam.other, i, seam.zone});
  for (ObjectState& object : touch.objects) {
    for (auto* list : {&object.cracks, &object.seam_zones}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
  }
  for (std::uint32_t i = 0; i < touch.objects.size(); ++i) {
    std::vector<std::uint32_t>& joined = touch.objects[i].joined;
    const auto add = [&](const ObjectState& from) {
      for (const SeamZones& seam : from.seam_zones)
        if (seam.object != i && std::find(joined.begin(), joined.end(), seam.object) == joined.end())
          joined.push_back(seam.object);
    };
    add(touch.objects[i]);
    for (std::size_t k = 0; k < joined.size(); ++k) add(touch.objects[joined[k]]);
  }
}

}  // namespace

const Seam* seam_at(const ObjectState& object, const Foot& foot) {
  if (object.seams.empty() || foot.place == FootPlace::kInside || !foot.at_border) return nullptr;
  const auto find = [&](std::uint32_t key) -> const Seam* {
    const auto at = std::lower_bound(object.seams.begin(), object.seams.end(), key,
                                     [](const Seam& seam, std::uint32_t edge) { return seam.edge < edge; });
    return at != object.seams.end() && at->edge == key ? &*at : nullptr;
  };
  for (std::uint32_t e = 0; e < 3; ++e)  // of the edges under the foot
    if (foot.barycentric[static_cast<int>((e + 2) % 3)] < 1e-9)
      if (const Seam* seam = find(3 * foot.triangle + e)) return seam;
  return nullptr;
}

bool at_seam(const ObjectState& object, const Foot& foot) {
  if (object.closed.empty() || foot.place == FootPlace::kInside || !foot.at_border) return false;
  for (std::uint32_t e = 0; e < 3; ++e)
    if (foot.barycentric[static_cast<int>((e + 2) % 3)] < 1e-9 &&
        std::binary_search(object.closed.begin(), object.closed.end(), 3 * foot.triangle + e))
      return true;
  return false;
}

void find_seams(const World& world, TouchState& touch) {
  const Registry& registry = world.registry;
  for (std::uint32_t i = 0; i < touch.objects.size(); ++i) {
    ObjectState& object = touch.objects[i];
    const Mesh& mesh = world.meshes[registry.get<Deformable>(object.entity).mesh];
    const Pose& pose = registry.get<Pose>(object.entity);
    const double crack = kCrack * static_cast<double>(mesh.mean_edge);  // search distance beyond an edge
    const bool moves = registry.has<MovingPose>(object.entity);
    Box around = object.world_box;
    around.min -= vec3(static_cast<float>(2 * crack));
    around.max += vec3(static_cast<float>(2 * crack));
    std::vector<std::uint32_t> others;
    touch.object_boxes.visit(around, [&](std::uint32_t j) {
      if (j == i || (!moves && !registry.has<MovingPose>(touch.objects[j].entity))) others.push_back(j);
    });
    std::sort(others.begin(), others.end());
    const bool alone = others.size() == 1;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (int edge = 0; edge < 3; ++edge) {
        const bool border = mesh.across[t][edge] == kBorder;
        if (!border && (alone || !mesh.is_crease(t, edge))) continue;
        const uvec3 c = mesh.triangles[t];
        const dvec3 a(mesh.position(c[edge])), b(mesh.position(c[(edge + 1) % 3])), n = facet_normal(mesh, t);
        const SeamPlace at{pose.to_world(0.5 * (a + b) + crack * normalize(cross(b - a, n))), pose.rotation * n};
        for (const std::uint32_t j : others) {
          if (j == i && !border) continue;
          const Box& box = touch.objects[j].world_box;
          const vec3 p(at.p);
          const vec3 out = glm::max(glm::max(box.min - p, p - box.max), vec3(0));
          if (length(out) > static_cast<float>(2 * crack)) continue;
          const Mesh& other = world.meshes[registry.get<Deformable>(touch.objects[j].entity).mesh];
          const std::uint32_t on =
              goes_on(other, registry.get<Pose>(touch.objects[j].entity), at, kOff * crack, j == i ? t : kBorder);
          if (on == kBorder) continue;
          object.seams.push_back({3 * t + static_cast<std::uint32_t>(edge), j, on});
          break;
        }
      }
    }
    // Feet stop at these edges from both sides: a wall covered by another surface is ignored.
    for (const Seam& seam : object.seams) {
      object.closed.push_back(seam.edge);
      const std::uint32_t t = seam.edge / 3, next = mesh.across[t][static_cast<int>(seam.edge % 3)];
      if (next == kBorder) continue;
      for (std::uint32_t e = 0; e < 3; ++e)
        if (mesh.across[next][static_cast<int>(e)] == t) object.closed.push_back(3 * next + e);
    }
    for (const Seam& seam : object.seams)
      if (std::find(object.neighbours.begin(), object.neighbours.end(), seam.object) == object.neighbours.end())
        object.neighbours.push_back(seam.object);
    for (const Seam& seam : object.seams) {
      const uvec3 here = mesh.triangles[seam.edge / 3];
      const Mesh& other = world.meshes[registry.get<Deformable>(touch.objects[seam.object].entity).mesh];
      const uvec3 there = other.triangles[seam.triangle];
      auto& list = seam.object == i ? object.cracks : object.seam_zones;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) list.push_back({here[k] / kZoneSize, seam.object, there[l] / kZoneSize});
    }
    std::sort(object.closed.begin(), object.closed.end());
    object.closed.erase(std::unique(object.closed.begin(), object.closed.end()), object.closed.end());
  }
  join_zones(touch);
}

}  // namespace pliant
