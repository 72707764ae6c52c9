// Where each probe is on each surface. A contact is found by sweeping the tick's segment (so nothing is tunnelled
// through) and from then on followed from its last place, which keeps it on the side it came from however thin the part
// is.
#include "systems/touch/collision.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/field.h"
#include "systems/touch/surface_query.h"

namespace pliant {
namespace {

struct Surface {
  const Mesh& mesh;
  const HeightField& field;
  const ObjectState& object;

  // The surface as it is now at a point: height [m], and the rate of its residual [m/s].
  HeightState at(const SurfaceFoot& p) const {
    const uvec3 t = mesh.triangles[p.triangle];
    HeightState mean;
    for (int i = 0; i < 3; ++i) {
      const HeightState corner = surface_at(object, mesh, field, t[i]);
      mean.height += p.barycentric[i] * corner.height;
      mean.velocity += p.barycentric[i] * corner.velocity;
    }
    return mean;
  }
};

void place(Contact& contact, const SurfaceFoot& p, double radius) {
  contact.triangle = p.triangle;
  contact.barycentric = p.barycentric;
  contact.foot = p.foot;
  contact.normal = p.normal;
  contact.height = p.height - radius;
  contact.interpolated = p.interpolated;
}

SurfaceFoot last_place(const Contact& contact, double radius) {
  SurfaceFoot p;
  p.triangle = contact.triangle;
  p.barycentric = contact.barycentric;
  p.foot = contact.foot;
  p.normal = contact.normal;
  p.height = contact.height + radius;
  return p;
}

// Touching if the probe is below the surface as it is now; inside if only below where it was at rest.
void settle(Contact& contact, const Surface& surface, const SurfaceFoot& p) {
  const HeightState now = surface.at(p);
  contact.surface_height = now.height;
  contact.surface_velocity = now.velocity;
  if (contact.state == ContactState::kTouching) return;  // friction_feedback decides when it ends
  if (contact.height < now.height) {
    contact.state = ContactState::kTouching;
    contact.just_touched = true;
    contact.free_height = now.height;
    contact.free_velocity = now.velocity;
    contact.previous_height = contact.older_height = now.height;
    contact.arm_force = 0.0;
    contact.bristle = dvec3(0);
    contact.sliding = false;
  } else {
    contact.state = contact.height < 0 ? ContactState::kInside : ContactState::kFree;
  }
}

void follow(Contact& contact, const Surface& surface, dvec3 x, double radius) {
  const Tracked tracked = track(surface.mesh, last_place(contact, radius), x);
  contact.older_height = contact.previous_height;
  contact.previous_height = contact.height;
  // Past the rim of an open surface, or so far away that no place on it means anything any more.
  if (tracked.left_border || tracked.point.distance() > surface.mesh.box.diagonal() + radius) {
    contact.state = ContactState::kFree;
    return;
  }
  place(contact, tracked.point, radius);
  settle(contact, surface, tracked.point);
}

// Contacts of a surface that the probe was not on a tick ago.
void find(Contact& contact, const Surface& surface, dvec3 from, dvec3 to, const Probe& probe) {
  const double radius = probe.radius, band = radius + surface.object.peak;
  const Box& box = surface.mesh.box;
  const dvec3 low = glm::min(from, to) - dvec3(band), high = glm::max(from, to) + dvec3(band);
  if (low.x > box.max.x || low.y > box.max.y || low.z > box.max.z || high.x < box.min.x || high.y < box.min.y ||
      high.z < box.min.z)
    return;

  SurfaceFoot p;
  if (probe.fresh) {
    // The first pose may lie inside a body; only a closed one has an inside.
    if (!surface.mesh.closed) return;
    p = nearest(surface.mesh, to, std::max(band, 0.1 * double(box.diagonal())));
    if (!p.valid() || p.height - radius >= 0) return;
  } else if (const dvec3 d = to - from; dot(d, d) > 0) {
    // Begin a little earlier: a probe that came to rest within rounding of the surface must not slip through.
    const double early = 1e-6 * box.diagonal() / length(d);
    const Entry entry = first_entry(surface.mesh, from - early * d, to);
    if (entry.valid()) {
      const SurfaceFoot at =
          surface_point(corners(surface.mesh, entry.triangle), entry.triangle, entry.barycentric, 0.0);
      const Tracked tracked = track(surface.mesh, at, to);
      if (!tracked.left_border) p = tracked.point;
    } else if (band > 0) {
      // A sphere touches before its centre crosses, and a rim stands above rest: look around the segment's end, and for
      // a fast sphere along it.
      const int steps = radius > 0 ? std::clamp(int(std::ceil(2 * length(d) / radius)), 1, 16) : 1;
      for (int i = 1; i <= steps && !p.valid(); ++i) {
        const dvec3 x = from + d * (double(i) / steps);
        p = nearest(surface.mesh, x, band);
        if (p.valid() && !(p.height >= 0 && p.height - radius < surface.at(p).height)) p = {};
        if (p.valid() && i < steps) p = track(surface.mesh, p, to).point;
      }
    }
  }
  if (!p.valid()) return;
  place(contact, p, radius);
  settle(contact, surface, p);
}

}  // namespace

void collision(World& world, Tick) {
  for (auto [entity, contact] : world.registry.view<Contact>()) {
    if (contact.probe == kNoEntity) continue;  // `press` places it
    const Probe& probe = world.registry.get<Probe>(contact.probe);
    if (!probe.placed) continue;
    const Pose& pose = world.registry.get<Pose>(contact.object);
    const Deformable& deformable = world.registry.get<Deformable>(contact.object);
    const Surface surface{world.meshes[deformable.mesh], world.fields[deformable.field],
                          world.touch->objects[contact.object_slot]};
    const dvec3 to = pose.to_local(probe.position);
    if (contact.state == ContactState::kFree) {
      find(contact, surface, pose.to_local(probe.previous), to, probe);
    } else {
      follow(contact, surface, to, probe.radius);
    }
  }
}

}  // namespace pliant
