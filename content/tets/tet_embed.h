// Embeds a surface in tetrahedra: each vertex has barycentric weights in the tetrahedron that contains it, else in the
// nearest one on its inner side.
#pragma once

#include <vector>

#include "components/mesh.h"
#include "components/tet_mesh.h"

namespace pliant {

// One embedding per surface vertex, for tetrahedra in Hilbert order. Weights sum to 1 and reproduce the rest position
// within rounding. At least one tetrahedron must have a volume.
std::vector<Embedding> embed(const Mesh& surface, const std::vector<dvec3>& nodes, const std::vector<Tet>& tets);
// The same for surface points with outward normals.
std::vector<Embedding> embed(const std::vector<dvec3>& points, const std::vector<dvec3>& normals,
                             const std::vector<dvec3>& nodes, const std::vector<Tet>& tets);

// Whether a tetrahedron contains each point. Tetrahedra as above.
std::vector<std::uint8_t> are_inside(const std::vector<dvec3>& points, const std::vector<dvec3>& nodes,
                                     const std::vector<Tet>& tets);

}  // namespace pliant
