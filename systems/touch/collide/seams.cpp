#include "systems/touch/collide/seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "systems/touch/collide/inner_walls.h"
#include "systems/touch/collide/triangle_tree.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

constexpr double kOnSeam = 1e-6;     // [1] a foot with a smaller barycentric coordinate is on that edge
constexpr double kOff = 0.3;         // [1] of the search distance: largest distance of the other surface from there
constexpr double kAlongSeam = 0.76;  // [1] cosine of 40 degrees: largest angle between the two surfaces

struct SeamPlace {
  dvec3 p, normal;  // world
};

// The triangle of `mesh` that passes within `within` of p, faces like p's surface and satisfies `may_be`, or kBorder.
template <class MayBe>
std::uint32_t goes_on(const Mesh& mesh, const Pose& pose, const SeamPlace& at, double within, MayBe may_be) {
  const dvec3 x = pose.to_local(at.p), n = glm::conjugate(pose.rotation) * at.normal;
  std::uint32_t found = kBorder;
  double nearest = within;
  visit_near(
      mesh, x, [&] { return nearest; },
      [&](std::uint32_t t) {
        if (!may_be(t)) return;
        const double d = std::sqrt(closest_on_triangle(mesh, t, x).distance2);
        if (d > nearest || dot(facet_normal(mesh, t), n) < kAlongSeam) return;
        nearest = d;
        found = t;
      });
  return found;
}

bool is_closed(const TouchState& touch, std::uint32_t bond) {
  return bond == Seam::kCrack || !touch.bonds[bond].open;
}

// The lists of the seams that are closed now. Only the first call allocates: all are closed then.
void list_closed(const TouchState& touch, ObjectState& object) {
  object.seams.clear();
  object.closed.clear();
  object.inner_walls.clear();
  object.seam_zones.clear();
  object.neighbours.clear();
  for (const Seam& seam : object.found.seams) {
    if (!is_closed(touch, seam.bond)) continue;
    object.seams.push_back(seam);
    if (std::find(object.neighbours.begin(), object.neighbours.end(), seam.object) == object.neighbours.end())
      object.neighbours.push_back(seam.object);
  }
  for (const SeamsFound::ClosedEdge& edge : object.found.closed)
    if (is_closed(touch, edge.bond) && (object.closed.empty() || object.closed.back() != edge.edge))
      object.closed.push_back(edge.edge);
  for (const SeamsFound::InnerWall& wall : object.found.inner_walls)
    if (is_closed(touch, wall.bond) && (object.inner_walls.empty() || object.inner_walls.back() != wall.triangle))
      object.inner_walls.push_back(wall.triangle);
  for (const SeamsFound::Zones& zones : object.found.zones)
    if (is_closed(touch, zones.bond) && (object.seam_zones.empty() || object.seam_zones.back() != zones.zones))
      object.seam_zones.push_back(zones.zones);
}

// The objects that a dent reaches over all connected seams.
void list_joined(TouchState& touch, std::uint32_t slot) {
  std::vector<std::uint32_t>& joined = touch.objects[slot].joined;
  joined.clear();
  const auto add = [&](const ObjectState& from) {
    for (const std::uint32_t b : from.found.bonds) {
      const Bond& bond = touch.bonds[b];
      const std::uint32_t other = &touch.objects[bond.first] == &from ? bond.second : bond.first;
      if (!bond.open && other != slot && std::find(joined.begin(), joined.end(), other) == joined.end())
        joined.push_back(other);
    }
  };
  add(touch.objects[slot]);
  for (std::size_t k = 0; k < joined.size(); ++k) add(touch.objects[joined[k]]);
}

// How far the farthest corner of the box is from where it is at another pose. [m]
double farthest_move(const Box& box, const Pose& from, const Pose& to) {
  double farthest = 0;
  for (int i = 0; i < 8; ++i) {
    const dvec3 corner(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z);
    farthest = std::max(farthest, length(to.to_world(corner) - from.to_world(corner)));
  }
  return farthest;
}

Pose relative_pose(const World& world, const TouchState& touch, std::uint32_t first, std::uint32_t second) {
  return relative_pose(world.registry.get<Pose>(touch.objects[first].entity),
                       world.registry.get<Pose>(touch.objects[second].entity));
}

bool is_at(const World& world, const TouchState& touch, const Bond& bond) {
  const Pose now = relative_pose(world, touch, bond.first, bond.second);
  return farthest_move(touch_mesh(world, touch.objects[bond.second]).box, bond.relative, now) <= bond.slack;
}

