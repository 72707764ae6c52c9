// Contacts -> the field around them. Computes the zones that each contact reaches and the coefficient that makes its
// shape volume-preserving on this mesh. Also the amplitudes that bring the surface to every probe's depth. The dent of
// a contact that ends is folded into the residual. (P1 section 3; methods.md 1.3 and 1.8.)
#include "systems/touch/model/force_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "systems/touch/collide/surface_distance.h"
#include "systems/touch/model/amplitude.h"
#include "systems/touch/model/contact_law.h"
#include "systems/touch/model/damage.h"
#include "systems/touch/model/dent.h"
#include "systems/touch/model/field.h"
#include "systems/touch/model/field_kernels.h"
#include "systems/touch/model/pressing.h"
#include "systems/touch/model/seam_dents.h"

namespace pliant {
namespace {

// [1] of the reach: default contact radius of half-space shapes.
constexpr double kContactShare = 0.2;
// [1] of the reach: limit of a bulge's height under a probe.
constexpr double kMostBulge = 0.25;

// Net volume of h = -alpha f, f = w (1 - c u), over the curved mesh to second order: sum A (h + H h^2). Solved for the
// c that leaves 1 - chi of the volume displaced by w alone.
float volume_coefficient(const VolumeSums& s, double alpha, double chi) {
  if (!(s.S1 > 0)) return static_cast<float>(5 * chi);
  const double aH = s.spread > 0 ? alpha * s.bend / s.spread : 0.0;
  const double wanted = (1 - chi) * (s.S0 - aH * s.Q0);
  double c = chi * s.S0 / s.S1;
  for (int i = 0; i < 3; ++i) {
    const double g = s.S0 - c * s.S1 - aH * (s.Q0 - 2 * c * s.Q1 + c * c * s.Q2) - wanted;
    const double dg = -s.S1 + aH * (2 * s.Q1 - 2 * c * s.Q2);
    if (!(dg < 0)) break;  // curvature beyond the expansion's range: keep the current value
    c -= g / dg;
  }
  return static_cast<float>(std::clamp(c, 0.0, 10.0));
}

// A probe can press the surface down but not pull it up. If it lifts faster than the surface would rise freely, the
// surface is left behind. The force continues by the law of the depth until the probe is out.
bool leaves_behind(const Contact& contact, double share, const Mesh& mesh, const Motion& motion) {
  const double h = share * contact.previous_height,
               v = share * std::max(0.0, contact.previous_height - contact.older_height) / motion.dt;
  if (contact.height <= contact.previous_height) return false;
  const double stiffness = painted(mesh.stiffness_factor, mesh, contact.triangle, contact.barycentric),
               damping = painted(mesh.damping_factor, mesh, contact.triangle, contact.barycentric);
  return share * contact.height > step_free(motion, stiffness, damping, {h, v}).height;
}

struct Active {
  SourceState* source;
  Contact* contact;
};

// The dent of a contact with amplitude 1.
struct UnitDent {
  FieldSource source;
  float reach;  // [m] and a little more; infinite with offsets
  bool ends;    // at the reach; else by its offsets
};
UnitDent unit_dent(const SourceState& of) {
  UnitDent out{of.now, std::numeric_limits<float>::infinity(), of.offset.empty()};
  out.source.amplitude = 1.0f;
  if (out.ends) out.reach = 1.001f / std::sqrt(of.now.inv_reach2);
  return out;
}
float size2(vec3 v) {
  return dot(v, v);
}

// Amplitudes of all contacts that dent one object.
void solve(std::span<const Active> active, const Deformable& deformable, const Mesh& mesh, const HeightField& field,
           const ObjectState& object, Tick tick) {
  const std::size_t n = active.size();
  std::array<double, kMaxContactsPerObject * kMaxContactsPerObject> A;
  std::array<double, kMaxContactsPerObject> d, alpha;
  Room<UnitDent, kMaxContactsPerObject> unit;
  for (std::size_t j = 0; j < n; ++j) unit.all[j] = unit_dent(*active[j].source);
  for (std::size_t i = 0; i < n; ++i) {
    const Contact& contact = *active[i].contact;
    const uvec3 corner = mesh.triangles[contact.triangle];
    double residual = 0.0;
    for (int b = 0; b < 3; ++b) {
      const double weight = contact.barycentric[b];
      if (deformable.response == Response::kFollow) {
        residual += weight * residual_after(object, mesh, field, corner[b], tick);
        residual += weight * echoed_at(object, mesh, corner[b]);
        if (!field.set.empty()) residual += weight * static_cast<double>(field.set[corner[b]].w);
      }
    }
    const vec3 p0 = mesh.position(corner.x);
    const float width = std::sqrt(std::max(size2(mesh.position(corner.y) - p0), size2(mesh.position(corner.z) - p0)));
    for (std::size_t j = 0; j < n; ++j) {
      double sum = 0.0;
      const float beyond = unit.all[j].reach + width;
      if (!(size2(p0 - unit.all[j].source.center) > beyond * beyond))  // else no corner is within reach
        for (int b = 0; b < 3; ++b) {
          const vec3 apart = mesh.position(corner[b]) - unit.all[j].source.center;
          if (unit.all[j].ends && dot(apart, apart) * unit.all[j].source.inv_reach2 >= 1.0f) continue;
          sum -= contact.barycentric[b] * source_height_at(*active[j].source, unit.all[j].source, mesh, corner[b]);
        }
      A[i * n + j] = sum;
    }
    A[i * n + i] = std::max(A[i * n + i], 0.1);  // a reach with hardly a vertex must not make the amplitude diverge
    // A bulge raised by earlier presses adds to the depth to be pressed down, up to a limit: otherwise rims on a slowly
    // recovering surface would amplify each other.
    const double reach = 1 / std::sqrt(double(active[i].source->now.inv_reach2));
    d[i] = std::min(residual, kMostBulge * reach) - dent_share(contact, deformable) * contact.height;
    alpha[i] = active[i].source->before.amplitude;
  }
  if (n == 1) {
    alpha[0] = std::max(0.0, d[0] / A[0]);
  } else {
    solve_amplitudes({A.data(), n * n}, {d.data(), n}, {alpha.data(), n});
  }
  for (std::size_t i = 0; i < n; ++i) {
    active[i].source->now.amplitude = static_cast<float>(alpha[i]);
    active[i].contact->amplitude = alpha[i];
  }
}

}  // namespace

double contact_radius(const Deformable& deformable, double reach) {
  return deformable.contact_radius > 0 ? deformable.contact_radius : kContactShare * reach;
}

void aim(FieldSource& source, const Contact& contact, const Deformable& deformable, const Mesh& mesh, double radius) {
  const double depth = dent_share(contact, deformable) * std::max(0.0, -contact.height);
  const double circle = radius > 0 ? std::sqrt(2 * radius * depth) : 0.0;
  const double reach = std::max(deformable.reach, kLeastReach * mesh.mean_edge) + circle;
  const double inner = contact_radius(deformable, reach) + circle;
  source.center = vec3(contact.foot);
  source.normal = vec3(contact.normal);
  source.inv_reach2 = static_cast<float>(1 / (reach * reach));
  source.shape = deformable.shape;
  source.parameter = shape_parameter(deformable.shape, inner, reach, deformable.volume);
}

void force_field(World& world, Tick tick) {
  for (const std::uint32_t slot : world.touch->awake) {
    ObjectState& object = world.touch->objects[slot];
    const Deformable& deformable = world.registry.get<Deformable>(object.entity);
    const Mesh& mesh = world.meshes[deformable.mesh];
    HeightField& field = world.fields[deformable.field];

    object.feed_writer.give_up_if_lost(object, field);

    // Clears the last tick's marks; contacts that ended fold their dent into the residual.
    std::array<Active, kMaxContactsPerObject> active;
    std::size_t count = 0;
    for (SourceState& source : object.sources) {
      for (const std::uint32_t zone : source.zones) {
        object.zone_sources[zone] = 0;
        if (!object.on_gpu) field.zone_state[zone] &= static_cast<std::uint8_t>(~kZoneReached);
      }
      if (source.contact == kNoEntity) continue;  // an echo
      Contact& contact = world.registry.get<Contact>(source.contact);
      const bool touching = contact.state != ContactState::kFree && contact.height < 0;
      if (touching && !object.holes.empty() && contact.probe != kNoEntity) find_hole(object, source, contact);
      const bool left_behind = touching && source.now.amplitude > 0 &&
                               leaves_behind(contact, dent_share(contact, deformable), mesh, object.motion);
      if (source.active && (!touching || left_behind || contact.damage.relaxes)) fold(source, object, world, tick);
      contact.damage.relaxes = false;
      if (!touching) {
        if (!source.offset.empty()) clear_offsets(source.zones, source.offset);
        source.zones.clear();
        contact.amplitude = 0.0;
        continue;
      }
      active[count++] = {&source, &contact};
    }
    if (count == 0) continue;

    // Centre of each field and the zones that it reaches.
    for (std::size_t i = 0; i < count; ++i) {
      SourceState& source = *active[i].source;
      const Contact& contact = *active[i].contact;
      source.before = source.now;
      const double radius = contact.probe == kNoEntity ? 0.0 : world.registry.get<Probe>(contact.probe).radius;
      aim(source.now, contact, deformable, mesh, radius);
      if (!source.active) {  // before the first tick of the touch: the same field with zero amplitude
        source.before = source.now;
        source.before.amplitude = 0.0f;
        source.now.amplitude = 0.0f;
        source.active = true;
      }
      if (!source.offset.empty()) clear_offsets(source.zones, source.offset);
      const uvec3 corner = mesh.triangles[contact.triangle];
      const std::array<std::uint32_t, 3> own{corner.x / kZoneSize, corner.y / kZoneSize, corner.z / kZoneSize};
      flood(mesh, vec3(contact.foot), 1 / std::sqrt(double(source.now.inv_reach2)), own, object, source.zones);
      if (!source.offset.empty())
        fill_offsets(mesh, object.ways, contact.triangle, source.now, source.zones, object.march, source.chart,
                     source.offset);
      if (row_of(source.now.shape).parameter == ShapeParameter::kVolume) {
        VolumeSums sums;
        for (const std::uint32_t zone : source.zones)
          add_volume_sums(mesh, zone, source.now, source.offset, sums, &object.blocks[zone]);
        add_echo_sums(world, {slot, static_cast<std::uint32_t>(&source - object.sources.data())}, source, sums);
        source.now.parameter = volume_coefficient(
            sums, dent_share(contact, deformable) * std::max(0.0, -contact.height), deformable.volume);
      }
    }
    solve({active.data(), count}, deformable, mesh, field, object, tick);

    for (std::size_t i = 0; i < count; ++i) mark_reached(*active[i].source, object, field);
  }
  echo_dents(world, tick);
}

}  // namespace pliant
