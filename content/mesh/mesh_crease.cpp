#include "content/mesh/mesh_crease.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "content/mesh/mesh_draw.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr std::size_t kCreaseGrain = 1 << 13;
constexpr double kLeastPoint = 0.4;   // [rad] half-angles of cones to 67 degrees
constexpr double kMostOfPoint = 0.1;  // [1] on a dome it is a half

dvec3 face_normal(const Mesh& mesh, std::uint32_t triangle) {
  const uvec3 t = mesh.triangles[triangle];
  const dvec3 a(mesh.position(t.x));
  return cross(dvec3(mesh.position(t.y)) - a, dvec3(mesh.position(t.z)) - a);
}

// [rad] Angle between two vectors of any length.
double turn(dvec3 a, dvec3 b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

// Crease information from the file's normals: an edge is a crease if the vertex copies on its two sides have different
// normals.
class FileNormals {
 public:
  FileNormals(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
              const Welded& welded, const Mesh& mesh)
      : primitives_(primitives), gathered_(gathered), welded_(welded), mesh_(mesh), to_(to_object) {}

  bool known(std::uint32_t triangle) const {
    const Primitive& p = primitives_[gathered_.primitive[welded_.source_triangle[triangle]]];
    return !p.normal.empty() && p.normal.size() == p.position.size();
  }
  bool split(std::uint32_t triangle, std::uint32_t other, std::uint32_t vertex) const {
    return turn(at(triangle, vertex), at(other, vertex)) > kSplitNormals;
  }

 private:
  dvec3 at(std::uint32_t triangle, std::uint32_t vertex) const {
    const uvec3 t = mesh_.triangles[triangle];
    const int corner = t.x == vertex ? 0 : t.y == vertex ? 1 : 2;
    const std::uint32_t source = welded_.source_triangle[triangle], n = gathered_.primitive[source];
    return to_.normal * dvec3(primitives_[n].normal[gathered_.triangle[source][corner] - gathered_.first_vertex[n]]);
  }

  std::span<const Primitive> primitives_;
  const Gathered& gathered_;
  const Welded& welded_;
  const Mesh& mesh_;
  const Directions to_;
};

// The corners around a vertex, grouped in fans between creases and borders.
class Fans {
 public:
  void find(const Mesh& mesh, const Corners& corners, std::uint32_t vertex) {
    begin_ = corners.corner.data() + corners.first[vertex];
    count_ = corners.first[vertex + 1] - corners.first[vertex];
    root_.resize(count_);
    for (std::uint32_t c = 0; c < count_; ++c) root_[c] = c;
    for (std::uint32_t c = 0; c < count_; ++c) {
      // Only forwards: the edge leaving the vertex here arrives at it in the neighbour triangle.
      const std::uint32_t t = begin_[c] / 3;
      const int i = static_cast<int>(begin_[c] % 3);
      const std::uint32_t other = mesh.across[t][i];
      if (other == kBorder || mesh.is_crease(t, i)) continue;
      const auto* found = std::lower_bound(begin_, begin_ + count_, 3 * other);
      join(c, static_cast<std::uint32_t>(found - begin_));
    }
  }
  std::uint32_t count() const { return count_; }
  std::uint32_t corner(std::uint32_t c) const { return begin_[c]; }
  std::uint32_t fan(std::uint32_t c) {  // the lowest corner of the fan
    while (root_[c] != c) c = root_[c] = root_[root_[c]];
    return c;
  }

 private:
  void join(std::uint32_t a, std::uint32_t b) {
    a = fan(a);
    b = fan(b);
    root_[std::max(a, b)] = std::min(a, b);
  }

  const std::uint32_t* begin_ = nullptr;  // ascending, so a triangle's corner is found by bisection
  std::uint32_t count_ = 0;
  std::vector<std::uint32_t> root_;
};

bool at_crease(const Mesh& mesh, const Corners& corners, std::uint32_t vertex) {
  for (std::uint32_t c = corners.first[vertex]; c < corners.first[vertex + 1]; ++c) {
    const std::uint32_t i = corners.corner[c] % 3;
    if (mesh.crease[corners.corner[c] / 3] & (1u << i | 1u << (i + 2) % 3)) return true;
  }
  return false;
}

void split_fans(const Corners& corners, Mesh& mesh) {
  std::vector<std::uint8_t> creased(mesh.vertex_count, 0);
  parallel_for(mesh.vertex_count, kCreaseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) creased[v] = at_crease(mesh, corners, static_cast<std::uint32_t>(v));
  });

  // Each triangle at such a vertex gets an entry, filled with the normals of its vertices.
  mesh.split_normals.assign(mesh.triangles.size(), kNotSplit);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const uvec3 corner = mesh.triangles[t];
    if (!creased[corner.x] && !creased[corner.y] && !creased[corner.z]) continue;
    mesh.split_normals[t] = static_cast<std::uint32_t>(mesh.corner_normal.size());
    for (int i = 0; i < 3; ++i) mesh.corner_normal.push_back(mesh.normal(corner[i]));
  }
  parallel_for(mesh.vertex_count, kCreaseGrain, [&](std::size_t begin, std::size_t end) {
    Fans fans;
    std::vector<NormalSum> sums;
    for (std::size_t v = begin; v < end; ++v) {
      if (!creased[v]) continue;
      fans.find(mesh, corners, static_cast<std::uint32_t>(v));
      sums.assign(fans.count(), {});
      for (std::uint32_t c = 0; c < fans.count(); ++c) sums[fans.fan(c)].add(mesh, fans.corner(c));
      for (std::uint32_t c = 0; c < fans.count(); ++c) {
        const std::uint32_t corner = fans.corner(c);
        mesh.corner_normal[mesh.split_normals[corner / 3] + corner % 3] = sums[fans.fan(c)].normal();
      }
    }
  });
}

