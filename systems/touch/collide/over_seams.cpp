#include "systems/touch/collide/over_seams.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "systems/touch/collide/around_vertex.h"
#include "systems/touch/collide/inner_walls.h"
#include "systems/touch/collide/seams.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {

namespace {

// The corner of the triangle that a foot is at, or -1.
int corner_under(const Foot& foot) {
  constexpr double kAtCorner = 1 - 1e-6;  // [1] barycentric
  for (int corner = 0; corner < 3; ++corner)
    if (foot.barycentric[corner] > kAtCorner) return corner;
  return -1;
}

}  // namespace

bool meets_seam(const ObjectState& object, const Mesh& mesh, const Foot& foot) {
  if (object.closed.empty()) return false;
  if (at_seam(object, foot)) return true;
  const int corner = corner_under(foot);
  if (corner < 0) return false;
  const std::uint32_t vertex = mesh.triangles[foot.triangle][corner];
  bool meets = false;
  around_vertex(mesh, vertex, foot.triangle, [&](std::uint32_t t) {
    const int at = corner_of(mesh.triangles[t], vertex);
    for (const int edge : {at, (at + 2) % 3})
      meets = meets ||
              std::binary_search(object.closed.begin(), object.closed.end(), 3 * t + static_cast<std::uint32_t>(edge));
  });
  return meets;
}

namespace {

// The sides found so far, each once.
struct SideList {
  const ContactSearch& s;
  dvec3 x, world;
  std::uint32_t own;
  Sides& sides;
  std::size_t count = 0;

  const ObjectState& object(std::uint32_t slot) const { return s.world.touch->objects[slot]; }
  const Mesh& mesh(std::uint32_t slot) const {
    return s.world.meshes[s.world.registry.get<Deformable>(object(slot).entity).mesh];
  }
  // The side that a triangle begins.
  void add(std::uint32_t slot, std::uint32_t triangle) {
    if (count == kMostSides) return;
    const ObjectState& other = object(slot);
    const Mesh& on = mesh(slot);
    const dvec3 there = slot == own ? x : s.world.registry.get<Pose>(other.entity).to_local(world);
    const Foot far =
        descend(on, triangle, closest_on_triangle(on, triangle, there).barycentric, there, true, other.closed);
    if (!is_covered(other, far) && !is_inner_wall(other, far.triangle)) add(slot, far);
  }
  void add(std::uint32_t slot, const Foot& foot) {
    const auto is_same = [&](const SideFoot& side) {
      return side.object == slot && side.foot.triangle == foot.triangle;
    };
    if (std::none_of(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(count), is_same))
      sides[count++] = {slot, foot, meets_seam(object(slot), mesh(slot), foot)};
  }
};

// The other triangles of the same surface at a corner, which may have seams of their own.
void add_around_corner(SideList& list, const SideFoot& side) {
  const int corner = corner_under(side.foot);
  if (corner < 0) return;
  for (const int edge : {corner, (corner + 2) % 3}) {
    const std::uint32_t key = 3 * side.foot.triangle + static_cast<std::uint32_t>(edge);
    const std::uint32_t next = list.mesh(side.object).across[side.foot.triangle][edge];
    const std::vector<std::uint32_t>& closed = list.object(side.object).closed;
    if (next != kBorder && !std::binary_search(closed.begin(), closed.end(), key)) list.add(side.object, next);
  }
}

}  // namespace

std::size_t feet_over_seams(const ContactSearch& s, const Foot& foot, dvec3 x, Sides& sides) {
  const auto own = static_cast<std::uint32_t>(&s.object - s.world.touch->objects.data());
  SideList list{s, x, s.world.registry.get<Pose>(s.object.entity).to_world(x), own, sides};
  list.add(own, foot);
  if (!sides[0].at_seam || is_covered(s.object, foot)) return list.count;
  for (std::size_t i = 0; i < list.count; ++i) {
    if (!sides[i].at_seam) continue;
    const SideFoot from = sides[i];
    for (const Seam* const seam : seams_at(list.object(from.object), from.foot))
      if (seam) list.add(seam->object, seam->triangle);
    add_around_corner(list, from);
  }
  return list.count;
}

bool past_seam(const ContactSearch& s, const Foot& foot, dvec3 x) {
  if (foot.height >= 0 || !meets_seam(s.object, s.mesh, foot)) return false;
  const dvec3 n = facet_normal(s.mesh, foot.triangle), way = x - foot.p;
  return length(way - dot(way, n) * n) > crack_of(s.mesh);
}

bool faces(const Mesh& mesh, const Foot& foot) {
  constexpr double kFaces = 0.5;  // [1] cosine
  return dot(facet_normal(mesh, foot.triangle), foot.normal) > kFaces;
}

Foot foot_over_crack(const Mesh& mesh, Foot foot, dvec3 x) {
  const dvec3 n = facet_normal(mesh, foot.triangle);
  const double height = dot(x - foot.p, n);
  if (length(x - foot.p - height * n) > crack_of(mesh)) return foot;  // past the end of the seam
  foot.height = height;
  foot.p = x - foot.height * n;
  foot.normal = n;
  foot.moves = dmat3(1.0) - glm::outerProduct(n, n);
  foot.turns = dmat3(0.0);
  foot.shifts = {};
  return foot;
}

Foot foot_over_seam(const ContactSearch& s, const Foot& foot, dvec3 x) {
  if (!meets_seam(s.object, s.mesh, foot)) return foot;
  Sides sides;
  const std::size_t count = feet_over_seams(s, foot, x, sides);
  std::size_t best = 0;
  for (std::size_t i = 1; i < count; ++i) {
    if (sides[i].object != sides[0].object || (sides[i].foot.height < 0) != (foot.height < 0)) continue;
    const bool nearer = std::abs(sides[i].foot.height) < std::abs(sides[best].foot.height);
    if (sides[best].at_seam != sides[i].at_seam ? sides[best].at_seam : nearer) best = i;
  }
  return count > 1 && sides[best].at_seam ? foot_over_crack(s.mesh, sides[best].foot, x) : sides[best].foot;
}

namespace {

bool has_contact(const ContactSearch& s, const ProbeTip& tip, const SideFoot& side) {
  const ObjectState& object = s.world.touch->objects[side.object];
  const double near = crack_of(s.world.meshes[s.world.registry.get<Deformable>(object.entity).mesh]);
  return any_source_of(object, tip.probe, tip.index,
                       [&](const SourceState& source) { return length(source.place.p - side.foot.p) < near; });
}

}  // namespace

bool bears_between(const ContactSearch& s, const ProbeTip& tip, const Foot& foot, dvec3 x) {
  Sides sides;
  const std::size_t count = feet_over_seams(s, foot, x, sides);
  if (count < 2) return false;
  const auto key = [](const SideFoot& side) {
    return std::tie(side.object, side.foot.p.x, side.foot.p.y, side.foot.p.z);
  };
  return std::all_of(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(count), [&](const SideFoot& side) {
    return side.at_seam && key(sides[0]) <= key(side) && !has_contact(s, tip, side);
  });
}

std::optional<SeamEntry> seam_entry(const ContactSearch& s, const ProbeTip& tip, dvec3 from, dvec3 to) {
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
    if (!bears_between(s, tip, s.downhill(t, barycentric, x), x)) return;
    earliest = fraction;
    first = {t, barycentric, x, outward};
  });
  return first;
}

}  // namespace pliant
