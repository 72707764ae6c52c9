// Masses of the nodes of a soft body: so that the whole has the mass, the centre of mass and the inertia of what its
// surface encloses, whatever its elements cut off.
#pragma once

#include <optional>

#include "components/mass_properties.h"
#include "components/tet_mesh.h"
#include "content/tets/fill_region.h"

namespace pliant {

// Of the region that a surface's tetrahedra fill. In closed form where the surface is closed and of one part, else
// where samples of the region agree with that; else of the samples.
MassProperties mass_of(const Mesh& surface, const FillRegion& region, bool enclosed);

// Sets TetMesh::volume, from a quarter of each tetrahedron where it is empty, to match: each node's times the
// exponential of a polynomial of second order in its place, which keeps it positive and changes least. Where no such
// one is found (a body that is flat on its nodes), volume and centre match, or the volume alone.
void match_mass(const MassProperties& whole, TetMesh& mesh);

}  // namespace pliant
