// Where two features of collision meshes - a vertex and a triangle, two edges - meet or may meet within a step.
// Everything moves in straight lines over the step: x + t d, t in [0, 1].
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
  double end_gap = 0.0;        // [m] what it would be at the end
  bool crosses = false;        // in front at the beginning, behind later, through the feature itself
  double when = 1.0;           // [1] of the step, where it crosses
  dvec3 barycentric{1, 0, 0};  // [1] on the triangle
  double along_a = 0.0;        // [1] 0-1 on the first edge, from its first end
  double along_b = 0.0;        // [1] on the second
};

struct Reach {
  double front = 1e-3;   // [m] a gap up to this at the beginning or at the end of the step is a meeting
  double behind = 1e-3;  // [m] so far behind is one too
};

// A vertex in front of a triangle (counter-clockwise seen from its front) that it will cross or comes near to, or
// behind it and not too far. It meets the triangle where its foot is inside, or beside by at most half the gap: over
// ridges and valleys the feet of neighbouring triangles leave a wedge free.
std::optional<Meeting> meet_triangle(const Moving& vertex, const std::array<Moving, 3>& triangle, const Reach& reach);

// An edge and the triangles beside it; `outward`: the sum of their normals. `inward[i]`: in the plane of triangle i,
// perpendicular to the edge, away from it, unit; both the same at a border. `turning`: by how much that changes over
// the step.
struct EdgeShape {
  dvec3 outward{0};
  std::array<dvec3, 2> inward;
  std::array<dvec3, 2> turning{};
};

// Two edges cross seen from the side; their normal must be one at which both bodies could support each other there (no
// triangle beside either edge leans over it), which decides its direction: it cannot flip. Where they cross, it is
// enough that they support each other at that instant: bodies tip onto each other within a step.
std::optional<Meeting> meet_edge(const std::array<Moving, 2>& a, const EdgeShape& shape_a,
                                 const std::array<Moving, 2>& b, const EdgeShape& shape_b, const Reach& reach);

// Instants in [0, 1], ascending, at which four points come to lie in one plane with (p - a) x (q - a) . (r - a) turning
// from positive to negative. Returns how many.
int find_crossings(const Moving& a, const Moving& p, const Moving& q, const Moving& r, std::array<double, 3>& times);

}  // namespace pliant
