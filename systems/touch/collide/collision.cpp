// Finds and tracks the contacts of each probe on each surface. A contact is found by sweeping the tick's segment, so
// that nothing tunnels. From then on its foot is tracked downhill from the last foot, which keeps the probe on its side
// of however thin a part. A sphere has a contact at every local minimum of the distance within its radius: both walls
// of a groove. All in the object's frame, from the tip's place on the object a tick ago to its place now: the result
// depends only on the relative motion.
#include "systems/touch/collide/collision.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "systems/touch/collide/around_vertex.h"
#include "systems/touch/collide/contact_place.h"
#include "systems/touch/collide/seams.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/collide/triangle_tree.h"
#include "systems/touch/model/field.h"
#include "systems/touch/model/seam_dents.h"

namespace pliant {
namespace {

// Walls are searched within this share of a sphere's radius beyond it, and again once it has moved half as far. A
// contact is therefore known before it presses, and begins at zero depth.
constexpr double kAhead = 0.1;
// A foot that moves farther than this many times its tip's way has gone over to another minimum. [1]
constexpr double kJump = 10.0;
// Two feet of a tip closer than this are the same. [1] of the mean edge
constexpr double kSameFoot = 1e-6;
constexpr std::size_t kMostFootSeeds = 32;
// A tip that stopped within rounding of the surface must not pass through: sweeps begin this much earlier.
constexpr double kEarly = 1e-6;  // [1] of the object's diagonal

// One tip of a probe, as identified by its contacts.
struct ProbeTip {
  Entity probe;
  std::uint8_t index = 0;
  Tip tip;
};

struct Search {
  World& world;
  ObjectState& object;
  const Mesh& mesh;
  const HeightField& field;
  Tick tick;

