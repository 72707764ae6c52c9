#include "editor/paint/paint_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "content/mesh/touch_mesh.h"
#include "runtime/disjoint_sets.h"
#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

// A frame whose volume is below this share of its longest axis cubed is degenerate.
constexpr double kFlat = 1e-12;

bool flattens(const dmat3& frame) {
  const double longest = std::max({length(frame[0]), length(frame[1]), length(frame[2])});
  return !(std::abs(glm::determinant(frame)) > kFlat * longest * longest * longest) || !std::isfinite(longest);
}

}  // namespace

Result<PaintSurface> PaintSurface::make(const LevelMesh& mesh, const dmat3& frame, const std::atomic<bool>* stop) {
  if (flattens(frame))
    return Error{"mesh `" + mesh.name + "`", "its node's scale makes it flat",
                 "give it a scale other than 0 on each axis"};
  Result<TouchMesh> touch = build_touch_mesh(mesh.name, mesh.primitives, mat4(dmat4(frame)), {}, stop);
  if (!touch) return touch.error();
  const auto stops = [&] { return stop != nullptr && stop->load(std::memory_order_relaxed); };
  const Error stopped{"mesh `" + mesh.name + "`", "reading it was stopped"};

  PaintSurface surface;
  surface.mesh_ = std::move(touch->mesh);
  surface.frame_ = frame;
  surface.report_ = touch->report;
  surface.mesh_.tree = build_tree(surface.mesh_);
  if (stops()) return stopped;
  surface.find_sources(touch->gathered, touch->welded);
  if (!surface.mesh_.crease.empty()) surface.smooth_ = split_at_creases(surface.mesh_, touch->corners);
  surface.whole_.corners = std::move(touch->corners);
  if (stops()) return stopped;
  surface.find_parts();
  return surface;
}

void PaintSurface::find_sources(const Gathered& gathered, const Welded& welded) {
  first_vertex_ = gathered.first_vertex;
  std::vector<std::uint32_t> first_triangle(primitive_count(), 0);  // gathered primitive by primitive
  for (std::uint32_t t = static_cast<std::uint32_t>(gathered.primitive.size()); t-- > 0;)
    first_triangle[gathered.primitive[t]] = t;
  for (const std::uint32_t source : welded.source_triangle) {
    const std::uint32_t primitive = gathered.primitive[source];
    source_triangle_.push_back({primitive, source - first_triangle[primitive]});
  }
  // `sources` is ordered by welded vertex.
  source_first_.assign(mesh_.vertex_count + 1, 0);
  for (const std::uint32_t source : welded.sources) {
    ++source_first_[welded.touch_vertex[source] + 1];
    const auto next = std::upper_bound(first_vertex_.begin(), first_vertex_.end(), source);
    const auto primitive = static_cast<std::uint32_t>(next - first_vertex_.begin() - 1);
    sources_.push_back({primitive, source - first_vertex_[primitive]});
  }
  std::partial_sum(source_first_.begin(), source_first_.end(), source_first_.begin());
}

PaintSurface::Topology PaintSurface::split_at_creases(const Mesh& mesh, const Corners& corners) {
  // Corners at one vertex are connected across edges that are not creases.
  Topology out;
  out.triangle = mesh.triangles;
  out.vertex.resize(mesh.vertex_count);
  std::iota(out.vertex.begin(), out.vertex.end(), 0u);
  std::vector<std::uint32_t> fan;  // of each corner around the vertex: the place of the first of its fan
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const std::uint32_t begin = corners.first[v], count = corners.first[v + 1] - begin;
    DisjointSets fans(count);
    for (std::uint32_t a = 0; a < count; ++a) {
      const std::uint32_t t = corners.corner[begin + a] / 3;
      const auto edge = static_cast<int>(corners.corner[begin + a] % 3);  // from the vertex; its other end has the same
      if (mesh.across[t][edge] == kBorder || mesh.is_crease(t, edge)) continue;
      for (std::uint32_t b = 0; b < count; ++b)
        if (corners.corner[begin + b] / 3 == mesh.across[t][edge]) fans.join(a, b);
    }
    fan.assign(count, SurfaceHit::kNone);
    for (std::uint32_t a = 0; a < count; ++a) {
      std::uint32_t& node = fan[fans.find(a)];
      if (node == SurfaceHit::kNone) {
        node = a == 0 ? v : static_cast<std::uint32_t>(out.vertex.size());
        if (a != 0) out.vertex.push_back(v);
      }
      const std::uint32_t corner = corners.corner[begin + a];
      out.triangle[corner / 3][static_cast<int>(corner % 3)] = node;
    }
  }
  Mesh nodes;  // only what corners_of reads
  nodes.vertex_count = static_cast<std::uint32_t>(out.vertex.size());
  nodes.triangles = std::move(out.triangle);
  out.corners = corners_of(nodes);
  out.triangle = std::move(nodes.triangles);
  return out;
}

