// A painted map as a contact feels it: a value with a continuous gradient, so that no force steps where the tip crosses
// an edge of the mesh, and of the same width on every mesh.
#pragma once

#include <vector>

#include "components/transform.h"
#include "systems/touch/collide/foot_blend.h"

namespace pliant {

// A surface flush with the mesh, beyond its border: the stiffer or softer side of a seam.
struct FlushPaint {
  const Mesh* mesh = nullptr;
  Pose place;          // in the frame of the mesh
  double value = 1.0;  // [1] of the unpainted flush surface, relative to the unpainted mesh
  const std::vector<float>* factor = nullptr;
};

// The map without detail that a contact cannot resolve: at each vertex the regression plane of the values within
// `radius` [m] on its side of the surface and of those flush with it (weights: area times (1 - r2/R2)^2). A vertex with
// too few others there keeps its value, and so does 0. Empty if it is 1 everywhere.
std::vector<float> felt_paint(const Mesh& mesh, const std::vector<float>& factor, double radius,
                              const std::vector<FlushPaint>& flush = {});

// Value and gradient by x at the blended place. On each triangle the reduced Clough-Tocher cubic (Clough & Tocher 1965;
// ordinates as in Farin, Triangular Bernstein-Bezier patches, 1986), from values and least-squares gradients at the
// vertices: exact for linear maps and continuously differentiable over edges of a flat mesh. Gradients are limited so
// that no value leaves the range of its neighbours.
Painted smooth_painted(const FootBlend& blend, const Mesh& mesh, const std::vector<float>& factor);

}  // namespace pliant