  double early() const { return kEarly * static_cast<double>(mesh.box.diagonal()); }  // [m]
  Foot downhill(std::uint32_t triangle, dvec3 barycentric, dvec3 x) const {
    return descend(mesh, triangle, barycentric, x, true, object.closed);
  }
  SourceState* free_source() const {
    for (std::uint32_t i = 0; i < object.probe_sources; ++i)
      if (!object.sources[i].tracked) return &object.sources[i];
    return nullptr;
  }
};

void put(SourceState& source, Contact& contact, const FootBlend& place, dvec3 x) {
  source.x = x;
  source.place = place;
  const Foot& main = place.main();
  contact.triangle = main.triangle;
  contact.barycentric = main.barycentric;
  contact.foot = place.p;
  contact.normal = place.normal;
  contact.height = place.height - source.tip.radius;
  if (contact.height >= 0) {
    contact.state = ContactState::kFree;
  } else if (contact.state == ContactState::kFree) {
    contact.state = ContactState::kInside;  // friction_feedback decides whether it presses
  }
}

// Height and rate of the recovering surface under a foot, without the contacts' targets. The depth sustained by the arm
// (standard linear solid) is excluded: the contact's law includes it already.
HeightState recovering(const Search& s, const Foot& foot) {
  const uvec3 t = s.mesh.triangles[foot.triangle];
  HeightState mean;
  for (int i = 0; i < 3; ++i) {
    const HeightState corner = residual_before(s.object, s.mesh, s.field, t[i], s.tick);
    const double held = s.field.arm.empty() ? 0.0 : static_cast<double>(s.field.arm[t[i]].w);
    mean.height += foot.barycentric[i] * (corner.height + held);
    mean.velocity += foot.barycentric[i] * corner.velocity;
  }
  return mean;
}

// Begins a contact. Its initial depth was not pushed, so its force starts from zero.
void begin(const Search& s, const ProbeTip& tip, const Foot& foot, dvec3 from, dvec3 x) {
  SourceState* source = s.free_source();
  if (!source) {
    s.world.dropped |= kDroppedContacts;
    return;
  }
  Contact& contact = s.world.registry.get<Contact>(source->contact);
  source->tracked = true;
  source->born = s.tick.index + 1;
  source->tip = tip.tip;
  contact.probe = tip.probe;
  contact.tip = tip.index;
  contact.state = ContactState::kFree;
  contact.load = contact.share = contact.normal_force = 0.0;
  contact.bristle = dvec3(0);
  contact.sliding = false;
  put(*source, contact, contact_place(s.object, s.mesh, foot, x), x);
  HeightState surface = recovering(s, foot);
  // Beside others of its tip the surface does not recover: the tip is on it, and has left that dent itself.
  for (std::uint32_t i = 0; i < s.object.probe_sources; ++i) {
    const SourceState& beside = s.object.sources[i];
    if (!beside.tracked || &beside == source || tip.tip.radius == 0) continue;
    const Contact& other = s.world.registry.get<Contact>(beside.contact);
    if (other.probe != tip.probe || other.tip != tip.index || other.height >= 0 || contact.height >= 0) continue;
    surface = {other.free_height, other.free_velocity};
    break;
  }
  const double pushed = length(x - from), unpushed = -contact.height - pushed;
  contact.free_height = std::min(0.0, surface.height);
  contact.free_velocity = contact.free_height < 0 ? surface.velocity : 0.0;
  contact.unpushed = unpushed > 1e-9 * static_cast<double>(s.mesh.box.diagonal()) ? unpushed : 0.0;
  source->settled = contact.unpushed == 0.0;
  contact.previous_height = contact.older_height = std::max(contact.height, std::min(0.0, surface.height));
  if (!s.object.listed) {
    s.object.listed = true;
    s.world.touch->awake.push_back(static_cast<std::uint32_t>(&s.object - s.world.touch->objects.data()));
  }
}

// Whether x is past the rim of an open surface. Edges in `but` are not rims (3 * triangle + edge, ascending).
bool beyond_border(const Mesh& mesh, const Foot& foot, dvec3 x, std::span<const std::uint32_t> but = {}) {
  if (!foot.at_border) return false;
  bool beyond = false;
  const auto check = [&](std::uint32_t t, int edge) {
    if (mesh.across[t][edge] != kBorder) return;
    if (std::binary_search(but.begin(), but.end(), 3 * t + static_cast<std::uint32_t>(edge))) return;
    const uvec3 corner = mesh.triangles[t];
    const dvec3 a(mesh.position(corner[edge])), b(mesh.position(corner[(edge + 1) % 3])),
        c(mesh.position(corner[(edge + 2) % 3]));
    const dvec3 outward = cross(b - a, cross(b - a, c - a));
    const double size = length(outward);
    beyond = beyond || dot(x - foot.p, outward) > 1e-9 * size * (1e-3 * length(b - a) + length(x - foot.p));
  };
  if (foot.place == FootPlace::kEdge) {
    check(foot.triangle, foot.edge);
  } else {
    const int corner = foot.barycentric.x > 0.5 ? 0 : foot.barycentric.y > 0.5 ? 1 : 2;
    around_vertex(mesh, mesh.triangles[foot.triangle][corner], foot.triangle, [&](std::uint32_t t) {
      for (int edge = 0; edge < 3; ++edge) check(t, edge);
    });
  }
  return beyond;
}

// Tracks the foot along the way of x, in steps over which the surface hardly curves.
Foot follow_foot(const Search& s, Foot foot, dvec3 from, dvec3 to) {
  const double step = std::max({std::abs(foot.height), static_cast<double>(s.mesh.mean_edge), 1e-12});
  const int steps = std::clamp(static_cast<int>(std::ceil(length(to - from) / step)), 1, 8);
  for (int i = 1; i <= steps; ++i)
    foot = s.downhill(foot.triangle, foot.barycentric, from + (to - from) * (double(i) / steps));
  return foot;
}

// Whether p is on a wall through which this tip was pressed. Such a tip is beyond the wall but still in contact with
// its entry side. On its way back the wall must not catch it: it is ignored if the contact's foot is behind it, if it
// faces against the contact, or if nothing but tissue is between the two.
bool pressed_through(const Search& s, const ProbeTip& tip, dvec3 p, dvec3 outward) {
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

bool is_known(const Search& s, const ProbeTip& tip, const Foot& foot) {
  const double same = 1e-3 * static_cast<double>(s.mesh.mean_edge);
  for (std::uint32_t i = 0; i < s.object.probe_sources; ++i) {
    const SourceState& source = s.object.sources[i];
    if (!source.tracked) continue;
    const Contact& contact = s.world.registry.get<Contact>(source.contact);
    if (contact.probe != tip.probe || contact.tip != tip.index) continue;
    for (std::uint32_t f = 0; f < source.place.count; ++f)
      if (length(source.place.foot[f].p - foot.p) < same) return true;
  }
  return false;
}

// A foot at a seam moves to the other surface, with the contact's whole state, or waits between both.
enum class AtSeam { kStays, kBetween, kCarried };
AtSeam carry_over(const Search& s, const Seam& seam, SourceState& source, Contact& contact, dvec3 world) {
  TouchState& touch = *s.world.touch;
  ObjectState& object = touch.objects[seam.object];
  if (object.world_box.empty()) return AtSeam::kStays;  // the object is removed
  const ProbeTip tip{contact.probe, contact.tip, source.tip};
  const Deformable& deformable = s.world.registry.get<Deformable>(object.entity);
  const Search there{s.world, object, s.world.meshes[deformable.mesh], s.world.fields[deformable.field], s.tick};
  const Pose& pose = s.world.registry.get<Pose>(object.entity);
  const dvec3 x = pose.to_local(world);
  Foot foot = there.downhill(seam.triangle, closest_on_triangle(there.mesh, seam.triangle, x).barycentric, x);
  if (seam_at(object, foot) && &object != &s.object) return AtSeam::kBetween;
  if (foot.height >= tip.tip.radius * (1 + kAhead) || (foot.height < 0) != (source.place.height < 0))
    return AtSeam::kStays;
  if (!is_known(there, tip, foot)) {
    const Contact before = contact;
    SourceState* to = there.free_source();
    if (!to) return AtSeam::kStays;
    begin(there, tip, foot, x, x);
    Contact& after = s.world.registry.get<Contact>(to->contact);
    const dquat turn = glm::conjugate(pose.rotation) * s.world.registry.get<Pose>(s.object.entity).rotation;
    after.free_height = before.free_height;
    after.free_velocity = before.free_velocity;
    const dvec3 own = s.world.registry.get<Pose>(s.object.entity).to_local(world);
    const double deeper = before.height - after.height - length(own - source.x);
    to->settled = !(deeper > 1e-9 * static_cast<double>(there.mesh.box.diagonal()));
    after.unpushed = before.unpushed + (to->settled ? 0.0 : deeper);
    after.previous_height = before.previous_height;
    after.older_height = before.older_height;
    after.bristle = turn * before.bristle;
    after.sliding = before.sliding;
    after.load = before.load;
    hand_over_dents(touch, static_cast<std::uint32_t>(&s.object - touch.objects.data()), source, seam.object, *to);
  }
  drop_contact(source, contact);
  return AtSeam::kCarried;
}

void follow(const Search& s, SourceState& source, Contact& contact, dvec3 x) {
  const double radius = source.tip.radius;
  const Foot before = source.place.main();
  const double last = source.place.height;
  if (last < s.early())
    source.held = {s.tick.index + 1, contact.probe, contact.tip, source.place.p, source.place.normal};
  const dvec3 step = x - source.x, slope = source.place.gradient, place = source.place.p;
  const double moved = length(step);
  const Foot foot = follow_foot(s, before, source.x, x);
  contact.older_height = contact.previous_height;
  contact.previous_height = contact.height;
  const bool front = foot.height >= 0;
  AtSeam at_seam = AtSeam::kStays;
  if (const Seam* seam = seam_at(s.object, foot))
    at_seam = carry_over(s, *seam, source, contact, s.world.registry.get<Pose>(s.object.entity).to_world(x));
  if (at_seam == AtSeam::kCarried) return;
  // Past the rim of an open surface, or too far away for a meaningful foot.
  const std::vector<std::uint32_t>& seams = s.object.closed;
  const bool beyond =
      at_seam == AtSeam::kBetween ? beyond_border(s.mesh, foot, x, seams) : beyond_border(s.mesh, foot, x);
  if ((beyond && !(front && radius > 0)) ||
      std::abs(foot.height) > static_cast<double>(s.mesh.box.diagonal()) + radius ||
      foot.height > radius * (1 + 2 * kAhead))
    return drop_contact(source, contact);
  put(source, contact, contact_place(s.object, s.mesh, foot, x), x);
  // A depth changes no faster than the tip moves, unless the tracked minimum vanished and the foot moved downhill to
  // another one. The additional depth was not pushed. Over a short way, that is what the gradients do not explain.
  const double deeper = last - source.place.height, least = 1e-9 * static_cast<double>(s.mesh.box.diagonal());
  const double pushed = -0.5 * dot(slope + source.place.gradient, step);
  const bool jumped = length(source.place.p - place) > kJump * moved && deeper - pushed > least;
  if (jumped || deeper - moved > least) {
    contact.unpushed += jumped ? deeper - pushed : deeper;
    source.settled = false;
  }
  // The unpushed depth is at most the depth that is left.
  contact.unpushed = std::clamp(contact.unpushed, 0.0, std::max(0.0, -contact.height));
}

// Feet of the walls within `within` of x: triangles that are nearer than all their neighbours.
void find_walls(const Search& s, dvec3 x, double within, std::array<Foot, kMostFootSeeds>& feet, std::size_t& count) {
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
bool inside_neighbour(const Search& s, const ProbeTip& tip) {
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
EntryPlace entry_place(const Search& s, const ProbeTip& tip, dvec3 from, dvec3 to, dvec3 along) {
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
void find_entry(const Search& s, const ProbeTip& tip, dvec3 from, dvec3 to) {
  const dvec3 d = to - from;
  if (!(dot(d, d) > 0) || inside_neighbour(s, tip)) return;
  const auto enter = [&](const Foot& foot) {
    if (foot.valid() && foot.height < 0 && !beyond_border(s.mesh, foot, to) && !is_known(s, tip, foot))
      begin(s, tip, foot, from, to);
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
void find_inside(const Search& s, const ProbeTip& tip, dvec3 x) {
  if (!s.mesh.closed) return;
  const FlatPoint near =
      closest_flat(s.mesh, x, std::max(tip.tip.radius, 0.1 * static_cast<double>(s.mesh.box.diagonal())));
  if (!near.valid()) return;
  const Foot foot = s.downhill(near.triangle, near.barycentric, x);
  if (foot.height < tip.tip.radius && !is_known(s, tip, foot)) begin(s, tip, foot, x, x);
}

// `searched`: where this tip last searched for walls of the object.
void find(const Search& s, const ProbeTip& tip, dvec3& searched, bool fresh, dvec3 from, dvec3 to) {
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
      begin(s, tip, foot, from, to);
    }
  }
}

// Of contacts of one tip that have reached the same foot, the one stays whose depth was pushed.
void merge(const Search& s) {
  const double same = kSameFoot * static_cast<double>(s.mesh.mean_edge);
  const auto pushed = [&](const SourceState& source) {
    return source.settled ? -s.world.registry.get<Contact>(source.contact).unpushed : -source.tip.radius - same;
  };
  for (std::uint32_t i = 0; i < s.object.probe_sources; ++i) {
    SourceState& first = s.object.sources[i];
    if (!first.tracked) continue;
    Contact& a = s.world.registry.get<Contact>(first.contact);
    for (std::uint32_t j = i + 1; j < s.object.probe_sources && first.tracked; ++j) {
      SourceState& second = s.object.sources[j];
      if (!second.tracked) continue;
      Contact& b = s.world.registry.get<Contact>(second.contact);
      if (a.probe != b.probe || a.tip != b.tip || !(length(first.place.p - second.place.p) < same)) continue;
      if (pushed(first) >= pushed(second))
        drop_contact(second, b);
      else
        drop_contact(first, a);
    }
  }
}

}  // namespace

void drop_contact(SourceState& source, Contact& contact) {
  source.tracked = false;
  contact.state = ContactState::kFree;
  contact.probe = kNoEntity;
  contact.load = contact.share = contact.normal_force = 0.0;
  contact.force = dvec3(0);
}

dvec3 tip_position(const Probe& probe, const Tip& tip) {
  return probe.position + probe.rotation * tip.place;
}

dvec3 tip_position_before(const Probe& probe, const Tip& tip) {
  return probe.previous + probe.previous_rotation * tip.place;
}

void collision(World& world, Tick tick) {
  TouchState& touch = *world.touch;
  Registry& registry = world.registry;
  for (const std::uint32_t slot : touch.awake) {
    ObjectState& object = touch.objects[slot];
    const Deformable& deformable = registry.get<Deformable>(object.entity);
    const Search search{world, object, world.meshes[deformable.mesh], world.fields[deformable.field], tick};
    const Pose& pose = registry.get<Pose>(object.entity);
    std::uint32_t followed = 0;
    for (std::uint32_t i = 0; i < object.probe_sources; ++i) {
      SourceState& source = object.sources[i];
      if (!source.tracked || source.born == tick.index + 1) continue;  // carried over a seam in this tick
      Contact& contact = registry.get<Contact>(source.contact);
      const Probe& probe = registry.get<Probe>(contact.probe);
      follow(search, source, contact, pose.to_local(tip_position(probe, source.tip)));
      ++followed;
    }
    if (followed > 1) merge(search);
  }
  for (const ProbeState& state : touch.probes) {
    const Probe& probe = registry.get<Probe>(state.entity);
    if (!probe.placed) continue;
    for (std::size_t t = 0; t < state.tips.size(); ++t) {
      const Tip& tip = state.tips[t];
      const dvec3 to = tip_position(probe, tip), from = probe.fresh ? to : tip_position_before(probe, tip);
      const double band = tip.radius * (1 + kAhead) + 2 * kEarly * touch.extent;
      Box swept;
      swept.add(vec3(glm::min(from, to) - dvec3(band)));
      swept.add(vec3(glm::max(from, to) + dvec3(band)));
      touch.object_boxes.visit(swept, [&](std::uint32_t slot) {
        ObjectState& object = touch.objects[slot];
        if (object.world_box.empty()) return;  // the object is removed
        const Deformable& deformable = registry.get<Deformable>(object.entity);
        const Search search{world, object, world.meshes[deformable.mesh], world.fields[deformable.field], tick};
        find(search, {state.entity, static_cast<std::uint8_t>(t), tip}, object.searched[state.first_tip + t],
             probe.fresh, pose_before(registry, object.entity).to_local(from),
             registry.get<Pose>(object.entity).to_local(to));
      });
    }
  }
}

}  // namespace pliant
