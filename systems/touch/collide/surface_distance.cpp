#include "systems/touch/collide/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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
// arrive(). `share`: of the opposite edge, where the path crosses it.
struct Crossing {
  float distance, share;
};
Crossing arrival(const TriangleSide& s, float ra, float rb, float la, float lb) {
  const Crossing bent = ra + la <= rb + lb ? Crossing{ra + la, 0} : Crossing{rb + lb, 1};
  if (std::max(ra, rb) == kFar || !(s.length > 0) || !(s.height > 0)) return bent;
  const float sx = 0.5f * (ra * ra - rb * rb + s.length * s.length) / s.length;
  const float sy = std::sqrt(std::max(0.0f, ra * ra - sx * sx));
  const float dx = s.foot - sx, dy = s.height + sy, crossing = sx * dy + dx * sy;  // times dy
  if (crossing < 0 || crossing > s.length * dy) return bent;
  return {std::sqrt(dx * dx + dy * dy), crossing / (s.length * dy)};
}

// Shorter by more than rounding; otherwise two corners could improve each other forever.
constexpr float kShorter = 1 - 1e-5f;

// A chart serves triangles whose edges are shorter than this share of the reach, with corners whose angles miss a full
// turn by less than this [rad].
constexpr double kChartEdge = 0.25, kNearlyFlat = 0.15;
// They lie within this share of the reach of its middle, and the corners between them miss as little in all [rad]: the
// images then err by a few 1e-4 of the distance.
constexpr double kChartSize = 0.2, kChartTurn = 0.01;
// [1] of the reach: a chart extends so much farther, and a place in it is no farther from its middle. kChartRoom: more,
// for dents that get deeper.
constexpr float kChartSpan = 0.23f, kChartRoom = 1.02f;

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

PLIANT_KERNEL void unfold(const Mesh& mesh, std::uint32_t begin, const ZoneChart& chart, vec2 place, float reach2,
                          ZoneOffsets& out) {
  const float* __restrict nx = mesh.nx.data() + begin;
  const float* __restrict ny = mesh.ny.data() + begin;
  const float* __restrict nz = mesh.nz.data() + begin;
  const float px = place.x, py = place.y;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const float x = chart.ix[i] - px, y = chart.iy[i] - py;
    const float ex = chart.ex[i], ey = chart.ey[i], ez = chart.ez[i];
    const bool far = x * x + y * y >= reach2;
    const float ox = x * ex + y * (ny[i] * ez - nz[i] * ey);
    const float oy = x * ey + y * (nz[i] * ex - nx[i] * ez);
    const float oz = x * ez + y * (nx[i] * ey - ny[i] * ex);
    out.x[i] = far ? kFar : ox;
    out.y[i] = far ? kFar : oy;
    out.z[i] = far ? kFar : oz;
  }
}

vec3 middle_of(const Mesh& mesh, std::uint32_t triangle) {
  const uvec3 c = mesh.triangles[triangle];
  return (mesh.position(c.x) + mesh.position(c.y) + mesh.position(c.z)) / 3.0f;
}

// Of a place over a triangle, between the images of its corners.
vec2 image_of(const Mesh& mesh, const Chart& chart, std::uint32_t triangle, vec3 p) {
  const uvec3 c = mesh.triangles[triangle];
  const vec3 a = mesh.position(c.x), ab = mesh.position(c.y) - a, ac = mesh.position(c.z) - a, n = cross(ab, ac);
  const float size2 = std::max(dot(n, n), 1e-30f);
  const float b = dot(cross(p - a, ac), n) / size2, d = dot(cross(ab, p - a), n) / size2;
  vec2 image[3];
  for (int i = 0; i < 3; ++i) {
    const ZoneChart& zone = chart.zones[c[i] / kZoneSize];
    image[i] = {zone.ix[c[i] % kZoneSize], zone.iy[c[i] % kZoneSize]};
  }
  return image[0] + b * (image[1] - image[0]) + d * (image[2] - image[0]);
}

}  // namespace

