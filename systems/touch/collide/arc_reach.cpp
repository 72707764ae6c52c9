#include "systems/touch/collide/arc_reach.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/parallel.h"
#include "systems/touch/collide/surface_distance.h"
#include "systems/touch/model/dent.h"

namespace pliant {
namespace {

// Differences between closed form and march: over a ring (RMS), as a share of its distance or half the reach, and at
// one vertex, as a share of the reach. [1]
constexpr float kAgrees = 8e-4f, kAgreesAtMost = 1e-2f;
constexpr std::size_t kRings = 16;
// [1] largest difference between the slopes of an edge against the tangent planes at its two ends: zero on a sphere.
// Normals that differ more do not determine the slope at a distance.
constexpr float kSmooth = 0.05f;
// [1] of the reach: longest edge. Between distant vertices nothing is compared; a march over few is fast.
constexpr float kLongest = 0.25f;
// [1] of the reach: one comparison serves the places up to this distance.
constexpr float kServes = 0.7f;
// [1] of the reach: the least that a comparison decides.
constexpr float kLeastServed = 0.125f;
constexpr std::size_t kLeastCompared = 64 * kZoneSize, kMostRuns = 16;  // vertices a thread takes; runs

float square(float x) {
  return x * x;
}

class Comparison {
 public:
  Comparison(const Mesh& mesh, const std::vector<TriangleSide>& sides, const ObjectState& object, float reach)
      : mesh_(mesh), sides_(sides), reach_(reach) {
    march_.size(mesh);
    offset_.size(mesh);
    object_.cracks = object.cracks;
    object_.visited.assign(mesh.zone_count(), 0);
    zones_.reserve(mesh.zone_count());
  }
  // Least distance from vertex v at which the two differ, at most `limit`. [m]
  float differs(std::uint32_t v, std::uint32_t triangle, float limit) {
    FieldSource source;
    source.center = mesh_.position(v);
    source.normal = mesh_.normal(v);
    const std::uint32_t own[] = {v / kZoneSize};
    march_.clear();
    start_.triangle = triangle;
    start_.origin = source.center;
    march_from(mesh_, sides_, start_, limit, march_);
    flood(mesh_, source.center, limit, own, object_, zones_);
    std::array<double, kRings> squares{}, count{};
    float least = limit;
    for (const std::uint32_t zone : zones_) {
      arc_offsets(mesh_, zone, source, offset_);
      for (std::uint32_t w = mesh_.zone_begin(zone); w < mesh_.zone_end(zone); ++w) {
        if (mesh_.area[w] == 0.0f) continue;
        const float marched = std::min(march_.distance[w], limit), arc = std::min(length(offset_[w]), limit);
        const float nearer = std::min(marched, arc), apart = std::abs(marched - arc);
        if (apart > kAgreesAtMost * std::max(0.5f * reach_, nearer)) least = std::min(least, nearer);
        const auto ring = std::min(kRings - 1, static_cast<std::size_t>(kRings * nearer / limit));
        squares[ring] += apart * apart;
        count[ring] += nearer < limit;
      }
    }
    for (std::size_t ring = 0; ring < kRings; ++ring)
      if (squares[ring] >
          square(kAgrees * std::max(0.5f * reach_, limit * static_cast<float>(ring) / kRings)) * count[ring])
        least = std::min(least, limit * static_cast<float>(ring) / kRings);
    return least;
  }
  const March& march() const { return march_; }

 private:
  const Mesh& mesh_;
  const std::vector<TriangleSide>& sides_;
  float reach_;
  March march_;
  Chart start_;  // only its triangle and origin
  Offsets offset_;
  ObjectState object_;  // only for its flood
  std::vector<std::uint32_t> zones_;
};

// Around edges that are long or whose normals do not determine the surface.
std::vector<std::uint8_t> rough_vertices(const Mesh& mesh, float reach) {
  std::vector<std::uint8_t> rough(mesh.vertex_count, 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const std::uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][j];
      const vec3 d = mesh.position(b) - mesh.position(a);
      const float l = length(d);
      if (l > kLongest * reach || std::abs(dot(mesh.normal(t, i) + mesh.normal(t, j), d)) > kSmooth * l)
        rough[a] = rough[b] = 1;
    }
  }
  return rough;
}

}  // namespace

std::vector<float> arc_reach(const Mesh& mesh, const std::vector<TriangleSide>& sides, const ObjectState& object,
                             double most) {
  const float reach = static_cast<float>(most), limit = (1 + kServes) * reach;
  std::vector<float> out(mesh.px.size(), 0.0f);
  std::vector<std::uint32_t> around(mesh.vertex_count, kBorder);  // a triangle at the vertex
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) around[mesh.triangles[t][i]] = t;
  const std::vector<std::uint8_t> rough = rough_vertices(mesh, reach);
  const std::size_t part = std::max<std::size_t>(kLeastCompared, mesh.vertex_count / kMostRuns);
  parallel_for(mesh.vertex_count, part, [&](std::size_t begin, std::size_t end) {
    Comparison comparison(mesh, sides, object, reach);
    std::vector<std::uint8_t> decided(rough.begin() + static_cast<std::ptrdiff_t>(begin),
                                      rough.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t v = begin; v < end; ++v) {
      if (decided[v - begin] || around[v] == kBorder) continue;
      float differs = 0;
      for (const float step : {0.25f * reach, 0.5f * reach, reach, limit}) {
        differs = comparison.differs(static_cast<std::uint32_t>(v), around[v], step);
        if (differs < step) break;
      }
      // From a place at distance d the two differ between differs - d and differs + d.
      for (const std::uint32_t w : comparison.march().reached) {
        const float d = comparison.march().distance[w], holds = differs - d;
        if (w < begin || w >= end || decided[w - begin]) continue;
        if (w != v && holds < reach && d > std::max(kLeastServed * reach, reach - differs)) continue;
        decided[w - begin] = 1;
        out[w] = std::max(holds, 0.0f);
      }
    }
  });
  return out;
}

}  // namespace pliant
