#include "systems/touch/collide/new_contacts.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/collide/capsule.h"
#include "systems/touch/collide/inner_walls.h"
#include "systems/touch/collide/over_seams.h"
#include "systems/touch/collide/seams.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

constexpr std::size_t kMostFootSeeds = 32;
// Mean edge from which on a mesh is coarse. [1] of the distance within which walls are searched
constexpr double kCoarse = 0.1;

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
        (dot(p - held.p, outward) >= -s.early() * size || dot(held.normal, outward) < 0 ||
         dot(held.entered, outward) < 0 || joined(held)))
      return true;
  }
  return false;
}

// Feet of the walls within `within` of x: triangles that are nearer than all their neighbours.
void find_walls(const ContactSearch& s, const ProbeTip& tip, dvec3 x, double within,
                std::array<Foot, kMostFootSeeds>& feet, std::size_t& count) {
  const Mesh& mesh = s.mesh;
  const double limit = within + static_cast<double>(mesh.tree.bulge);
  const float limit2 = static_cast<float>(limit * limit * 1.0001);
  const double same = 1e-3 * static_cast<double>(mesh.mean_edge);
  const bool seamless = s.object.seams.empty();
  // Patches next to each other may each have a minimum where their triangles have one. Not felt on finer meshes.
  const bool coarse = mesh.tree.bulge > 0 && static_cast<double>(mesh.mean_edge) > kCoarse * within;
  const auto add = [&](const Foot& foot) {
    if (!(foot.height >= 0) || foot.height > within || is_inner_wall(s.object, foot.triangle)) return;
    if (meets_seam(s.object, s.mesh, foot) && (!faces(s.mesh, foot) || !bears_between(s, tip, foot, x))) return;
    const auto is_same = [&](const Foot& f) { return length(f.p - foot.p) < same; };
    if (count < kMostFootSeeds &&
        std::none_of(feet.begin(), feet.begin() + static_cast<std::ptrdiff_t>(count), is_same))
      feet[count++] = foot;
  };
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
            // Of equals the first; at a seam each is tried: the foot of a side wall is covered.
            lowest = other >= enough && !(seamless && next < t && other <= at.distance2 * (1 + 1e-9));
          }
          if (!lowest) continue;
          const Foot foot = s.downhill(t, at.barycentric, x);
          add(foot);
          if (!coarse || !foot.valid()) continue;
          for (int edge = 0; edge < 3; ++edge)
            if (const std::uint32_t next = mesh.across[foot.triangle][edge]; next != kBorder)
              add(s.downhill(next, dvec3(1.0 / 3), x));
        }
      });
}

// Whether the tip is already behind this surface or an adjoining one; then the walls between them are ignored.
bool inside_neighbour(const ContactSearch& s, const ProbeTip& tip) {
  if (s.object.seams.empty()) return false;
  const auto behind = [&](const ObjectState& object) {
    return any_source_of(object, tip.probe, tip.index,
                         [](const SourceState& source) { return source.place.height < 0; });
  };
  return behind(s.object) || std::any_of(s.object.joined.begin(), s.object.joined.end(),
                                         [&](std::uint32_t slot) { return behind(s.world.touch->objects[slot]); });
}

// Whether a capsule has a contact with an adjoining surface. It goes over to this one where it gets deeper here.
bool is_beside(const ContactSearch& s, const ProbeTip& tip) {
  return tip.tip.is_capsule() && std::any_of(s.object.joined.begin(), s.object.joined.end(), [&](std::uint32_t slot) {
           return any_source_of(s.world.touch->objects[slot], tip.probe, tip.index,
                                [](const SourceState&) { return true; });
         });
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
    if (!is_inner_wall(s.object, entry.triangle) && !pressed_through(s, tip, x, cross(b - a, c - a)))
      return {entry.triangle, entry.barycentric, x};
    from = x + along;
  }
  return {};
}

// Way of a tip on the object in this tick.
struct TipWay {
  TipPlace from, to;
};

// Begins a contact at the deepest sphere of the tip, downhill from the foot of that at `along`.
void begin_at(const ContactSearch& s, const ProbeTip& tip, const TipWay& way, const Foot& foot, double along) {
  if (is_known(s, tip, foot)) return;
  const TipContact at = deepest_on_tip(s, way.to, tip.tip.radius, foot, along);
  if (!tip.tip.is_capsule() || !is_known(s, tip, at.place.main()))
    begin_contact(s, tip, at, way.from.at(at.axis.along));
}