void March::size(const Mesh& mesh) {
  distance.assign(mesh.px.size(), kFar);
  image.assign(mesh.px.size(), vec2(0));
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

std::vector<TriangleSide> sides_of(const Mesh& mesh) {
  std::vector<TriangleSide> sides(3 * mesh.triangles.size());
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

void march_from(const Mesh& mesh, const std::vector<TriangleSide>& sides, const Chart& chart, float reach,
                March& march) {
  std::vector<float>& distance = march.distance;
  std::vector<MarchItem>& heap = march.heap;
  const auto arrived = [&](std::uint32_t v, std::uint32_t t, int corner, float r, vec2 way) {
    if (!(r < reach) || !(r < kShorter * distance[v]) || heap.size() == heap.capacity()) return;
    if (distance[v] == kFar) march.reached.push_back(v);
    distance[v] = r;
    march.image[v] = way * (r / std::max(length(way), 1e-30f));
    march.from[v] = 3 * t + static_cast<std::uint32_t>(corner);
    heap.push_back({r, v, t});
    std::push_heap(heap.begin(), heap.end(), later);
  };
  const uvec3 start = mesh.triangles[chart.triangle];
  for (int i = 0; i < 3; ++i) {
    const vec3 d = mesh.position(start[i]) - chart.origin;
    arrived(start[i], chart.triangle, i, length(d), {dot(d, chart.x), dot(d, chart.y)});
  }
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), later);
    const MarchItem item = heap.back();
    heap.pop_back();
    if (kShorter * item.distance > distance[item.vertex]) continue;  // a shorter path was found meanwhile
    around_vertex(mesh, item.vertex, item.triangle, [&](std::uint32_t t) {
      const uvec3 c = mesh.triangles[t];
      const TriangleSide* side = &sides[3 * t];
      for (int i = 0; i < 3; ++i) {
        if (c[i] == item.vertex) continue;
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        const float ra = distance[c[a]], rb = distance[c[b]];
        const float known = kShorter * distance[c[i]];
        // No path over the edge is shorter.
        if (std::min({0.5f * (ra + rb - side[i].length), ra, rb}) + side[i].height > known) continue;
        const Crossing crossing = arrival(side[i], ra, rb, side[b].length, side[a].length);
        if (!(crossing.distance < known)) continue;
        const vec2 from_a = ra < kFar ? march.image[c[a]] : vec2(0), from_b = rb < kFar ? march.image[c[b]] : vec2(0);
        arrived(c[i], t, i, crossing.distance, from_a + crossing.share * (from_b - from_a));
      }
    });
  }
}

void Chart::size(const Mesh& mesh) {
  zones.resize(mesh.zone_count());
  has.assign(mesh.zone_count(), 0);
  filled.reserve(mesh.zone_count());
  filled.clear();
  for (ZoneChart& zone : zones) zone.ix.fill(kFar);
  triangle = kBorder;
}

void march_chart(const Mesh& mesh, const std::vector<TriangleSide>& sides, std::uint32_t triangle, vec3 origin,
                 float reach, March& march, Chart& chart) {
  for (const std::uint32_t zone : chart.filled) {
    chart.zones[zone].ix.fill(kFar);
    chart.has[zone] = 0;
  }
  chart.filled.clear();
  const uvec3 start = mesh.triangles[triangle];
  const vec3 ab = mesh.position(start.y) - mesh.position(start.x), ac = mesh.position(start.z) - mesh.position(start.x);
  chart.triangle = triangle;
  chart.reach = reach;
  chart.origin = origin;
  chart.x = ab / std::max(length(ab), 1e-30f);
  const vec3 up = cross(ab, ac);
  chart.y = cross(up / std::max(length(up), 1e-30f), chart.x);
  march.clear();
  march_from(mesh, sides, chart, reach, march);
  for (const std::uint32_t v : march.reached) {
    const std::uint32_t t = march.from[v] / 3, zone = v / kZoneSize, i = v % kZoneSize;
    const int corner = static_cast<int>(march.from[v] % 3);
    const float r = march.distance[v];
    const vec2 image = march.image[v];
    const vec3 direct = mesh.position(v) - origin;
    const bool at_start = t == triangle && v == start[corner] && r == length(direct);
    const vec3 way = at_start ? direct : arrival_at(mesh, march.distance, t, corner).direction;
    // The path arrives tangent to the surface, under the angle at which it left.
    const vec3 n = mesh.normal(v), flat = way - dot(way, n) * n;
    const vec3 o = flat / std::max(length(flat), 1e-30f);
    const vec3 e = (image.x * o - image.y * cross(n, o)) / std::max(r, 1e-30f);
    ZoneChart& out = chart.zones[zone];
    if (!chart.has[zone]) chart.filled.push_back(zone);  // capacity: all
    chart.has[zone] = 1;
    out.ix[i] = image.x, out.iy[i] = image.y;
    out.ex[i] = e.x, out.ey[i] = e.y, out.ez[i] = e.z;
  }
}

