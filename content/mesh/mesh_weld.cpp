#include "content/mesh/mesh_weld.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "content/mesh/flush_walls.h"
#include "content/mesh/hilbert.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr std::size_t kWeldGrain = 1 << 14;
constexpr std::size_t kMostVertices = std::size_t{1} << 28, kMostTriangles = std::size_t{1} << 29;

constexpr float kFarthestCell = 1e9f;  // [m] beyond it, products of lengths overflow single precision

// False for NaN too.
bool reasonable(vec3 p) {
  return std::abs(p.x) <= kFarthestCell && std::abs(p.y) <= kFarthestCell && std::abs(p.z) <= kFarthestCell;
}

bool before(vec3 a, vec3 b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

bool before(uvec3 a, uvec3 b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

// Sorts each run of equal keys by `less` (given two indices); longer runs are rare.
template <class Less>
void sort_runs(std::vector<HilbertItem>& items, Less less) {
  for (std::size_t begin = 0; begin < items.size();) {
    std::size_t end = begin + 1;
    while (end < items.size() && items[end].key == items[begin].key) ++end;
    if (end - begin > 1)
      std::sort(items.begin() + static_cast<std::ptrdiff_t>(begin), items.begin() + static_cast<std::ptrdiff_t>(end),
                [&](const HilbertItem& a, const HilbertItem& b) { return less(a.index, b.index); });
    begin = end;
  }
}

uvec3 sorted(uvec3 t) {
  if (t.x > t.y) std::swap(t.x, t.y);
  if (t.y > t.z) std::swap(t.y, t.z);
  if (t.x > t.y) std::swap(t.x, t.y);
  return t;
}

// The parity of the corners' order: equal for rotations, different for a reversal.
bool even(uvec3 t) {
  return (t.x < t.y) + (t.y < t.z) + (t.z < t.x) == 2;
}

// Flat: its height over the longest side is below single precision at the object's scale.
bool flat(dvec3 a, dvec3 b, dvec3 c, double resolution) {
  const dvec3 ab = b - a, bc = c - b, ca = a - c;
  const double longest = std::sqrt(std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)}));
  return length(cross(ab, -ca)) <= resolution * longest;
}

// Source vertices used by triangles, along the curve, with copies of a position next to each other.
std::vector<std::uint32_t> order_vertices(const Gathered& gathered) {
  std::vector<std::uint8_t> used(gathered.position.size(), 0);
  for (const uvec3& t : gathered.triangle) used[t.x] = used[t.y] = used[t.z] = 1;
  std::vector<std::uint32_t> source;
  std::vector<vec3> position;
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    source.push_back(v);
    position.push_back(gathered.position[v]);
  }
  std::vector<HilbertItem> items = hilbert_sort(position);
  sort_runs(items, [&](std::uint32_t a, std::uint32_t b) {
    return position[a] == position[b] ? a < b : before(position[a], position[b]);
  });
  std::vector<std::uint32_t> order(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) order[i] = source[items[i].index];
  return order;
}

// Source triangles that are not degenerate, with welded corners.
struct Kept {
  std::vector<uvec3> triangle;
  std::vector<std::uint32_t> source;
  std::vector<vec3> centroid;  // [m] summed in the order of the sorted corners, so that duplicates agree bit for bit
};
Kept drop_degenerate(const Gathered& gathered, const Welded& welded, MeshReport& report) {
  float extent = 0.0f;
  for (const vec3& p : welded.position) extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const double resolution = extent * 0x1p-23;

  Kept kept;
  kept.triangle.reserve(gathered.triangle.size());
  kept.source.reserve(gathered.triangle.size());
  kept.centroid.reserve(gathered.triangle.size());
  for (std::uint32_t i = 0; i < gathered.triangle.size(); ++i) {
    const uvec3 s = gathered.triangle[i];
    const uvec3 t{welded.touch_vertex[s.x], welded.touch_vertex[s.y], welded.touch_vertex[s.z]};
    const vec3 a = welded.position[t.x], b = welded.position[t.y], c = welded.position[t.z];
    if (t.x == t.y || t.y == t.z || t.z == t.x || flat(dvec3(a), dvec3(b), dvec3(c), resolution)) {
      ++report.degenerate_triangles;
      continue;
    }
    const uvec3 o = sorted(t);
    const dvec3 sum = dvec3(welded.position[o.x]) + dvec3(welded.position[o.y]) + dvec3(welded.position[o.z]);
    kept.triangle.push_back(t);
    kept.source.push_back(i);
    kept.centroid.push_back(vec3(sum / 3.0));
  }
  return kept;
}

void drop_flush_walls(Welded& welded, std::vector<std::uint32_t>& back, MeshReport& report) {
  std::vector<std::uint8_t> two_sided(back.size());
  for (std::size_t t = 0; t < back.size(); ++t) two_sided[t] = back[t] != kNoVertex;
  const std::vector<std::uint8_t> wall = flush_walls(welded.position, welded.triangle, two_sided);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < back.size(); ++t) {
    if (wall[t]) continue;
    welded.triangle[kept] = welded.triangle[t];
    welded.source_triangle[kept] = welded.source_triangle[t];
    back[kept++] = back[t];
  }
  const auto dropped = static_cast<std::uint32_t>(back.size() - kept);
  report.flush_walls = dropped;
  report.duplicate_triangles -= dropped;
  welded.triangle.resize(kept);
  welded.source_triangle.resize(kept);
  back.resize(kept);
}

