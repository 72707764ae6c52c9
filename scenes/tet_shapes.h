// Small tetrahedral meshes for tests and benchmarks, generated in code.
#pragma once

#include <functional>

#include "components/tet_mesh.h"

namespace pliant::tets {

// A block with nodes at all of xs x ys x zs [m, ascending], six tetrahedra per cell around its diagonal. Neighbouring
// cells are mirrored, so that no direction is preferred.
TetMesh grid(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<double>& zs);

// count cells of equal size over [from, to] [m]: count + 1 coordinates.
std::vector<double> even(int count, double from, double to);

// The same for a whole box.
TetMesh box(int nx, int ny, int nz, dvec3 min, dvec3 max);

// Reorders the nodes: free, then those of `handle`, then those of `pinned`.
void hold(
    TetMesh& mesh, const std::function<bool(dvec3)>& pinned,
    const std::function<bool(dvec3)>& handle = [](dvec3) { return false; });

// A deterministic vector in the unit cube [-1, 1]^3 for a number.
dvec3 scatter(std::uint32_t number);

double volume(const TetMesh& mesh, const std::vector<dvec3>& x);  // [m3] signed, summed

}  // namespace pliant::tets
