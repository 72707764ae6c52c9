#include "systems/touch/collide/contact_search.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/collide/around_vertex.h"
#include "systems/touch/collide/capsule.h"
#include "systems/touch/model/field.h"

namespace pliant {
namespace {

// Height and rate of the recovering surface under a foot, without the contacts' targets. The force sustained by the arm
// of a relaxing law is excluded: the contact's law includes it already.
HeightState recovering(const ContactSearch& s, const Foot& foot) {
  const uvec3 t = s.mesh.triangles[foot.triangle];
  HeightState mean;
  for (int i = 0; i < 3; ++i) {
    const HeightState corner = residual_before(s.object, s.mesh, s.field, t[i], s.tick);
    const RestoringLaw& law = s.object.motion.law;
    const double height = s.field.arm.empty()
                              ? corner.height
                              : law.height_of(law.force(corner.height) + static_cast<double>(s.field.arm[t[i]].w));
    mean.height += foot.barycentric[i] * height;
    mean.velocity += foot.barycentric[i] * corner.velocity;
  }
  return mean;
}

void list_tip(ObjectState& object, const TrackedTip& tip) {
  auto at = std::find_if(object.tips.begin(), object.tips.end(),
                         [&](const TrackedTip& other) { return other.source >= tip.source; });
  if (at != object.tips.end() && at->source == tip.source)
    *at = tip;  // the place of one that ended in this tick
  else
    object.tips.insert(at, tip);  // capacity: every source
}

}  // namespace

void put_contact(SourceState& source, Contact& contact, const TipContact& at) {
  source.x = at.x;
  source.place = at.place;
  source.axis = at.axis;
  const FootBlend& place = source.place;
  const Foot& main = place.main();
  contact.triangle = main.triangle;
  contact.barycentric = main.barycentric;
  contact.foot = place.p;
  contact.normal = place.normal;
  contact.height = place.height + at.raised - source.tip.radius;
  if (contact.height >= 0) {
    contact.state = ContactState::kFree;
  } else if (contact.state == ContactState::kFree) {
    contact.state = ContactState::kInside;  // friction_feedback decides whether it presses
  }
}

void begin_contact(const ContactSearch& s, const ProbeTip& tip, const TipContact& at, dvec3 from) {
  SourceState* source = s.free_source(tip.tip);
  if (!source) {
    if (!tip.tip.drawn) s.world.dropped |= kDroppedContacts;
    return;
  }
  Contact& contact = s.world.registry.get<Contact>(source->contact);
  source->tracked = true;
  list_tip(s.object, {tip.probe, tip.index, static_cast<std::uint8_t>(source - s.object.sources.data())});
  source->born = s.tick.index + 1;
  source->tip = tip.tip;
  contact.probe = tip.probe;
  contact.tip = tip.index;
  contact.state = ContactState::kFree;
  contact.load = contact.share = contact.normal_force = 0.0;
  contact.bristle = dvec3(0);
  contact.sliding = false;
  contact.effects = {};
  contact.damage = {};
  put_contact(*source, contact, at);
  source->side = source->entered = source->place.normal;
  source->in = source->place.p;
  HeightState surface = recovering(s, at.place.main());
  // Beside others of its tip the surface does not recover: the tip is on it, and has left that dent itself.
  if (tip.tip.radius > 0)
    any_source_of(s.object, tip.probe, tip.index, [&](const SourceState& beside) {
      const Contact& other = s.world.registry.get<Contact>(beside.contact);
      if (&beside == source || other.height >= 0) return false;
      surface = {other.free_height, other.free_velocity};
      return true;
    });
  const double pushed = length(at.x - from), unpushed = -contact.height - pushed;
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

bool beyond_border(const Mesh& mesh, const Foot& foot, dvec3 x, std::span<const std::uint32_t> but) {
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

Foot follow_foot(const ContactSearch& s, Foot foot, dvec3 from, dvec3 to) {
  const double step = std::max({std::abs(foot.height), static_cast<double>(s.mesh.mean_edge), 1e-12});
  const int steps = std::clamp(static_cast<int>(std::ceil(length(to - from) / step)), 1, 8);
  for (int i = 1; i <= steps; ++i)
    foot = s.downhill(foot.triangle, foot.barycentric, from + (to - from) * (double(i) / steps));
  return foot;
}

bool is_known(const ContactSearch& s, const ProbeTip& tip, const Foot& foot) {
  const double same = 1e-3 * static_cast<double>(s.mesh.mean_edge);
  return any_source_of(s.object, tip.probe, tip.index, [&](const SourceState& source) {
    for (std::uint32_t f = 0; f < source.place.count; ++f)
      if (length(source.place.foot[f].p - foot.p) < same) return true;
    return false;
  });
}

}  // namespace pliant
