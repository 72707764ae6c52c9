#include "systems/touch/collide/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/kernel.h"
#include "systems/touch/collide/around_vertex.h"
#include "systems/touch/collide/unfold.h"

namespace pliant {
namespace {

bool later(const MarchItem& x, const MarchItem& y) {
  return x.distance != y.distance ? x.distance > y.distance : x.vertex > y.vertex;
}

// Arrival at a corner of a triangle from its other two; from the nearer one along its edge if the other is not reached.
Arrival arrival_at(const Mesh& mesh, const std::vector<float>& distance, std::uint32_t triangle, int corner) {
  const uvec3 c = mesh.triangles[triangle];
  std::uint32_t a = c[(corner + 1) % 3], b = c[(corner + 2) % 3];
  const vec3 v = mesh.position(c[corner]);
  if (distance[b] < distance[a]) std::swap(a, b);
  if (distance[b] < kFar) return arrive(mesh.position(a), mesh.position(b), v, distance[a], distance[b]);
  const vec3 d = v - mesh.position(a);
  const float l = length(d);
  return {distance[a] + l, d / std::max(l, 1e-30f)};
}

// Distance of a corner from those of the other two, ra and rb; la and lb are the lengths of the edges to them. As
// arrive().
float arrival(const Side& s, float ra, float rb, float la, float lb) {
  const float bent = std::min(ra + la, rb + lb);
  if (std::max(ra, rb) == kFar || !(s.length > 0) || !(s.height > 0)) return bent;
  const float sx = 0.5f * (ra * ra - rb * rb + s.length * s.length) / s.length;
  const float sy = std::sqrt(std::max(0.0f, ra * ra - sx * sx));
  const float across = s.height + sy, crossing = sx * across + (s.foot - sx) * sy;  // times `across`
  if (crossing < 0 || crossing > s.length * across) return bent;
  const float dx = s.foot - sx;
  return std::sqrt(dx * dx + across * across);
}

// Shorter by more than rounding; otherwise two corners could improve each other forever.
constexpr float kShorter = 1 - 1e-5f;

// Cosine of the largest angle between the normals of an arc's ends.
constexpr float kLeastCosine = 0.26f;

PLIANT_KERNEL void arc_offsets(const Mesh& mesh, std::uint32_t begin, const FieldSource& s, ZoneOffsets& out) {
  const float* __restrict px = mesh.px.data() + begin;
  const float* __restrict py = mesh.py.data() + begin;
  const float* __restrict pz = mesh.pz.data() + begin;
  const float* __restrict nx = mesh.nx.data() + begin;
  const float* __restrict ny = mesh.ny.data() + begin;
  const float* __restrict nz = mesh.nz.data() + begin;
  const float cx = s.center.x, cy = s.center.y, cz = s.center.z;
  const float mx = s.normal.x, my = s.normal.y, mz = s.normal.z;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const float dx = px[i] - cx, dy = py[i] - cy, dz = pz[i] - cz;
    const float c2 = dx * dx + dy * dy + dz * dz;
    const float a = dx * mx + dy * my + dz * mz;           // of the chord along the contact's normal
    const float b = dx * nx[i] + dy * ny[i] + dz * nz[i];  // and along the vertex's
    const float facing = mx * nx[i] + my * ny[i] + mz * nz[i];
    const float q = 0.4f * (a * a + b * b) - 0.2f * a * b, w = 2 - 2 * facing;
    const float arc2 = c2 + q * (1.0f / 3 + w * (2.0f / 45 + w * (1.0f / 140 + w * (2.0f / 1575))));
    const float t2 = c2 - b * b;
    const float k = std::sqrt(arc2 / (t2 > 1e-30f ? t2 : 1e-30f));
    const float x = k * (dx - b * nx[i]), y = k * (dy - b * ny[i]), z = k * (dz - b * nz[i]);
    const bool far = facing < kLeastCosine;
    out.x[i] = far ? kFar : x;
    out.y[i] = far ? kFar : y;
    out.z[i] = far ? kFar : z;
  }
}

}  // namespace

void March::size(const Mesh& mesh) {
  distance.assign(mesh.px.size(), kFar);
  from.assign(mesh.px.size(), 0);
  reached.reserve(mesh.vertex_count);
  heap.reserve(std::size_t{8} * mesh.vertex_count);
}

void March::clear() {
  for (const std::uint32_t v : reached) distance[v] = kFar;
  reached.clear();
  heap.clear();
}

void clear_offsets(const std::vector<std::uint32_t>& zones, Offsets& offset) {
  for (const std::uint32_t zone : zones) offset.clear(zone);
}

