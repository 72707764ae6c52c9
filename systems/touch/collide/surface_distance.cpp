#include "systems/touch/collide/surface_distance.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/collide/around_vertex.h"
#include "systems/touch/collide/unfold.h"

namespace pliant {
namespace {

bool later(const MarchItem& x, const MarchItem& y) {
  return x.distance != y.distance ? x.distance > y.distance : x.vertex > y.vertex;
}

}  // namespace

void clear_offsets(const Mesh& mesh, const std::vector<std::uint32_t>& zones, std::vector<vec3>& offset) {
  for (const std::uint32_t zone : zones)
    std::fill(offset.begin() + mesh.zone_begin(zone), offset.begin() + mesh.zone_end(zone), vec3(kFar));
}

void march_distance(const Mesh& mesh, const Contact& contact, const FieldSource& source, std::vector<vec3>& offset,
                    std::vector<MarchItem>& heap) {
  const float reach = 1 / std::sqrt(source.inv_reach2);
  const auto distance = [&](std::uint32_t v) { return length(offset[v]); };
  heap.clear();
  // Shorter by more than rounding; otherwise two corners could improve each other forever.
  constexpr float kShorter = 1 - 1e-5f;
  const auto reached = [&](std::uint32_t v, std::uint32_t triangle, float r, vec3 o) {
    if (!(r < reach) || !(r < kShorter * distance(v)) || heap.size() == heap.capacity()) return;
    offset[v] = o;
    heap.push_back({r, v, triangle});
    std::push_heap(heap.begin(), heap.end(), later);
  };
  const uvec3 start = mesh.triangles[contact.triangle];
  for (int i = 0; i < 3; ++i) {
    const vec3 d = mesh.position(start[i]) - source.center;
    reached(start[i], contact.triangle, length(d), d);
  }
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), later);
    const MarchItem item = heap.back();
    heap.pop_back();
    if (kShorter * item.distance > distance(item.vertex)) continue;  // a shorter path was found meanwhile
    around_vertex(mesh, item.vertex, item.triangle, [&](std::uint32_t t) {
      const uvec3 c = mesh.triangles[t];
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t v = c[i], a = c[(i + 1) % 3], b = c[(i + 2) % 3];
        if (v == item.vertex) continue;
        const std::uint32_t u = item.vertex, w = a == u ? b : a;
        const float ru = item.distance, rw = distance(w);
        Arrival arrival;
        if (rw < kFar) {
          arrival = arrive(mesh.position(u), mesh.position(w), mesh.position(v), ru, rw);
        } else {
          const vec3 d = mesh.position(v) - mesh.position(u);
          const float l = length(d);
          arrival = {ru + l, d / std::max(l, 1e-30f)};
        }
        // The offset is tangent at v: rotated into its plane with its length kept.
        const vec3 n = mesh.normal(v);
        vec3 o = arrival.direction - dot(arrival.direction, n) * n;
        o *= arrival.distance / std::max(length(o), 1e-30f);
        reached(v, t, arrival.distance, o);
      }
    });
  }
}

vec4 target_at_offset(const FieldSource& source, vec3 offset, vec3 normal) {
  // The distance already excludes other parts of the surface, so the angle between normals is not tested. Seen from the
  // vertex, the contact is in its tangent plane.
  FieldSource local = source;
  local.center = vec3(0);
  local.normal = normal;
  return target_at(local, offset, normal);
}

void add_targets_at_offsets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source,
                            const std::vector<vec3>& offset, ZoneTargets& targets) {
  const std::uint32_t begin = mesh.zone_begin(zone), count = mesh.zone_end(zone) - begin;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (offset[begin + i].x == kFar) continue;
    const vec4 t = target_at_offset(source, offset[begin + i], mesh.normal(begin + i));
    targets.nx[i] += t.x;
    targets.ny[i] += t.y;
    targets.nz[i] += t.z;
    targets.h[i] += t.w;
  }
}

void add_volume_sums_at_offsets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source,
                                const std::vector<vec3>& offset, VolumeSums& sums) {
  for (std::uint32_t v = mesh.zone_begin(zone); v < mesh.zone_end(zone); ++v) {
    const vec3 o = offset[v];
    if (o.x == kFar) continue;
    const double r2 = dot(o, o), u = std::min(1.0, r2 * source.inv_reach2), w = std::pow(1 - u, 3),
                 aw = mesh.area[v] * w;
    const vec3 chord = mesh.position(v) - source.center;
    sums.S0 += aw;
    sums.S1 += aw * u;
    sums.Q0 += aw * w;
    sums.Q1 += aw * w * u;
    sums.Q2 += aw * w * u * u;
    sums.bend += aw * dot(mesh.normal(v) - source.normal, chord);
    sums.spread += aw * r2;
  }
}

}  // namespace pliant
