// Two features of collision meshes (a vertex and a triangle, or two edges) that touch or may touch within a step. All
// motion over the step is linear: x + t d, t in [0, 1].
#pragma once

#include <array>
#include <optional>

#include "components/math.h"

namespace pliant {

struct Moving {
  dvec3 x{0};  // [m] at the beginning
  dvec3 d{0};  // [m] over the step
  dvec3 at(double t) const { return x + t * d; }
};

struct Meeting {
  dvec3 normal{0, 1, 0};       // [1] unit, at the beginning, out of the second feature towards the first
  double gap = 0.0;            // [m] along the normal, at the beginning; < 0: behind
  double end_gap = 0.0;        // [m] extrapolated to the end
  bool crosses = false;        // in front at the beginning, behind later, having passed through the feature
  double when = 1.0;           // [1] of the step: time of crossing
  dvec3 barycentric{1, 0, 0};  // [1] on the triangle
  double along_a = 0.0;        // [1] 0-1 on the first edge, from its first end
  double along_b = 0.0;        // [1] on the second
};

struct Reach {
  double front = 1e-3;   // [m] largest gap of a meeting, at the beginning or at the end of the step
  double behind = 1e-3;  // [m] largest penetration of a meeting
};

// A vertex in front of a triangle (counter-clockwise seen from its front) that it will cross or approach, or behind it
// and not too far. It meets the triangle if its foot is inside, or outside by at most half the gap: over ridges and
// valleys the feet of neighbouring triangles leave a wedge uncovered.
std::optional<Meeting> meet_triangle(const Moving& vertex, const std::array<Moving, 3>& triangle, const Reach& reach);

// An edge and its adjacent triangles; `outward`: the sum of their normals. `inward[i]`: in the plane of triangle i,
// perpendicular to the edge, away from it, unit; both the same at a border. `turning`: its change over the step.
struct EdgeShape {
  dvec3 outward{0};
  std::array<dvec3, 2> inward;
  std::array<dvec3, 2> turning{};
};

// Two edges that cross when projected along their common normal. Both bodies must be able to support each other along
// that normal (no triangle beside either edge leans over it). This determines its direction: it cannot flip. For
// crossing edges it is sufficient that they support each other at the instant of crossing: bodies tip onto each other
// within a step.
std::optional<Meeting> meet_edge(const std::array<Moving, 2>& a, const EdgeShape& shape_a,
                                 const std::array<Moving, 2>& b, const EdgeShape& shape_b, const Reach& reach);

// Times in [0, 1], ascending, at which four points become coplanar with (p - a) x (q - a) . (r - a) changing from
// positive to negative. Returns their number.
int find_crossings(const Moving& a, const Moving& p, const Moving& q, const Moving& r, std::array<double, 3>& times);

}  // namespace pliant