std::vector<Side> sides_of(const Mesh& mesh) {
  std::vector<Side> sides(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const uvec3 c = mesh.triangles[t];
      const vec3 a = mesh.position(c[(i + 1) % 3]), ab = mesh.position(c[(i + 2) % 3]) - a;
      const vec3 av = mesh.position(c[i]) - a;
      const float L = length(ab), x = dot(av, ab) / std::max(L, 1e-30f);
      sides[3 * t + static_cast<std::uint32_t>(i)] = {L, x, length(av - x / std::max(L, 1e-30f) * ab)};
    }
  }
  return sides;
}

void march_distance(const Mesh& mesh, const std::vector<Side>& sides, std::uint32_t triangle, vec3 center, float reach,
                    March& march) {
  std::vector<float>& distance = march.distance;
  std::vector<MarchItem>& heap = march.heap;
  const auto arrived = [&](std::uint32_t v, std::uint32_t t, int corner, float r) {
    if (!(r < reach) || !(r < kShorter * distance[v]) || heap.size() == heap.capacity()) return;
    if (distance[v] == kFar) march.reached.push_back(v);
    distance[v] = r;
    march.from[v] = 3 * t + static_cast<std::uint32_t>(corner);
    heap.push_back({r, v, t});
    std::push_heap(heap.begin(), heap.end(), later);
  };
  const uvec3 start = mesh.triangles[triangle];
  for (int i = 0; i < 3; ++i) arrived(start[i], triangle, i, length(mesh.position(start[i]) - center));
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), later);
    const MarchItem item = heap.back();
    heap.pop_back();
    if (kShorter * item.distance > distance[item.vertex]) continue;  // a shorter path was found meanwhile
    around_vertex(mesh, item.vertex, item.triangle, [&](std::uint32_t t) {
      const uvec3 c = mesh.triangles[t];
      const Side* side = &sides[3 * t];
      for (int i = 0; i < 3; ++i) {
        if (c[i] == item.vertex) continue;
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        const float ra = distance[c[a]], rb = distance[c[b]];
        const float known = kShorter * distance[c[i]];
        // No path over the edge is shorter.
        if (std::min({0.5f * (ra + rb - side[i].length), ra, rb}) + side[i].height > known) continue;
        arrived(c[i], t, i, arrival(side[i], ra, rb, side[b].length, side[a].length));
      }
    });
  }
}

void march_offsets(const Mesh& mesh, const std::vector<Side>& sides, std::uint32_t triangle, const FieldSource& source,
                   March& march, Offsets& offset) {
  march.clear();
  march_distance(mesh, sides, triangle, source.center, 1 / std::sqrt(source.inv_reach2), march);
  const uvec3 start = mesh.triangles[triangle];
  for (const std::uint32_t v : march.reached) {
    const std::uint32_t t = march.from[v] / 3;
    const int corner = static_cast<int>(march.from[v] % 3);
    const float r = march.distance[v];
    const vec3 direct = mesh.position(v) - source.center;
    const bool at_start = t == triangle && v == start[corner] && r == length(direct);
    const vec3 way = at_start ? direct : arrival_at(mesh, march.distance, t, corner).direction;
    // The offset is tangent at v: rotated into its plane with its length kept.
    const vec3 n = mesh.normal(v), o = way - dot(way, n) * n;
    offset.set(v, o * (r / std::max(length(o), 1e-30f)));
  }
}

void arc_offsets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, Offsets& offset) {
  arc_offsets(mesh, mesh.zone_begin(zone), source, offset.zones[zone]);
}

bool fill_offsets(const Mesh& mesh, const SurfaceWays& ways, std::uint32_t triangle, const FieldSource& source,
                  const std::vector<std::uint32_t>& zones, March& march, Offsets& offset) {
  float most = kFar;
  for (int i = 0; i < 3; ++i) most = std::min(most, ways.arc_reach[mesh.triangles[triangle][i]]);
  const bool arcs = most * most * source.inv_reach2 >= 1.0f;
  if (!arcs) march_offsets(mesh, ways.sides, triangle, source, march, offset);
  if (arcs)
    for (const std::uint32_t zone : zones) arc_offsets(mesh, zone, source, offset);
  return arcs;
}

vec4 target_at_offset(const FieldSource& source, vec3 offset, vec3 normal) {
  // The distance already excludes other parts of the surface, so the angle between normals is not tested. Seen from the
  // vertex, the contact is in its tangent plane.
  FieldSource local = source;
  local.center = vec3(0);
  local.normal = normal;
  return target_at(local, offset, normal);
}

}  // namespace pliant