// Of triangles with the same corners, the first in the file is kept; a reversed one is still drawn. Walls at which
// parts of a touched body are flush are dropped.
void order_triangles(const Kept& kept, bool touched, Welded& welded, MeshReport& report) {
  std::vector<HilbertItem> items = hilbert_sort(kept.centroid);
  sort_runs(items, [&](std::uint32_t a, std::uint32_t b) {
    const uvec3 ta = sorted(kept.triangle[a]), tb = sorted(kept.triangle[b]);
    return ta == tb ? a < b : before(ta, tb);
  });
  welded.triangle.reserve(items.size());
  welded.source_triangle.reserve(items.size());
  std::vector<std::uint32_t> back;  // of each triangle, kNoVertex: none
  uvec3 previous(kNoVertex);
  for (const HilbertItem& item : items) {
    const uvec3 t = kept.triangle[item.index], corners = sorted(t);
    if (corners != previous) {
      welded.triangle.push_back(t);
      welded.source_triangle.push_back(kept.source[item.index]);
      back.push_back(kNoVertex);
      previous = corners;
      continue;
    }
    ++report.duplicate_triangles;
    if (back.back() == kNoVertex && even(t) != even(welded.triangle.back())) back.back() = kept.source[item.index];
  }
  if (touched) drop_flush_walls(welded, back, report);
  std::copy_if(back.begin(), back.end(), std::back_inserter(welded.backs),
               [](std::uint32_t source) { return source != kNoVertex; });
}

// Removes vertices that only dropped triangles used; the rest keep their order.
void drop_unused(Welded& welded) {
  std::vector<std::uint32_t> moved(welded.position.size(), kNoVertex);
  for (const uvec3& t : welded.triangle) moved[t.x] = moved[t.y] = moved[t.z] = 0;
  std::uint32_t count = 0;
  for (std::uint32_t v = 0; v < moved.size(); ++v) {
    if (moved[v] == kNoVertex) continue;
    moved[v] = count;
    welded.position[count++] = welded.position[v];
  }
  welded.position.resize(count);
  if (count == moved.size()) return;

  for (uvec3& t : welded.triangle) t = {moved[t.x], moved[t.y], moved[t.z]};
  for (std::uint32_t& v : welded.touch_vertex)
    if (v != kNoVertex) v = moved[v];
  std::erase_if(welded.sources, [&](std::uint32_t source) { return welded.touch_vertex[source] == kNoVertex; });
}

}  // namespace

Result<Gathered> gather(const std::string& name, std::span<const Primitive> primitives, const mat4& to_object) {
  const Error malformed{"mesh `" + name + "`", "a triangle names a vertex that does not exist",
                        "repair or re-export the file"};
  std::size_t vertices = 0, triangles = 0;
  for (const Primitive& p : primitives) {
    vertices += p.position.size();
    triangles += p.index.size() / 3;
    if (p.index.size() % 3 != 0) return malformed;
  }
  if (vertices > kMostVertices || triangles > kMostTriangles)
    return Error{"mesh `" + name + "`", "more than 2^28 vertices or 2^29 triangles", "split or simplify it"};

  const dmat4 m(to_object);
  const bool mirrors = glm::determinant(dmat3(m)) < 0.0;
  Gathered all;
  all.position.resize(vertices);
  all.triangle.reserve(triangles);
  all.primitive.reserve(triangles);
  std::size_t first = 0;
  for (std::uint32_t n = 0; n < primitives.size(); ++n) {
    const Primitive& p = primitives[n];
    parallel_for(p.position.size(), kWeldGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        all.position[first + v] = vec3(m * glm::dvec4(dvec3(p.position[v]), 1.0)) + vec3(0.0f);
    });
    const auto offset = static_cast<std::uint32_t>(first);
    for (std::size_t i = 0; i < p.index.size(); i += 3) {
      uvec3 t{p.index[i], p.index[i + 1], p.index[i + 2]};
      if (std::max({t.x, t.y, t.z}) >= p.position.size()) return malformed;
      if (mirrors) std::swap(t.y, t.z);
      all.triangle.push_back(t + offset);
    }
    all.primitive.resize(all.triangle.size(), n);
    all.first_vertex.push_back(offset);
    first += p.position.size();
  }
  all.first_vertex.push_back(static_cast<std::uint32_t>(first));
  for (const vec3& p : all.position)
    if (!reasonable(p))
      return Error{"mesh `" + name + "`", "a vertex position is not a finite number within 1e9 m",
                   "repair the file, or scale it down"};
  return all;
}

Welded weld(const Gathered& gathered, bool touched, MeshReport& report) {
  Welded welded;
  welded.sources = order_vertices(gathered);
  welded.touch_vertex.assign(gathered.position.size(), kNoVertex);
  for (const std::uint32_t source : welded.sources) {
    const vec3 p = gathered.position[source];
    if (welded.position.empty() || welded.position.back() != p) welded.position.push_back(p);
    welded.touch_vertex[source] = static_cast<std::uint32_t>(welded.position.size() - 1);
  }
  report.welded_vertices = static_cast<std::uint32_t>(welded.sources.size() - welded.position.size());

  order_triangles(drop_degenerate(gathered, welded, report), touched, welded, report);
  drop_unused(welded);
  return welded;
}

}  // namespace pliant
