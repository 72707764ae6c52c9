#include "systems/touch/collide/new_contacts.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/collide/seams.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

constexpr std::size_t kMostFootSeeds = 32;

// Whether p is on a wall through which this tip was pressed. Such a tip is beyond the wall but still in contact with
// its entry side. On its way back the wall must not catch it: it is ignored if the contact's foot is behind it, if it
// faces against the contact, or if nothing but tissue is between the two.
bool pressed_through(const ContactSearch& s, const ProbeTip& tip, dvec3 p, dvec3 outward) {
  const double size = length(outward), bulge = static_cast<double>(s.mesh.tree.bulge);
  const auto joined = [&](const HeldFoot& held) {
    const dvec3 behind = p - (s.early() + 1.5 * bulge) * outward / size, way = behind - held.p;
    const double far = length(way), from = 2 * (s.early() + bulge);
    return from < far && !first_entry(s.mesh, held.p + from / far * way, behind).valid();
  };
  for (std::uint32_t i = 0; i < s.object.probe_sources; ++i) {
    const HeldFoot& held = s.object.sources[i].held;
    if (held.tick == s.tick.index + 1 && held.probe == tip.probe && held.tip == tip.index &&
        (dot(p - held.p, outward) >= -s.early() * size || dot(held.normal, outward) < 0 || joined(held)))
      return true;
  }
  return false;
}

// Feet of the walls within `within` of x: triangles that are nearer than all their neighbours.
void find_walls(const ContactSearch& s, dvec3 x, double within, std::array<Foot, kMostFootSeeds>& feet,
                std::size_t& count) {
  const Mesh& mesh = s.mesh;
  const double limit = within + static_cast<double>(mesh.tree.bulge);
  const float limit2 = static_cast<float>(limit * limit * 1.0001);
  const double same = 1e-3 * static_cast<double>(mesh.mean_edge);
  visit_runs_near(
      mesh, x, [&] { return limit; },
      [&](std::uint32_t first, std::uint32_t run) {
        TriangleDistances distance2;
        triangle_distances2(mesh, first, run, x, distance2);
        for (std::uint32_t i = 0; i < run && count < kMostFootSeeds; ++i) {
          if (!(distance2[i] <= limit2)) continue;
          const std::uint32_t t = first + i;
          const FlatPoint at = closest_on_triangle(mesh, t, x);
          const double enough = at.distance2 * (1 - 1e-9);
          bool lowest = true;
          for (int edge = 0; edge < 3 && lowest; ++edge) {
            if (at.barycentric[(edge + 2) % 3] > 1e-9) continue;  // not on this edge
            const std::uint32_t next = mesh.across[t][edge];
            if (next == kBorder) continue;
            const double other = closest_on_triangle(mesh, next, x).distance2;
            lowest = other >= enough && !(next < t && other <= at.distance2 * (1 + 1e-9));
          }
          if (!lowest) continue;
          const Foot foot = s.downhill(t, at.barycentric, x);
          if (!(foot.height >= 0) || foot.height > within || at_seam(s.object, foot)) continue;
          const auto is_same = [&](const Foot& f) { return length(f.p - foot.p) < same; };
          if (std::none_of(feet.begin(), feet.begin() + static_cast<std::ptrdiff_t>(count), is_same))
            feet[count++] = foot;
        }
      });
}

// Whether the tip is already behind this surface or an adjoining one; then the walls between them are ignored.
bool inside_neighbour(const ContactSearch& s, const ProbeTip& tip) {
  if (s.object.seams.empty()) return false;
  const auto behind = [&](const ObjectState& object) {
    for (std::uint32_t i = 0; i < object.probe_sources; ++i) {
      if (!object.sources[i].tracked || object.sources[i].place.height >= 0) continue;
      const Contact& contact = s.world.registry.get<Contact>(object.sources[i].contact);
      if (contact.probe == tip.probe && contact.tip == tip.index) return true;
    }
    return false;
  };
  return behind(s.object) || std::any_of(s.object.neighbours.begin(), s.object.neighbours.end(),
                                         [&](std::uint32_t slot) { return behind(s.world.touch->objects[slot]); });
}