// Whether the triangles around a vertex are the sides of a cone: all of them are turned from its normal, and from the
// mean normal of their other corners much less. On a dome they lie halfway between.
bool at_point(const Mesh& mesh, const Corners& corners, std::uint32_t vertex) {
  if (corners.first[vertex] == corners.first[vertex + 1]) return false;
  for (std::uint32_t c = corners.first[vertex]; c < corners.first[vertex + 1]; ++c) {
    const std::uint32_t t = corners.corner[c] / 3;
    const int i = static_cast<int>(corners.corner[c] % 3), j = (i + 1) % 3, k = (i + 2) % 3;
    if (mesh.is_crease(t, i) || mesh.is_crease(t, k)) return false;
    const dvec3 n = face_normal(mesh, t);
    const double turned = turn(n, dvec3(mesh.normal(t, i)));
    if (turned < kLeastPoint || turn(n, dvec3(mesh.normal(t, j)) + dvec3(mesh.normal(t, k))) > kMostOfPoint * turned)
      return false;
  }
  return true;
}

// Around the point of a cone each triangle keeps its own normal: a patch through their mean would bulge between the
// edges, and the cone would be felt fluted.
void split_at_points(const Corners& corners, Mesh& mesh) {
  std::vector<std::uint8_t> point(mesh.vertex_count, 0);
  std::atomic<bool> any{false};
  parallel_for(mesh.vertex_count, kCreaseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (at_point(mesh, corners, static_cast<std::uint32_t>(v))) {
        point[v] = 1;
        any.store(true, std::memory_order_relaxed);
      }
  });
  if (!any) return;
  if (mesh.split_normals.empty()) mesh.split_normals.assign(mesh.triangles.size(), kNotSplit);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const uvec3 corner = mesh.triangles[t];
    if (!point[corner.x] && !point[corner.y] && !point[corner.z]) continue;
    if (mesh.split_normals[t] == kNotSplit) {
      mesh.split_normals[t] = static_cast<std::uint32_t>(mesh.corner_normal.size());
      for (int i = 0; i < 3; ++i) mesh.corner_normal.push_back(mesh.normal(corner[i]));
    }
    for (std::uint32_t i = 0; i < 3; ++i)
      if (point[corner[static_cast<int>(i)]])
        mesh.corner_normal[mesh.split_normals[t] + i] =
            vec3(normalize(face_normal(mesh, static_cast<std::uint32_t>(t))));
  }
}

}  // namespace

void find_creases(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
                  const Welded& welded, double crease_angle, Mesh& mesh) {
  const FileNormals file(primitives, to_object, gathered, welded, mesh);
  const bool authored = crease_angle > 0.0;
  const double never = std::cos(authored ? crease_angle : kNeverCrease);
  const double always = authored ? never : std::cos(kAlwaysCrease);
  const double between = std::cos(kCreaseTurn);
  mesh.crease.assign(mesh.triangles.size(), 0);
  std::atomic<bool> any{false};
  // Each edge is decided on both sides, so that no two threads write the same byte. Both sides agree because both
  // evaluate from the lower triangle.
  parallel_for(mesh.triangles.size(), kCreaseGrain, [&](std::size_t begin, std::size_t end) {
    bool found = false;
    for (std::size_t at = begin; at < end; ++at) {
      const auto t = static_cast<std::uint32_t>(at);
      const dvec3 own = face_normal(mesh, t);
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t other = mesh.across[t][i];
        if (other == kBorder) continue;
        const dvec3 theirs = face_normal(mesh, other);
        const double cosine = dot(own, theirs) / std::sqrt(dot(own, own) * dot(theirs, theirs));
        if (cosine >= never) continue;
        bool crease = cosine < always;
        if (!crease && file.known(t) && file.known(other)) {
          const std::uint32_t low = std::min(t, other), high = std::max(t, other);
          const uvec3 corners = mesh.triangles[t];
          crease = file.split(low, high, corners[i]) || file.split(low, high, corners[(i + 1) % 3]);
        } else if (!crease) {
          crease = cosine < between;
        }
        if (crease) mesh.crease[at] = static_cast<std::uint8_t>(mesh.crease[at] | 1u << i);
      }
      found = found || mesh.crease[at] != 0;
    }
    if (found) any.store(true, std::memory_order_relaxed);
  });
  if (!any) mesh.crease.clear();
}

void split_at_creases(const Corners& corners, Mesh& mesh) {
  if (!mesh.crease.empty()) split_fans(corners, mesh);
  split_at_points(corners, mesh);
  if (!mesh.split_normals.empty()) keep_split_normals(mesh);
}

void keep_split_normals(Mesh& mesh) {
  std::uint32_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::uint32_t& place = mesh.split_normals[t];
    if (place == kNotSplit) continue;
    bool differs = false;
    for (int i = 0; i < 3; ++i)
      differs =
          differs || mesh.corner_normal[place + static_cast<std::uint32_t>(i)] != mesh.normal(mesh.triangles[t][i]);
    if (differs) {
      std::copy_n(mesh.corner_normal.begin() + place, 3, mesh.corner_normal.begin() + kept);
      place = kept;
      kept += 3;
    } else {
      place = kNotSplit;
    }
  }
  mesh.corner_normal.resize(kept);
  mesh.corner_normal.shrink_to_fit();
  if (kept == 0) mesh.split_normals.clear();
}

}  // namespace pliant