// Whether nothing of the surface is within `within` of x. It is searched again once the tip has left the ball that was
// found clear: mostly the surface is as far as the contact is deep.
bool is_clear(const ContactSearch& s, const ProbeTip& tip, ClearBall& clear, dvec3 x, double within) {
  constexpr double kFarther = 16.0;  // [1] of `within`
  if (length(x - clear.at) + within < clear.radius) return true;
  std::uint32_t wall = FlatPoint::kNone;
  const double bulge = static_cast<double>(s.mesh.tree.bulge);
  if (any_source_of(s.object, tip.probe, tip.index, [&](const SourceState& source) {
        wall = source.place.main().triangle;
        return std::abs(source.place.height) < within + bulge;
      }))
    return false;
  const FlatPoint near = closest_flat(s.mesh, x, kFarther * within, wall);
  clear = {x, near.valid() ? (1 - 1e-9) * std::sqrt(near.distance2) : kFarther * within};
  return within < clear.radius;
}

// Begins a contact where the sphere at `along` passed through the surface with its centre.
void find_entry(const ContactSearch& s, const ProbeTip& tip, const TipWay& way, double along, ClearBall& clear) {
  const dvec3 from = way.from.at(along), to = way.to.at(along), d = to - from;
  if (!(dot(d, d) > 0) || inside_neighbour(s, tip)) return;
  const auto bulge = static_cast<double>(s.mesh.tree.bulge);
  if (s.object.found.seams.empty() && !tip.tip.is_capsule() &&
      is_clear(s, tip, clear, from, length(d) + 2 * s.early() + 2.6 * bulge))
    return;
  const auto enter = [&](const Foot& foot) {
    if (foot.valid() && foot.height < 0 && !beyond_border(s.mesh, foot, to, s.object.closed))
      begin_at(s, tip, way, foot, along);
  };
  const dvec3 early = s.early() / length(d) * d;
  if (const EntryPlace entry = entry_place(s, tip, from - early, to, early); entry.triangle != Foot::kNone) {
    const Foot foot = s.downhill(entry.triangle, entry.barycentric, dot(entry.x - from, d) > 0 ? entry.x : from);
    enter(follow_foot(s, foot, foot.p, to));
  } else if (const std::optional<SeamEntry> crack = seam_entry(s, tip, from - early, to);
             crack && !pressed_through(s, tip, crack->x, crack->outward)) {
    enter(s.downhill(crack->triangle, crack->barycentric, to));
  } else if (bulge > 0 && tip.tip.radius == 0) {
    // The curved surface is slightly in front of or behind its triangles: walls that were in front of the point.
    std::array<Foot, kMostFootSeeds> feet;
    std::size_t count = 0;
    find_walls(s, tip, from, 1.5 * bulge + length(d), feet, count);
    for (std::size_t f = 0; f < count; ++f) {
      const Foot foot = follow_foot(s, feet[f], from, to);
      // Deeper than the way: that minimum ended, and the foot is on another wall.
      if (foot.height < feet[f].height - length(d) - s.early()) continue;
      if (foot.height < 0 && !pressed_through(s, tip, foot.p, foot.normal)) enter(foot);
    }
  }
}

// Whether x is behind the triangle that is nearest to it.
bool is_behind(const Mesh& mesh, const FlatPoint& nearest, dvec3 x) {
  if (!nearest.valid()) return false;
  const uvec3 t = mesh.triangles[nearest.triangle];
  const dvec3 a(mesh.position(t.x)), b(mesh.position(t.y)), c(mesh.position(t.z));
  return dot(x - a, cross(b - a, c - a)) < 0;
}

// The first pose may be inside a body; only a closed one has an inside.
void find_inside(const ContactSearch& s, const ProbeTip& tip, const TipWay& way, double along) {
  if (!s.mesh.closed) return;
  const dvec3 x = way.to.at(along);
  const auto whole = static_cast<double>(s.mesh.box.diagonal());
  const FlatPoint near = closest_flat(s.mesh, x, std::max(tip.tip.radius, 0.1 * whole));
  if (!near.valid()) {  // deeper no contact begins
    if (is_behind(s.mesh, closest_flat(s.mesh, x, whole), x)) s.world.dropped |= kDroppedInside;
    return;
  }
  const Foot foot = s.downhill(near.triangle, near.barycentric, x);
  if (foot.height >= tip.tip.radius) return;
  begin_at(s, tip, {way.to, way.to}, foot, along);
  s.world.dropped |= kDroppedInside;
}

