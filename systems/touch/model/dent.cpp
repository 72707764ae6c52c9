#include "systems/touch/model/dent.h"

#include <algorithm>
#include <utility>

#include "systems/touch/collide/surface_distance.h"
#include "systems/touch/model/field.h"
#include "systems/touch/model/field_kernels.h"

namespace pliant {
void wake(HeightField& field, std::uint32_t zone, std::uint8_t why) {
  field.zone_state[zone] |= why;
  if (field.zone_state[zone] & kZoneListed) return;
  field.zone_state[zone] |= kZoneListed;
  field.awake.push_back(zone);  // capacity: all zones
}

void flood(const Mesh& mesh, vec3 center, double reach, std::span<const std::uint32_t> from, ObjectState& object,
           std::vector<std::uint32_t>& zones) {
  zones.clear();
  const std::uint32_t stamp = ++object.stamp;
  const float reach2 = static_cast<float>(reach * reach);
  const auto offer = [&](std::uint32_t zone) {
    if (object.visited[zone] == stamp) return;
    object.visited[zone] = stamp;
    const Box& box = mesh.zone_box[zone];
    const vec3 d = glm::max(glm::max(box.min - center, center - box.max), vec3(0));
    if (dot(d, d) < reach2) zones.push_back(zone);  // capacity: all zones
  };
  for (const std::uint32_t zone : from) offer(zone);
  for (std::size_t i = 0; i < zones.size(); ++i) {
    for (std::uint32_t n = mesh.zone_neighbour_first[zones[i]]; n < mesh.zone_neighbour_first[zones[i] + 1]; ++n)
      offer(mesh.zone_neighbours[n]);
    auto crack = std::lower_bound(object.cracks.begin(), object.cracks.end(), zones[i],
                                  [](const SeamZones& seam, std::uint32_t zone) { return seam.zone < zone; });
    for (; crack != object.cracks.end() && crack->zone == zones[i]; ++crack) offer(crack->other);
  }
}

vec4 source_at(const SourceState& source, const FieldSource& s, const Mesh& mesh, std::uint32_t v) {
  if (!source.offset.empty()) return target_at_offset(s, source.offset[v], mesh.normal(v));
  return target_at(s, mesh.position(v), mesh.normal(v));
}

float source_height_at(const SourceState& source, const FieldSource& s, const Mesh& mesh, std::uint32_t v) {
  if (!source.offset.empty()) return target_at_offset(s, source.offset[v], mesh.normal(v)).w;
  return height_at(s, mesh.position(v), mesh.normal(v));
}

void fold(SourceState& source, ObjectState& object, World& world, Tick tick) {
  const Deformable& deformable = world.registry.get<Deformable>(object.entity);
  const Mesh& mesh = world.meshes[deformable.mesh];
  HeightField& field = world.fields[deformable.field];
  source.active = false;
  if (source.now.amplitude == 0.0f && source.before.amplitude == 0.0f) return;
  // A tip that stops does not throw the surface on: its release has no inward speed.
  if (source.now.amplitude > source.before.amplitude) source.before = source.now;
  if (deformable.response == Response::kLag) return;  // then the residual is already the whole state
  if (object.on_gpu) return remember_release(object, {source.now, source.before, tick.time}, world.dropped);
  const float inv_dt = static_cast<float>(1 / tick.dt);
  object.feed_writer.fold(source.feed_number, source.before, source.now);
  for (const std::uint32_t zone : source.zones) {
    if (!source.offset.empty()) object.feed_writer.offsets(source.feed_number, zone, source.offset, true);
    for (std::uint32_t v = mesh.zone_begin(zone); v < mesh.zone_end(zone); ++v) {
      const vec4 now = source_at(source, source.now, mesh, v);
      const vec4 before = source_at(source, source.before, mesh, v);
      // As if the arm had not relaxed at all; dynamics hands over the relaxed part (field_kernels.h, step_relaxed).
      const RestoringLaw& law = object.motion.law;
      if (!field.arm.empty())
        field.arm[v] += arm_stiffness(object.motion, mesh, v) *
                        (law.strained(field.residual[v] + now) - law.strained(field.residual[v]));
      field.residual[v] += now;
      field.rate[v] += (now - before) * inv_dt;
    }
    wake(field, zone, kZoneResidual);
  }
}

void mark_reached(SourceState& source, ObjectState& object, HeightField& field) {
  const std::uint32_t number = static_cast<std::uint32_t>(&source - object.sources.data());
  source.feed_number = number;
  object.feed_writer.source(number, source.now);
  for (const std::uint32_t zone : source.zones) {
    object.zone_sources[zone] |= std::uint64_t{1} << number;
    if (!source.offset.empty()) object.feed_writer.offsets(number, zone, source.offset, false);
    if (!object.on_gpu) wake(field, zone, kZoneReached);
  }
}

void swap_dents(SourceState& a, SourceState& b) {
  std::swap(a.active, b.active);
  std::swap(a.now, b.now);
  std::swap(a.before, b.before);
  std::swap(a.feed_number, b.feed_number);
  a.zones.swap(b.zones);
  std::swap(a.offset, b.offset);
  std::swap(a.chart, b.chart);
}

}  // namespace pliant
