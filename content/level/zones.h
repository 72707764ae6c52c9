// Zones: runs of kZoneSize vertices. Along the Hilbert curve they are compact patches; here they get boxes and
// neighbours.
#pragma once

#include "components/mesh.h"

namespace pliant {

// zone_box (of the vertices and of every triangle around them) and the neighbour lists (ascending, symmetric).
void build_zones(Mesh& mesh);

}  // namespace pliant