// Whether no sphere beside that at `along`, `apart` farther, is nearer to this wall. A sphere: always.
bool is_lowest(const ContactSearch& s, const TipWay& way, const Foot& foot, double along, double apart) {
  for (const double to : {along - apart, along + apart}) {
    if (apart == 0 || to < -0.5 * apart || to > 1 + 0.5 * apart) continue;
    const double beside = std::clamp(to, 0.0, 1.0);
    if (follow_foot(s, foot, way.to.at(along), way.to.at(beside)).height < foot.height) return false;
  }
  return true;
}

// Begins contacts with the walls within reach of the sphere at `along`: around its way's end, and along the way of a
// fast one. A sphere touches before its centre crosses.
void find_near(const ContactSearch& s, const ProbeTip& tip, const TipWay& way, double along, double apart) {
  const double radius = tip.tip.radius, within = radius * (1 + kAhead);
  const dvec3 from = way.from.at(along), to = way.to.at(along);
  const int steps = std::clamp(static_cast<int>(std::ceil(2 * length(to - from) / radius)), 1, 16);
  for (int i = 1; i <= steps; ++i) {
    const dvec3 x = from + (to - from) * (double(i) / steps);
    std::array<Foot, kMostFootSeeds> feet;
    std::size_t count = 0;
    find_walls(s, tip, x, within, feet, count);
    for (std::size_t f = 0; f < count; ++f) {
      const Foot foot = i == steps ? feet[f] : follow_foot(s, feet[f], x, to);
      if (foot.height <= within && is_lowest(s, way, foot, along, apart) &&
          !pressed_through(s, tip, foot.p, foot.normal))
        begin_at(s, tip, way, foot, along);
    }
  }
}

// Begins contacts in dents that part as a shaft strokes over them, also where its axis is behind the surface and no
// wall is in front of it. The surface is followed along the axis from the deepest contact on, over `count`
// intervals, at every tick: a dent that is found late has depth that nothing has paid for.
void find_dents(const ContactSearch& s, const ProbeTip& tip, const TipWay& way, int count) {
  constexpr double kBegins = 0.1;  // [1] of kSameDent: between spheres the ridge is higher
  const double radius = tip.tip.radius, apart = 1.0 / count;
  const SourceState* deepest = nullptr;
  const auto any_contact = [&](auto is) { return any_source_of(s.object, tip.probe, tip.index, is); };
  any_contact([&](const SourceState& source) {
    if (!deepest || source.place.height < deepest->place.height) deepest = &source;
    return false;
  });
  if (!deepest || !(deepest->place.height < radius)) return;
  const Foot first = deepest->place.main();
  const double start = deepest->axis.along;
  const auto is_new = [&](double along) {
    return !any_contact([&](const SourceState& other) { return std::abs(other.axis.along - along) < 1.5 * apart; });
  };
  const auto begin = [&](const Foot& foot, double along) {
    if (!(foot.height < radius) || !is_new(along)) return;
    const TipContact at = deepest_on_tip(s, way.to, radius, foot, along);
    if (is_new(at.axis.along)) begin_contact(s, tip, at, way.from.at(at.axis.along));
  };
  for (const double end : {0.0, 1.0}) {
    Foot foot = first, lowest = first;
    double along = start, lowest_at = start, ridge = first.height;
    while (along != end) {
      const double to = end > along ? std::min(end, along + apart) : std::max(end, along - apart);
      const dvec3 x = way.to.at(to);
      foot = foot_over_seam(s, follow_foot(s, foot, way.to.at(along), x), x);
      along = to;
      const bool behind = foot.height < 0;
      if (foot.height > radius || (behind && (beyond_border(s.mesh, foot, x) || past_seam(s, foot, x)))) break;
      if (lowest.height < ridge - kBegins * kSameDent * radius) {  // on the way down from a ridge, or up again
        if (foot.height > lowest.height) {
          begin(lowest, lowest_at);
          ridge = foot.height;
        }
      } else {
        ridge = std::max(ridge, foot.height);
      }
      lowest = foot;
      lowest_at = along;
    }
    if (lowest.height < ridge - kBegins * kSameDent * radius) begin(lowest, lowest_at);
  }
}