void PaintSurface::find_parts() {
  DisjointSets sets(mesh_.vertex_count);
  for (const uvec3& t : mesh_.triangles) sets.join(t.x, t.y), sets.join(t.y, t.z);
  part_.resize(mesh_.vertex_count);
  for (std::uint32_t v = 0; v < mesh_.vertex_count; ++v) {
    const std::uint32_t root = sets.find(v);
    part_[v] = root == v ? part_count_++ : part_[root];
  }
}

std::optional<std::uint32_t> PaintSurface::welded(SourceVertex source) const {
  ASSERT(source.primitive < primitive_count() && source.index < vertices_of(source.primitive));
  const std::uint32_t v = mesh_.of_source[first_vertex_[source.primitive] + source.index];
  return v == kBorder ? std::nullopt : std::optional(v);
}

SurfaceHit PaintSurface::at(std::uint32_t triangle, const dvec3& barycentric) const {
  const uvec3 t = mesh_.triangles[triangle];
  const dvec3 a(mesh_.position(t.x)), b(mesh_.position(t.y)), c(mesh_.position(t.z));
  SurfaceHit hit;
  hit.triangle = triangle;
  hit.source = source_triangle_[triangle];
  hit.barycentric = barycentric;
  hit.point = barycentric.x * a + barycentric.y * b + barycentric.z * c;
  hit.normal = normalize(cross(b - a, c - a));
  return hit;
}

SurfaceHit PaintSurface::hit(const Ray& ray, bool both_sides) const {
  const double size = length(ray.direction);
  if (!(size > 0.0) || !std::isfinite(size + length(ray.origin))) return {};
  const dvec3 along = ray.direction / size;
  // Only the segment of the ray that can hit the mesh: a sphere around its box.
  const dvec3 center(mesh_.box.center());
  const double half = 0.5 * static_cast<double>(mesh_.box.diagonal()) * 1.001, middle = dot(center - ray.origin, along);
  const double begin = std::max(0.0, middle - half), end = middle + half;
  if (!(end > begin)) return {};
  const dvec3 from = ray.origin + begin * along, to = ray.origin + end * along, d = to - from;

  struct Meeting {
    double fraction = 2.0;
    std::uint32_t triangle = SurfaceHit::kNone;
    dvec3 barycentric{1, 0, 0};
  } front, back;
  visit_along(
      mesh_, from, to, [&] { return both_sides ? std::min(front.fraction, back.fraction) : front.fraction; },
      [&](std::uint32_t triangle) {
        // Moeller & Trumbore 1997.
        const uvec3 t = mesh_.triangles[triangle];
        const dvec3 a(mesh_.position(t.x)), e(dvec3(mesh_.position(t.y)) - a), f(dvec3(mesh_.position(t.z)) - a);
        const dvec3 p = cross(d, f);
        const double volume = dot(e, p);  // > 0: hit from outside
        if (volume == 0.0) return;
        const dvec3 s = from - a, q = cross(s, e);
        const double u = dot(s, p) / volume, v = dot(d, q) / volume, fraction = dot(f, q) / volume;
        constexpr double kRim = -1e-12;  // an edge belongs to both sides
        if (u < kRim || v < kRim || u + v > 1.0 - kRim || fraction < 0.0 || fraction > 1.0) return;
        Meeting& best = volume > 0.0 ? front : back;
        if (fraction < best.fraction || (fraction == best.fraction && triangle < best.triangle))
          best = {fraction, triangle, {1.0 - u - v, u, v}};
      });
  const bool from_behind = both_sides ? back.fraction < front.fraction : front.triangle == SurfaceHit::kNone;
  const Meeting& met = from_behind ? back : front;
  if (met.triangle == SurfaceHit::kNone) return {};
  SurfaceHit found = at(met.triangle, met.barycentric);
  found.back = from_behind;
  return found;
}

SurfaceHit PaintSurface::closest(dvec3 point, double within) const {
  const FlatPoint flat = closest_flat(mesh_, point, within);
  return flat.valid() ? at(flat.triangle, flat.barycentric) : SurfaceHit{};
}

}  // namespace pliant
