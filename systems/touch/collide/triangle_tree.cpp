#include "systems/touch/collide/triangle_tree.h"

#include "runtime/kernel.h"
#include "systems/touch/collide/virtual_vertex.h"

namespace pliant {
namespace {

constexpr std::uint32_t kTreeLanes = kTreeNodeWidth;

// Corners relative to the query point in units of the mesh, so that products of four lengths stay in the range of
// single precision; structure of arrays.
struct alignas(32) Corners8 {
  float v[3][3][kTreeLanes];
};

void gather(const Mesh& mesh, std::uint32_t first, std::uint32_t count, Corners8& out) {
  for (std::uint32_t l = 0; l < kTreeLanes; ++l) {
    const uvec3 t = mesh.triangles[first + std::min(l, count - 1)];
    for (int c = 0; c < 3; ++c) {
      out.v[c][0][l] = mesh.px[t[c]];
      out.v[c][1][l] = mesh.py[t[c]];
      out.v[c][2][l] = mesh.pz[t[c]];
    }
  }
}

// The smallest of the distances to the three edges and, if the point projects into the triangle, to its foot. Every
// value is the distance to some point of the triangle, so rounding increases it only to second order. Slivers, whose
// normals are lost in single precision, are therefore as exact as the rest.
PLIANT_KERNEL void distances2(const Corners8& corners, vec3 x, float scale, float* __restrict out) {
  const float* const ax_ = corners.v[0][0];
  const float* const ay_ = corners.v[0][1];
  const float* const az_ = corners.v[0][2];
  const float* const bx_ = corners.v[1][0];
  const float* const by_ = corners.v[1][1];
  const float* const bz_ = corners.v[1][2];
  const float* const cx_ = corners.v[2][0];
  const float* const cy_ = corners.v[2][1];
  const float* const cz_ = corners.v[2][2];
  const float back = 1.0f / (scale * scale);
  for (std::uint32_t l = 0; l < kTreeLanes; ++l) {
    const float ax = (ax_[l] - x.x) * scale, ay = (ay_[l] - x.y) * scale, az = (az_[l] - x.z) * scale;
    const float bx = (bx_[l] - x.x) * scale, by = (by_[l] - x.y) * scale, bz = (bz_[l] - x.z) * scale;
    const float cx = (cx_[l] - x.x) * scale, cy = (cy_[l] - x.y) * scale, cz = (cz_[l] - x.z) * scale;
    const float ux = bx - ax, uy = by - ay, uz = bz - az;  // edges a b, b c, c a
    const float vx = cx - bx, vy = cy - by, vz = cz - bz;
    const float wx = ax - cx, wy = ay - cy, wz = az - cz;
    const auto edge = [](float px, float py, float pz, float ex, float ey, float ez) {
      float size = ex * ex + ey * ey + ez * ez;
      size = size > 1e-30f ? size : 1e-30f;
      float s = -(px * ex + py * ey + pz * ez) / size;
      s = s > 0.0f ? s : 0.0f;
      s = s < 1.0f ? s : 1.0f;
      const float qx = px + s * ex, qy = py + s * ey, qz = pz + s * ez;
      return qx * qx + qy * qy + qz * qz;
    };
    float best = edge(ax, ay, az, ux, uy, uz);
    const float second = edge(bx, by, bz, vx, vy, vz), third = edge(cx, cy, cz, wx, wy, wz);
    best = second < best ? second : best;
    best = third < best ? third : best;
    const float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    // Twice the areas of the triangles between the foot and each edge, times |n|: barycentrics up to normalisation.
    const float fc = (ay * uz - az * uy) * nx + (az * ux - ax * uz) * ny + (ax * uy - ay * ux) * nz;
    const float fa = (by * vz - bz * vy) * nx + (bz * vx - bx * vz) * ny + (bx * vy - by * vx) * nz;
    const float fb = (cy * wz - cz * wy) * nx + (cz * wx - cx * wz) * ny + (cx * wy - cy * wx) * nz;
    const float sum = fa + fb + fc;
    const float inv = 1.0f / (sum > 1e-37f ? sum : 1e-37f);
    const float qx = (fa * ax + fb * bx + fc * cx) * inv, qy = (fa * ay + fb * by + fc * cy) * inv,
                qz = (fa * az + fb * bz + fc * cz) * inv;
    const float foot = qx * qx + qy * qy + qz * qz;
    float least = fa < fb ? fa : fb;
    least = least < fc ? least : fc;
    least = sum > 1e-37f ? least : -1.0f;
    float nearer = foot < best ? foot : best;
    nearer = least >= 0.0f ? nearer : best;
    out[l] = nearer * back;
  }
}

}  // namespace

void triangle_distances2(const Mesh& mesh, std::uint32_t first, std::uint32_t count, dvec3 x, TriangleDistances& out) {
  Corners8 corners;
  gather(mesh, first, count, corners);
  const vec3 size = mesh.box.size();
  const float most = std::max({size.x, size.y, size.z});
  distances2(corners, vec3(x), most > 0 ? 1.0f / most : 1.0f, out.data());
  for (std::uint32_t l = count; l < kTreeLanes; ++l) out[l] = std::numeric_limits<float>::infinity();
}

FlatPoint closest_on_triangle(const Mesh& mesh, std::uint32_t triangle, dvec3 x) {
  const uvec3 t = mesh.triangles[triangle];
  const dvec3 p[3] = {dvec3(mesh.position(t.x)), dvec3(mesh.position(t.y)), dvec3(mesh.position(t.z))};
  const dvec3 b = closest_barycentric(p, x);
  const dvec3 d = x - (b.x * p[0] + b.y * p[1] + b.z * p[2]);
  return {triangle, b, dot(d, d)};
}

FlatPoint closest_flat(const Mesh& mesh, dvec3 x, double within, std::uint32_t hint) {
  FlatPoint best;
  double distance = within;
  const double round = rounding(mesh, x);
  float limit = distance2_limit(distance, round);
  const auto look_at = [&](std::uint32_t triangle) {
    const FlatPoint p = closest_on_triangle(mesh, triangle, x);
    if (!(p.distance2 < best.distance2) || p.distance2 > within * within) return;
    best = p;
    distance = std::sqrt(p.distance2);
    limit = distance2_limit(distance, round);
  };
  if (hint < mesh.triangles.size()) look_at(hint);
  const vec3 single(x);
  TriangleDistances d2;
  tree::descend(
      mesh, [&](const TreeNode& node, float(&key)[kTreeNodeWidth]) { tree::box_distances2(node, single, key); },
      [&] { return limit; },
      [&](std::uint32_t first, std::uint32_t count) {
        triangle_distances2(mesh, first, count, x, d2);
        for (;;) {  // the nearest in double, until single precision rules out all others
          std::uint32_t nearest = 0;
          for (std::uint32_t l = 1; l < kTreeLanes; ++l) nearest = d2[l] < d2[nearest] ? l : nearest;
          if (!(d2[nearest] <= limit)) return;
          d2[nearest] = std::numeric_limits<float>::infinity();
          look_at(first + nearest);
        }
      });
  return best;
}

}  // namespace pliant
