// A triangle as a smooth curved surface: a cubic patch through its corners whose normals there are the corner normals
// (PN triangle; Vlachos et al. 2001). Neighbours share the boundary curve over a smooth edge and over a crease; the
// curve of a crease is tangent to both sides. The patch is flat where the corner normals are the facet's normal.
//
// Legend: b[0..2] corners; b[3 + 2 i], b[4 + 2 i] on the edge from corner i to i+1, nearer to i and to i+1; b[9]
// middle. (u, v) are the barycentrics of corners 1 and 2, w = 1 - u - v that of corner 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "components/math.h"
#include "components/mesh.h"

namespace pliant {

struct CurvedPatch {
  dvec3 b[10];        // [m] control points, object frame
  bool flat = false;  // the patch is its triangle

  // Position and derivatives by (u, v). [m]
  struct Point {
    dvec3 p, pu, pv, puu, puv, pvv;
  };
  Point at(double u, double v) const {
    const double w = 1 - u - v;
    if (flat) return {w * b[0] + u * b[1] + v * b[2], b[1] - b[0], b[2] - b[0], dvec3(0), dvec3(0), dvec3(0)};
    // A cubic as a linear form of quadratics Q_i (de Casteljau): p = w Q0 + u Q1 + v Q2, p_u = 3 (Q1 - Q0).
    const dvec3 l00 = w * b[0] + u * b[3] + v * b[8], l01 = w * b[3] + u * b[4] + v * b[9],
                l02 = w * b[8] + u * b[9] + v * b[7], l11 = w * b[4] + u * b[1] + v * b[5],
                l12 = w * b[9] + u * b[5] + v * b[6], l22 = w * b[7] + u * b[6] + v * b[2];
    const dvec3 q0 = w * l00 + u * l01 + v * l02, q1 = w * l01 + u * l11 + v * l12, q2 = w * l02 + u * l12 + v * l22;
    return {w * q0 + u * q1 + v * q2,
            3.0 * (q1 - q0),
            3.0 * (q2 - q0),
            6.0 * (l11 - 2.0 * l01 + l00),
            6.0 * (l12 - l01 - l02 + l00),
            6.0 * (l22 - 2.0 * l02 + l00)};
  }
};

// Largest distance of a control point from its edge, as a share of the edge's length: bounds the effect of bad normals.
inline constexpr double kMostPatchBulge = 0.25;

inline CurvedPatch curved_patch(const Mesh& mesh, std::uint32_t triangle) {
  const uvec3 t = mesh.triangles[triangle];
  CurvedPatch patch;
  dvec3 n[3];
  for (int i = 0; i < 3; ++i) {
    patch.b[i] = dvec3(mesh.position(t[i]));
    n[i] = dvec3(mesh.normal(triangle, i));
  }
  patch.flat = true;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const dvec3 e = patch.b[j] - patch.b[i];
    const double most = kMostPatchBulge * length(e);
    // Tangents at both ends: in the tangent plane, or along the crease, where both sides share it.
    dvec3 across_i(0), across_j(0);
    const bool crease = mesh.is_crease(triangle, i) && mesh.across[triangle][i] != kBorder;
    if (crease) {
      const std::uint32_t other = mesh.across[triangle][i];
      const uvec3 o = mesh.triangles[other];
      for (int k = 0; k < 3; ++k) {
        if (o[k] == t[i]) across_i = dvec3(mesh.normal(other, k));
        if (o[k] == t[j]) across_j = dvec3(mesh.normal(other, k));
      }
    }
    const auto offset = [&](dvec3 along, dvec3 own, dvec3 across) {  // offset of a control point from the chord
      dvec3 off = -(dot(along, own) / 3) * own;
      if (crease) {
        const dvec3 line = cross(own, across);
        const double size = dot(line, line);
        off = size > 0.1 ? along * (-1.0 / 3) + line * (dot(along, line) / (3 * size)) : dvec3(0);
      }
      const double far = length(off);
      if (far > most) off *= most / far;
      return off;
    };
    const dvec3 at_i = offset(e, n[i], across_i), at_j = offset(-e, n[j], across_j);
    patch.b[3 + 2 * i] = patch.b[i] + e / 3.0 + at_i;
    patch.b[4 + 2 * i] = patch.b[j] - e / 3.0 + at_j;
    if (length(at_i) + length(at_j) > 1e-7 * length(e)) patch.flat = false;
  }
  dvec3 edges(0);
  for (int k = 3; k < 9; ++k) edges += patch.b[k] / 6.0;
  patch.b[9] = edges + (edges - (patch.b[0] + patch.b[1] + patch.b[2]) / 3.0) / 2.0;
  return patch;
}

}  // namespace pliant
