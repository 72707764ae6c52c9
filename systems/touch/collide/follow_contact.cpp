#include "systems/touch/collide/follow_contact.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/collide/capsule.h"
#include "systems/touch/collide/collision.h"
#include "systems/touch/collide/over_seams.h"
#include "systems/touch/collide/seams.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/collide/triangle_tree.h"
#include "systems/touch/model/seam_dents.h"

namespace pliant {
namespace {

// A foot that moves farther than this many times its tip's way has gone over to another minimum. That of a capsule also
// slides along its axis. [1]
constexpr double kJump = 3.0, kJumpAlong = 10.0;
// Depth that the gradients do not explain, from which on it was not pushed. [1] of the tip's way
constexpr double kUnexplained = 0.1;
// A side turns with the normal by this many radians while its tip moves by its depth. [1]
constexpr double kTurnsWith = 1.0;
// A normal farther from the side is the other side's. [rad] 100 degrees
constexpr double kSlips = 1.7453292519943295;
// It gets deeper on the way out by more than this: against that wall, not along it. [1] of the way; -cos(kSlips)
constexpr double kAgainst = 0.17;
// Cosine between a wall's normal here and where the tip came in, from which on they are one wall. [1]
constexpr double kSameWall = 0.5;
// Two feet of a tip closer than this are the same. [1] of the mean edge
constexpr double kSameFoot = 1e-6;

// Depth of the tip's centre behind the deepest of the surfaces that it is pressed through. [m]
double depth_of_tip(const ContactSearch& s, const SourceState& source, const Contact& contact) {
  double depth = -source.place.height;
  any_source_of(s.object, contact.probe, contact.tip, [&](const SourceState& other) {
    depth = std::max(depth, -other.place.height);
    return false;
  });
  return depth;
}

// Turns the side towards the contact's normal, as far as the tip's way lets it: a tip strokes round a body that is
// thick against its depth. False: the foot is on the other side of a part that is thin against it.
bool turn_to(dvec3& side, dvec3 normal, double depth, double way) {
  const double lag = std::acos(std::clamp(dot(side, normal), -1.0, 1.0));
  if (!(depth > 0) || lag * depth <= kTurnsWith * way) {
    side = normal;
    return true;
  }
  if (lag > kSlips) return false;
  side = normalize(glm::mix(side, normal, kTurnsWith * way / (lag * depth)));
  return true;
}

// Whether the tip goes out through the wall that it came in by while its contact gets deeper: the foot walked over to
// another wall. Strokes turn the normal of that wall with the contact's; a press, by at most 45 degrees oblique, does
// not.
bool goes_out(const ContactSearch& s, SourceState& source, const Contact& contact, dvec3 from, dvec3 to) {
  const dvec3 step = to - from;
  const double out = dot(step, source.entered), aside = length(step - out * source.entered);
  const double stroke = std::max(0.0, aside - std::abs(out));
  turn_to(source.entered, source.place.normal, -contact.height, stroke);
  if (source.entered == source.place.normal)
    source.in = source.place.p;
  else if (stroke > 0)
    source.in += stroke / aside * (step - out * source.entered);
  if (!(out > 0) || !(source.place.height < 0) || contact.previous_height - contact.height <= kAgainst * out)
    return false;
  const Entry wall = first_entry(s.mesh, to, from);  // backwards
  if (!wall.valid()) return false;
  const uvec3 t = s.mesh.triangles[wall.triangle];
  const dvec3 a(s.mesh.position(t.x)), b(s.mesh.position(t.y)), c(s.mesh.position(t.z));
  const dvec3 outward = cross(b - a, c - a);
  return dot(outward, source.entered) > kSameWall * length(outward);
}

// Whether the contact is with the back of a part that its tip is pressed through: in front of it, behind the part.
bool is_back(const ContactSearch& s, const SourceState& source, const Contact& contact) {
  for (std::uint32_t i = 0; i < s.object.probe_sources && source.place.height >= 0; ++i) {
    const SourceState& first = s.object.sources[i];
    const HeldFoot& held = first.held;
    if (first.tracked && first.born < source.born && held.tick >= s.tick.index && held.probe == contact.probe &&
        held.tip == contact.tip && dot(held.normal, source.place.normal) < 0 &&
        dot(source.place.p - held.p, held.normal) < -s.early())
      return true;
  }
  return false;
}

// The foot slipped round a rim from p: nothing holds the tip any more, and it comes back through the part.
void slip(const ContactSearch& s, SourceState& source, Contact& contact, dvec3 p, double height) {
  source.held = {s.tick.index + 1, contact.probe, contact.tip, p, source.side, source.tip.radius - height, true,
                 source.in,        source.entered};
  s.object.slipped = s.tick.index + 1;
  drop_contact(source, contact);
}

// A foot at a seam moves to the other surface, with the contact's whole state, or waits between both.
enum class AtSeam { kStays, kBetween, kCarried };
AtSeam carry_over(const ContactSearch& s, const SideFoot& side, SourceState& source, Contact& contact, dvec3 world) {
  TouchState& touch = *s.world.touch;
  ObjectState& object = touch.objects[side.object];
  const ProbeTip tip{contact.probe, contact.tip, source.tip};
  const Deformable& deformable = s.world.registry.get<Deformable>(object.entity);
  const ContactSearch there{s.world, object, s.world.meshes[deformable.mesh], s.world.fields[deformable.field], s.tick};
  const Pose& pose = s.world.registry.get<Pose>(object.entity);
  const dvec3 x = pose.to_local(world);
  const Foot& foot = side.foot;
  if (!is_known(there, tip, foot)) {
    const Contact before = contact;
    SourceState* to = there.free_source(tip.tip);
    if (!to) return AtSeam::kStays;
    const dquat turn = glm::conjugate(pose.rotation) * s.world.registry.get<Pose>(s.object.entity).rotation;
    const TipPlace place{x - source.axis.along * (turn * source.axis.axis), turn * source.axis.axis};
    begin_contact(there, tip, deepest_on_tip(there, place, source.tip.radius, foot, source.axis.along), x);
    Contact& after = s.world.registry.get<Contact>(to->contact);
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
    after.effects = before.effects;
    after.damage = before.damage;
    to->entered = turn * source.entered;
    hand_over_dents(touch, static_cast<std::uint32_t>(&s.object - touch.objects.data()), source, side.object, *to);
  }
  drop_contact(source, contact);
  return AtSeam::kCarried;
}

// Over a seam the contact goes to the side that has the place's foot inside; over the crack, to the nearest.
AtSeam step_over(const ContactSearch& s, SourceState& source, Contact& contact, dvec3 x, Foot& foot) {
  if (!meets_seam(s.object, s.mesh, foot)) return AtSeam::kStays;
  Sides sides;
  const std::size_t count = feet_over_seams(s, foot, x, sides);
  if (count < 2) return AtSeam::kStays;
  const double radius = source.tip.radius;
  std::size_t best = 0;
  bool between = true;
  for (std::size_t i = 1; i < count; ++i) {
    const SideFoot& side = sides[i];
    between = between && side.at_seam;
    if (side.foot.height >= radius * (1 + kAhead) || (side.foot.height < 0) != (source.place.height < 0)) continue;
    const double far = std::abs(side.foot.height), least = std::abs(sides[best].foot.height);
    if (sides[best].at_seam != side.at_seam ? sides[best].at_seam : far < least) best = i;
  }
  if (best == 0) {
    if (between && !beyond_border(s.mesh, foot, x, s.object.closed)) foot = foot_over_crack(s.mesh, foot, x);
    return between ? AtSeam::kBetween : AtSeam::kStays;
  }
  if (sides[best].object != sides[0].object)
    return carry_over(s, sides[best], source, contact, s.world.registry.get<Pose>(s.object.entity).to_world(x));
  foot = sides[best].at_seam ? foot_over_crack(s.mesh, sides[best].foot, x) : sides[best].foot;
  return sides[best].at_seam ? AtSeam::kBetween : AtSeam::kStays;
}

}  // namespace

void follow_contact(const ContactSearch& s, SourceState& source, Contact& contact, const TipPlace& tip) {
  const dvec3 x = tip.at(source.axis.along);
  const double radius = source.tip.radius;
  const Foot before = source.place.main();
  const double last = source.place.height;
  if (last < s.early())
    source.held = {
        s.tick.index + 1, contact.probe, contact.tip, source.place.p, source.place.normal, 0.0, false, {}, {}};
  const dvec3 step = x - source.x, slope = source.place.gradient, place = source.place.p;
  const TipPlace was{source.x - source.axis.along * source.axis.axis, source.axis.axis};
  Foot foot = follow_foot(s, before, source.x, x);
  contact.older_height = contact.previous_height;
  contact.previous_height = contact.height;
  const AtSeam at_seam = step_over(s, source, contact, x, foot);
  if (at_seam == AtSeam::kCarried) return;
  if (last < 0 && at_seam == AtSeam::kStays && foot.height > 2 * length(step) + s.early()) {
    s.world.dropped |= kDroppedRim;
    return slip(s, source, contact, place, last);  // out of the other side at once
  }
  const bool front = foot.height >= 0;
  // Past the rim of an open surface, or too far away for a meaningful foot.
  const std::vector<std::uint32_t>& seams = s.object.closed;
  const bool beyond =
      at_seam == AtSeam::kBetween ? beyond_border(s.mesh, foot, x, seams) : beyond_border(s.mesh, foot, x);
  if ((beyond && !(front && radius > 0)) ||
      std::abs(foot.height) > static_cast<double>(s.mesh.box.diagonal()) + radius ||
      foot.height > radius * (1 + 2 * kAhead))
    return beyond && last < 0 ? slip(s, source, contact, place, last) : drop_contact(source, contact);
  put_contact(source, contact, deepest_on_tip(s, tip, radius, foot, source.axis.along, &source.place));
  if (!turn_to(source.side, source.place.normal, depth_of_tip(s, source, contact), length(source.x - x + step)) ||
      goes_out(s, source, contact, was.at(source.axis.along), source.x)) {
    s.world.dropped |= kDroppedRim;
    return slip(s, source, contact, place, last);
  }
  if (is_back(s, source, contact)) return drop_contact(source, contact);
  // A depth changes no faster than the tip moves, unless the tracked minimum vanished and the foot moved downhill to
  // another one. The additional depth was not pushed. Over a short way, that is what the gradients do not explain.
  const dvec3 step_there = source.x - was.at(source.axis.along);  // of the same sphere of a capsule
  const double moved = std::max(length(step), length(step_there));
  const double deeper = contact.previous_height - contact.height,
               least = 1e-9 * static_cast<double>(s.mesh.box.diagonal());
  const double pushed = source.tip.is_capsule() ? -dot(source.place.gradient, step_there)  // it was the deepest before
                                                : -0.5 * dot(slope + source.place.gradient, step);
  const double far = (source.tip.is_capsule() ? kJumpAlong : kJump) * moved;
  const bool jumped =
      source.tip.radius > 0 && length(source.place.p - place) > far && deeper - pushed > kUnexplained * moved;
  if (jumped || deeper - moved > least) {
    contact.unpushed += jumped ? deeper - pushed : source.tip.radius > 0 ? deeper : deeper - moved;
    source.settled = false;
  }
  // The unpushed depth is at most the depth that is left.
  contact.unpushed = std::clamp(contact.unpushed, 0.0, std::max(0.0, -contact.height));
}

void merge_contacts(const ContactSearch& s) {
  const double same = kSameFoot * static_cast<double>(s.mesh.mean_edge);
  const auto pushed = [&](const SourceState& source) {
    return source.settled ? -s.world.registry.get<Contact>(source.contact).unpushed : -source.tip.radius - same;
  };
  const std::vector<TrackedTip>& tips = s.object.tips;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    SourceState& first = s.object.sources[tips[i].source];
    for (std::size_t j = i + 1; j < tips.size() && first.tracked; ++j) {
      if (tips[i].probe != tips[j].probe || tips[i].tip != tips[j].tip) continue;
      SourceState& second = s.object.sources[tips[j].source];
      if (!second.tracked || !(length(first.place.p - second.place.p) < same)) continue;
      SourceState& drop = pushed(first) >= pushed(second) ? second : first;
      drop_contact(drop, s.world.registry.get<Contact>(drop.contact));
    }
  }
}

}  // namespace pliant