// Of the walls on a way, the first that is entered from outside and is not ignored for this tip. `along` [m] steps past
// a wall.
struct EntryPlace {
  std::uint32_t triangle = Foot::kNone;
  dvec3 barycentric{1, 0, 0};
  dvec3 x{0};  // [m]
};
EntryPlace entry_place(const ContactSearch& s, const ProbeTip& tip, dvec3 from, dvec3 to, dvec3 along) {
  constexpr int kMostWalls = 8;  // on the way of one tick
  for (int wall = 0; wall < kMostWalls && dot(to - from, along) > 0; ++wall) {
    const pliant::Entry entry = first_entry(s.mesh, from, to);
    if (!entry.valid()) break;
    const dvec3 x = from + entry.fraction * (to - from);
    const uvec3 t = s.mesh.triangles[entry.triangle];
    const dvec3 a(s.mesh.position(t.x)), b(s.mesh.position(t.y)), c(s.mesh.position(t.z));
    if (!pressed_through(s, tip, x, cross(b - a, c - a))) return {entry.triangle, entry.barycentric, x};
    from = x + along;
  }
  return {};
}

// Begins a contact where a point passed through the surface.
void find_entry(const ContactSearch& s, const ProbeTip& tip, dvec3 from, dvec3 to) {
  const dvec3 d = to - from;
  if (!(dot(d, d) > 0) || inside_neighbour(s, tip)) return;
  const auto enter = [&](const Foot& foot) {
    if (foot.valid() && foot.height < 0 && !beyond_border(s.mesh, foot, to) && !is_known(s, tip, foot))
      begin_contact(s, tip, foot, from, to);
  };
  const auto bulge = static_cast<double>(s.mesh.tree.bulge);
  const dvec3 early = s.early() / length(d) * d;
  if (const EntryPlace entry = entry_place(s, tip, from - early, to, early); entry.triangle != Foot::kNone) {
    const Foot foot = s.downhill(entry.triangle, entry.barycentric, dot(entry.x - from, d) > 0 ? entry.x : from);
    enter(follow_foot(s, foot, foot.p, to));
  } else if (bulge > 0 && tip.tip.radius == 0) {
    // The curved surface is slightly in front of or behind its triangles: walls that were in front of the point.
    std::array<Foot, kMostFootSeeds> feet;
    std::size_t count = 0;
    find_walls(s, from, 1.5 * bulge + length(d), feet, count);
    for (std::size_t f = 0; f < count; ++f) {
      const Foot foot = follow_foot(s, feet[f], from, to);
      // Deeper than the way: that minimum ended, and the foot is on another wall.
      if (foot.height < feet[f].height - length(d) - s.early()) continue;
      if (foot.height < 0 && !pressed_through(s, tip, foot.p, foot.normal)) enter(foot);
    }
  }
}

// The first pose may be inside a body; only a closed one has an inside.
void find_inside(const ContactSearch& s, const ProbeTip& tip, dvec3 x) {
  if (!s.mesh.closed) return;
  const FlatPoint near =
      closest_flat(s.mesh, x, std::max(tip.tip.radius, 0.1 * static_cast<double>(s.mesh.box.diagonal())));
  if (!near.valid()) return;
  const Foot foot = s.downhill(near.triangle, near.barycentric, x);
  if (foot.height < tip.tip.radius && !is_known(s, tip, foot)) begin_contact(s, tip, foot, x, x);
}

}  // namespace

void find_new_contacts(const ContactSearch& s, const ProbeTip& tip, dvec3& searched, bool fresh, dvec3 from, dvec3 to) {
  const double radius = tip.tip.radius, within = radius * (1 + kAhead);
  const double band = within + static_cast<double>(s.mesh.tree.bulge) + 2 * s.early();
  const Box& box = s.mesh.box;
  const dvec3 low = glm::min(from, to) - dvec3(band), high = glm::max(from, to) + dvec3(band);
  if (low.x > box.max.x || low.y > box.max.y || low.z > box.max.z || high.x < box.min.x || high.y < box.min.y ||
      high.z < box.min.z)
    return;
  if (fresh) return find_inside(s, tip, to);
  find_entry(s, tip, from, to);
  if (radius == 0 || inside_neighbour(s, tip)) return;

  if (length(to - searched) < 0.5 * kAhead * radius) return;
  searched = to;
  // A sphere touches before its centre crosses: search around the segment's end, and along the segment of a fast one.
  const int steps = std::clamp(static_cast<int>(std::ceil(2 * length(to - from) / radius)), 1, 16);
  for (int i = 1; i <= steps; ++i) {
    const dvec3 x = from + (to - from) * (double(i) / steps);
    std::array<Foot, kMostFootSeeds> feet;
    std::size_t count = 0;
    find_walls(s, x, within, feet, count);
    for (std::size_t f = 0; f < count; ++f) {
      const Foot foot = i == steps ? feet[f] : follow_foot(s, feet[f], x, to);
      if (foot.height > within || is_known(s, tip, foot) || pressed_through(s, tip, foot.p, foot.normal)) continue;
      begin_contact(s, tip, foot, from, to);
    }
  }
}

}  // namespace pliant
