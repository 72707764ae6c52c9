// Zones: runs of kZoneSize vertices, which are compact patches along the Hilbert curve. Computes their boxes and
// neighbours.
#pragma once

#include "components/mesh.h"

namespace pliant {

// Fills zone_box (of the vertices and all triangles around them) and the neighbour lists (ascending, symmetric).
void build_zones(Mesh& mesh);

}  // namespace pliant