// Index of the bond of two objects at their current relative pose, among the first `among`; Seam::kCrack if none.
std::uint32_t bond_of(const World& world, const TouchState& touch, std::uint32_t here, std::uint32_t there,
                      std::size_t among) {
  const std::uint32_t first = std::min(here, there), second = std::max(here, there);
  for (const std::uint32_t b : touch.objects[first].found.bonds)
    if (b < among && touch.bonds[b].second == second && is_at(world, touch, touch.bonds[b])) return b;
  return Seam::kCrack;
}

std::uint32_t add_bond(const World& world, TouchState& touch, std::uint32_t here, std::uint32_t there) {
  const std::uint32_t first = std::min(here, there), second = std::max(here, there);
  const auto bond = static_cast<std::uint32_t>(touch.bonds.size());
  const double slack = 0.5 * std::max(crack_of(touch_mesh(world, touch.objects[first])),
                                      crack_of(touch_mesh(world, touch.objects[second])));
  touch.bonds.push_back({first, second, relative_pose(world, touch, first, second), slack});
  touch.objects[first].found.bonds.push_back(bond);
  touch.objects[second].found.bonds.push_back(bond);
  return bond;
}

// The connected part of each triangle of a mesh, by number. Empty if all of it is connected.
std::vector<std::uint32_t> parts_of(const Mesh& mesh) {
  std::vector<std::uint32_t> part(mesh.triangles.size(), kBorder), stack;
  std::uint32_t count = 0;
  for (std::uint32_t first = 0; first < part.size(); ++first) {
    if (part[first] != kBorder) continue;
    part[first] = count;
    stack.push_back(first);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (int edge = 0; edge < 3; ++edge) {
        const std::uint32_t next = mesh.across[t][edge];
        if (next == kBorder || part[next] != kBorder) continue;
        part[next] = count;
        stack.push_back(next);
      }
    }
    ++count;
  }
  if (count < 2) part.clear();
  return part;
}

// Where surfaces pass an edge of an object at the current poses. `known`: number of bonds found at earlier poses.
void find_seams_of(const World& world, TouchState& touch, std::uint32_t i, std::size_t known, bool cracks) {
  const Registry& registry = world.registry;
  ObjectState& object = touch.objects[i];
  const Mesh& mesh = touch_mesh(world, object);
  const Pose& pose = registry.get<Pose>(object.entity);
  const double crack = 0.5 * crack_of(mesh);  // search distance beyond an edge
  Box around = object.world_box;
  around.min -= vec3(static_cast<float>(2 * crack));
  around.max += vec3(static_cast<float>(2 * crack));
  std::vector<std::uint32_t> others;
  touch.object_boxes.visit(around, [&](std::uint32_t j) {
    if (j == i ? cracks : bond_of(world, touch, i, j, known) == Seam::kCrack) others.push_back(j);
  });
  std::sort(others.begin(), others.end());
  const bool alone = others.empty() || (others.size() == 1 && others[0] == i);
  if (alone && !cracks) return;
  const std::vector<std::uint32_t> part = cracks ? parts_of(mesh) : std::vector<std::uint32_t>();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int edge = 0; edge < 3; ++edge) {
      const bool border = mesh.across[t][edge] == kBorder;
      if (!border && ((alone && part.empty()) || !mesh.is_crease(t, edge))) continue;
      const uvec3 c = mesh.triangles[t];
      const dvec3 a(mesh.position(c[edge])), b(mesh.position(c[(edge + 1) % 3])), n = facet_normal(mesh, t);
      const SeamPlace at{pose.to_world(0.5 * (a + b) + crack * normalize(cross(b - a, n))), pose.rotation * n};
      for (const std::uint32_t j : others) {
        if (j == i && !border && part.empty()) continue;
        const Box& box = touch.objects[j].world_box;
        const vec3 p(at.p);
        const vec3 out = glm::max(glm::max(box.min - p, p - box.max), vec3(0));
        if (length(out) > static_cast<float>(2 * crack)) continue;
        const std::uint32_t on =
            goes_on(touch_mesh(world, touch.objects[j]), registry.get<Pose>(touch.objects[j].entity), at, kOff * crack,
                    [&](std::uint32_t other) { return j != i || (border ? other != t : part[other] != part[t]); });
        if (on == kBorder) continue;
        std::uint32_t bond = Seam::kCrack;
        if (j != i) bond = bond_of(world, touch, i, j, touch.bonds.size());
        if (j != i && bond == Seam::kCrack) bond = add_bond(world, touch, i, j);
        object.found.seams.push_back({3 * t + static_cast<std::uint32_t>(edge), j, on, bond});
        break;
      }
    }
  }
}