void arc_offsets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, Offsets& offset) {
  arc_offsets(mesh, mesh.zone_begin(zone), source, offset.zones[zone]);
}

void chart_offsets(const Mesh& mesh, std::uint32_t zone, const FieldSource& source, vec2 place, const Chart& chart,
                   Offsets& offset) {
  unfold(mesh, mesh.zone_begin(zone), chart.zones[zone], place, 1 / source.inv_reach2, offset.zones[zone]);
}

std::vector<std::uint32_t> chart_hubs(const Mesh& mesh, double reach) {
  std::vector<double> turn(mesh.vertex_count, 2 * std::numbers::pi);  // [rad] by which the triangles miss a full turn
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const uvec3 c = mesh.triangles[t];
      const dvec3 a(mesh.position(c[i])), b = dvec3(mesh.position(c[(i + 1) % 3])) - a,
                                          d = dvec3(mesh.position(c[(i + 2) % 3])) - a;
      turn[c[i]] -= std::atan2(length(cross(b, d)), dot(b, d));
    }
  }
  const auto serves = [&](std::uint32_t t) {
    const uvec3 c = mesh.triangles[t];
    for (int i = 0; i < 3; ++i) {
      const vec3 edge = mesh.position(c[(i + 1) % 3]) - mesh.position(c[i]);
      if (std::abs(turn[c[i]]) >= kNearlyFlat || double(length(edge)) >= kChartEdge * reach) return false;
    }
    return true;
  };
  std::vector<std::uint32_t> hubs(mesh.triangles.size(), kBorder), seen(mesh.vertex_count, kBorder), group;
  for (std::uint32_t hub = 0; hub < mesh.triangles.size(); ++hub) {
    if (hubs[hub] != kBorder || !serves(hub)) continue;
    const vec3 middle = middle_of(mesh, hub);
    double turned = 0.0;
    for (int i = 0; i < 3; ++i) seen[mesh.triangles[hub][i]] = hub;
    hubs[hub] = hub;
    group.assign(1, hub);
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (int edge = 0; edge < 3; ++edge) {
        const std::uint32_t t = mesh.across[group[k]][edge];
        if (t == kBorder || hubs[t] != kBorder || !serves(t)) continue;
        double more = turned;
        bool near = true;
        for (int i = 0; i < 3; ++i) {
          const std::uint32_t v = mesh.triangles[t][i];
          if (seen[v] == hub) continue;
          more += std::abs(turn[v]);
          near = near && double(length(mesh.position(v) - middle)) < kChartSize * reach;
        }
        if (!near || more > kChartTurn) continue;
        turned = more;
        for (int i = 0; i < 3; ++i) seen[mesh.triangles[t][i]] = hub;
        hubs[t] = hub;
        group.push_back(t);
      }
    }
  }
  return hubs;
}

bool fill_offsets(const Mesh& mesh, const SurfaceWays& ways, std::uint32_t triangle, const FieldSource& source,
                  const std::vector<std::uint32_t>& zones, March& march, Chart& chart, Offsets& offset) {
  float most = kFar;
  for (int i = 0; i < 3; ++i) most = std::min(most, ways.arc_reach[mesh.triangles[triangle][i]]);
  const bool arcs = most * most * source.inv_reach2 >= 1.0f;
  if (arcs) {
    for (const std::uint32_t zone : zones) arc_offsets(mesh, zone, source, offset);
    return true;
  }
  const float reach = 1 / std::sqrt(source.inv_reach2);
  const std::uint32_t hub = ways.hubs[triangle];
  vec2 place(kFar);
  if (hub != kBorder) {
    const float least = (1 + kChartSpan) * reach;
    const vec3 middle = middle_of(mesh, hub);
    if (chart.triangle != hub || chart.origin != middle || chart.reach < least)
      march_chart(mesh, ways.sides, hub, middle, kChartRoom * least, march, chart);
    place = image_of(mesh, chart, triangle, source.center);
  }
  if (!(length(place) <= kChartSpan * reach)) {
    march_chart(mesh, ways.sides, triangle, source.center, reach, march, chart);
    place = vec2(0);
  }
  for (const std::uint32_t zone : zones) chart_offsets(mesh, zone, source, place, chart, offset);
  return false;
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
