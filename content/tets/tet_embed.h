// How a surface rides on tetrahedra: each vertex by barycentric weights in the tetrahedron that holds it, else in the
// nearest one on its inner side.
#pragma once

#include <vector>

#include "components/mesh.h"
#include "components/tet_mesh.h"

namespace pliant {

// Of each vertex of the surface, for tetrahedra in Hilbert order. Weights sum to 1 and give the rest position back to
// rounding. At least one tetrahedron must have a volume.
std::vector<Embedding> embed(const Mesh& surface, const std::vector<dvec3>& nodes, const std::vector<Tet>& tets);
// ... and of points of a surface, each with its outward normal.
std::vector<Embedding> embed(const std::vector<dvec3>& points, const std::vector<dvec3>& normals,
                             const std::vector<dvec3>& nodes, const std::vector<Tet>& tets);

// Of each point: whether a tetrahedron holds it. Tetrahedra as above.
std::vector<std::uint8_t> are_inside(const std::vector<dvec3>& points, const std::vector<dvec3>& nodes,
                                     const std::vector<Tet>& tets);

}  // namespace pliant