// Of the seams' edges, as wide as a crack.
std::vector<Box> boxes_of(const Mesh& mesh, const std::vector<Seam>& seams) {
  std::vector<Box> boxes;
  const vec3 wide(static_cast<float>(crack_of(mesh)));
  for (const Seam& seam : seams) {
    const uvec3 corner = mesh.triangles[seam.edge / 3];
    Box box;
    for (const std::uint32_t k : {seam.edge % 3, (seam.edge + 1) % 3}) {
      box.add(mesh.position(corner[static_cast<int>(k)]) - wide);
      box.add(mesh.position(corner[static_cast<int>(k)]) + wide);
    }
    boxes.push_back(box);
  }
  return boxes;
}

template <class Value>
void sort_unique(std::vector<Value>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

// Feet stop at seams from both sides: a wall covered by another surface is ignored. Dents go over them from zone to
// zone, in both directions.
void find_closed_edges_and_zones(const World& world, TouchState& touch, std::uint32_t i) {
  ObjectState& object = touch.objects[i];
  const Mesh& mesh = touch_mesh(world, object);
  const auto ends = [&](std::uint32_t key) {
    const uvec3 corner = mesh.triangles[key / 3];
    const vec3 a = mesh.position(corner[static_cast<int>(key % 3)]),
               b = mesh.position(corner[static_cast<int>((key + 1) % 3)]);
    const std::array<float, 3> from{a.x, a.y, a.z}, to{b.x, b.y, b.z};
    return std::pair(std::min(from, to), std::max(from, to));
  };
  // Borders at the same place: where more than two triangles meet at an edge, it is a border of each.
  std::multimap<std::pair<std::array<float, 3>, std::array<float, 3>>, std::uint32_t> borders;
  if (!object.found.seams.empty())
    for (std::uint32_t key = 0; key < 3 * mesh.triangles.size(); ++key)
      if (mesh.across[key / 3][static_cast<int>(key % 3)] == kBorder) borders.emplace(ends(key), key);
  for (const Seam& seam : object.found.seams) {
    const auto [first, last] = borders.equal_range(ends(seam.edge));
    for (auto same = first; same != last; ++same) object.found.closed.push_back({same->second, seam.bond});
    object.found.closed.push_back({seam.edge, seam.bond});
    const std::uint32_t t = seam.edge / 3, next = mesh.across[t][static_cast<int>(seam.edge % 3)];
    if (next != kBorder)
      for (std::uint32_t e = 0; e < 3; ++e)
        if (mesh.across[next][static_cast<int>(e)] == t) object.found.closed.push_back({3 * next + e, seam.bond});
    const uvec3 here = mesh.triangles[t];
    const uvec3 there = touch_mesh(world, touch.objects[seam.object]).triangles[seam.triangle];
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) {
        const std::uint32_t zone = here[k] / kZoneSize, other = there[l] / kZoneSize;
        if (seam.object == i) {
          object.cracks.push_back({zone, i, other});
        } else {
          object.found.zones.push_back({{zone, seam.object, other}, seam.bond});
          touch.objects[seam.object].found.zones.push_back({{other, i, zone}, seam.bond});
        }
      }
  }
  sort_unique(object.found.closed);
  sort_unique(object.cracks);
}

}  // namespace

dvec3 facet_normal(const Mesh& mesh, std::uint32_t t) {
  const uvec3 c = mesh.triangles[t];
  const dvec3 a(mesh.position(c.x));
  return normalize(cross(dvec3(mesh.position(c.y)) - a, dvec3(mesh.position(c.z)) - a));
}

const Mesh& touch_mesh(const World& world, const ObjectState& object) {
  return world.meshes[world.registry.get<Deformable>(object.entity).mesh];
}

double crack_of(const Mesh& mesh) {
  constexpr double kMost = 0.2;  // [1] of the refined mesh's mean edge: its triangles resolve that
  return 2 * std::min(kCrack * static_cast<double>(mesh.file_edge), kMost * static_cast<double>(mesh.mean_edge));
}