// Walls that a tip was pressed through before it slipped round a rim stay open for it until it is clear: in front of
// the place where it slipped, on the side that it came from, and of the place where it came in; or away from there.
void keep_open(const ContactSearch& s, const ProbeTip& tip, const TipPlace& to) {
  constexpr double kFree = 0.5;  // [1] of the depth at which it slipped
  constexpr double kAway = 4.0;  // [1] sideways, of the depth at which it slipped, or of the depth now
  if (s.object.slipped < s.tick.index) return;
  for (std::uint32_t i = 0; i < s.object.probe_sources; ++i) {
    SourceState& source = s.object.sources[i];
    HeldFoot& held = source.held;
    if (!s.slipped(source) || held.probe != tip.probe || held.tip != tip.index) continue;
    const auto near = [&](dvec3 p, dvec3 normal, double free) {
      const dvec3 way = to.at(source.axis.along) - p;
      const double up = dot(way, normal), aside = length(way - up * normal);
      return up <= std::max(tip.tip.radius * (1 + kAhead), free) &&
             aside <= kAway * std::clamp(-up, held.depth, kAway * held.depth);
    };
    if (near(held.p, held.normal, kFree * held.depth) || near(held.in, held.entered, 0.0))
      held.tick = s.object.slipped = s.tick.index + 1;
  }
}

// Number of intervals between the spheres of a capsule from which its contacts are searched: half a radius long, of a
// line half an edge of the mesh. A sphere: 0.
int intervals(const ContactSearch& s, const Tip& tip) {
  if (!tip.is_capsule()) return 0;
  constexpr double kMost = 256;
  const double apart = 0.5 * (tip.radius > 0 ? tip.radius : static_cast<double>(s.mesh.mean_edge));
  return static_cast<int>(std::clamp(std::ceil(length(tip.axis) / apart), 1.0, kMost));
}

}  // namespace

void find_new_contacts(const ContactSearch& s, const ProbeTip& tip, TipPlace& searched, ClearBall& clear, bool fresh,
                       const TipPlace& from, const TipPlace& to) {
  const double radius = tip.tip.radius, within = radius * (1 + kAhead);
  const double band = within + static_cast<double>(s.mesh.tree.bulge) + 2 * s.early() +
                      (s.object.seams.empty() ? 0.0 : crack_of(s.mesh));
  const Box& box = s.mesh.box;
  const dvec3 low = glm::min(glm::min(from.end, from.at(1)), glm::min(to.end, to.at(1))) - dvec3(band),
              high = glm::max(glm::max(from.end, from.at(1)), glm::max(to.end, to.at(1))) + dvec3(band);
  if (low.x > box.max.x || low.y > box.max.y || low.z > box.max.z || high.x < box.min.x || high.y < box.min.y ||
      high.z < box.min.z)
    return;
  if (!fresh) keep_open(s, tip, to);
  if (is_beside(s, tip)) return;
  const TipWay way{from, to};
  const int count = intervals(s, tip.tip);
  const auto along = [&](int i) { return count == 0 ? 0.0 : double(i) / count; };
  // A capsule's wall is known before the axis crosses it, unless it is fast.
  const double far = std::max(length(to.end - from.end), length(to.at(1) - from.at(1)));
  if (fresh || !tip.tip.is_capsule() || far > 0.5 * radius)
    for (int i = 0; i <= count; ++i)
      fresh ? find_inside(s, tip, way, along(i)) : find_entry(s, tip, way, along(i), clear);
  if (fresh || radius == 0 || inside_neighbour(s, tip)) return;

  if (count > 0 && far > 0) find_dents(s, tip, way, count);
  if (std::max(length(to.end - searched.end), length(to.at(1) - searched.at(1))) < 0.5 * kAhead * radius) return;
  searched = to;
  for (int i = 0; i <= count; ++i) find_near(s, tip, way, along(i), count == 0 ? 0.0 : 1.0 / count);
}

}  // namespace pliant
