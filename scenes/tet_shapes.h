// Small tetrahedral meshes for tests and benchmarks, made on the spot.
#pragma once

#include <functional>

#include "components/tet_mesh.h"

namespace pliant::tets {

// A block with nodes at all of xs x ys x zs [m, ascending], six tetrahedra a cell around its diagonal; cells mirror
// one another, so that no direction of the block is preferred.
TetMesh grid(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<double>& zs);

// count cells of equal size over [from, to] [m]: count + 1 coordinates.
std::vector<double> even(int count, double from, double to);

// The same for a whole box.
TetMesh box(int nx, int ny, int nz, dvec3 min, dvec3 max);

// Puts the nodes that `pinned` names behind the others, those that `handle` names between.
void hold(
    TetMesh& mesh, const std::function<bool(dvec3)>& pinned,
    const std::function<bool(dvec3)>& handle = [](dvec3) { return false; });

// A vector in the unit cube [-1, 1]^3, by number: the same one always.
dvec3 scatter(std::uint32_t number);

double volume(const TetMesh& mesh, const std::vector<dvec3>& x);  // [m3] signed, summed

}  // namespace pliant::tets