Pose relative_pose(const Pose& first, const Pose& second) {
  const dquat back = glm::conjugate(first.rotation);
  return {back * (second.position - first.position), back * second.rotation};
}

std::array<const Seam*, 3> seams_at(const ObjectState& object, const Foot& foot) {
  std::array<const Seam*, 3> found{};
  if (object.seams.empty()) return found;
  for (std::uint32_t e = 0; e < 3; ++e) {
    if (!(foot.barycentric[static_cast<int>((e + 2) % 3)] < kOnSeam)) continue;
    const std::uint32_t key = 3 * foot.triangle + e;
    const auto at = std::lower_bound(object.seams.begin(), object.seams.end(), key,
                                     [](const Seam& seam, std::uint32_t edge) { return seam.edge < edge; });
    if (at != object.seams.end() && at->edge == key) found[e] = &*at;
  }
  return found;
}

bool at_seam(const ObjectState& object, const Foot& foot) {
  if (object.closed.empty()) return false;
  for (std::uint32_t e = 0; e < 3; ++e)
    if (foot.barycentric[static_cast<int>((e + 2) % 3)] < kOnSeam &&
        std::binary_search(object.closed.begin(), object.closed.end(), 3 * foot.triangle + e))
      return true;
  return false;
}

bool is_covered(const ObjectState& object, const Foot& foot) {
  if (object.closed.empty()) return false;
  const std::array<const Seam*, 3> own = seams_at(object, foot);
  for (std::uint32_t e = 0; e < 3; ++e)
    if (foot.barycentric[static_cast<int>((e + 2) % 3)] < kOnSeam && !own[e] &&
        std::binary_search(object.closed.begin(), object.closed.end(), 3 * foot.triangle + e))
      return true;
  return false;
}

void find_seams(World& world, TouchState& touch) {
  const auto count = static_cast<std::uint32_t>(touch.objects.size());
  for (std::uint32_t i = 0; i < count; ++i) find_seams_of(world, touch, i, 0, true);

  std::vector<Pose> start;
  for (const MovingNode& node : touch.moving)
    start.push_back(node.object < 0 ? Pose{} : world.registry.get<Pose>(node.entity));
  std::vector<double> times = key_times(world, touch.moving);
  if (count < 2) times.clear();
  times.resize(std::min(times.size(), kMostKeyTimes));
  for (const double time : times) {
    place_at(world, touch, touch.moving, time);
    const std::size_t known = touch.bonds.size();
    for (std::uint32_t i = 0; i < count; ++i) find_seams_of(world, touch, i, known, false);
  }
  for (std::size_t n = 0; n < start.size(); ++n)
    if (touch.moving[n].object >= 0) {
      world.registry.get<Pose>(touch.moving[n].entity) = start[n];
      renew_box(world, touch, static_cast<std::uint32_t>(touch.moving[n].object));
    }

  for (std::uint32_t i = 0; i < count; ++i) {
    find_closed_edges_and_zones(world, touch, i);
    find_inner_walls(world, touch, i);
  }
  for (ObjectState& object : touch.objects) {
    std::stable_sort(object.found.seams.begin(), object.found.seams.end(),
                     [](const Seam& a, const Seam& b) { return a.edge < b.edge; });
    sort_unique(object.found.zones);
    object.found.boxes.build(boxes_of(touch_mesh(world, object), object.found.seams));
    if (!object.found.seams.empty()) touch.crack = std::max(touch.crack, crack_of(touch_mesh(world, object)));
    list_closed(touch, object);  // all: this is the room that the lists need
  }
  for (std::uint32_t i = 0; i < count; ++i) list_joined(touch, i);
  for (std::uint32_t i = 0; i < count; ++i) move_seams(world, touch, i);
}

void move_seams(const World& world, TouchState& touch, std::uint32_t slot) {
  bool changed = false;
  for (const std::uint32_t b : touch.objects[slot].found.bonds) {
    Bond& bond = touch.bonds[b];
    ObjectState &first = touch.objects[bond.first], &second = touch.objects[bond.second];
    const bool open = first.world_box.empty() || second.world_box.empty() || !is_at(world, touch, bond);
    if (open == bond.open) continue;
    bond.open = open;
    changed = true;
    list_closed(touch, first);
    list_closed(touch, second);
  }
  if (!changed) return;
  for (std::uint32_t i = 0; i < touch.objects.size(); ++i)
    if (!touch.objects[i].found.bonds.empty()) list_joined(touch, i);
}

}  // namespace pliant
