// What a person should know of tetrahedra that fill a surface, in sentences: TetReport::findings.
#pragma once

#include <string>

#include "components/tet_mesh.h"
#include "content/tets/fill_region.h"
#include "content/tets/lattice.h"

namespace pliant {

// "0.93 mm", "12 cm", "1.4 m".
std::string length_text(double metres);

// [m] The least thickness of a wall that about kUsualTets tetrahedra hold whole, one layer of them a little thinner
// than it. `doubled`: the surface is a double wall, half of its area each sheet's.
double least_wall(const Mesh& surface, bool doubled);

// A surface that is a thin wall or open: what is done about it, and what else could be.
void report_wall(const SurfaceShape& shape, Fill fill, double thickness, TetReport& report);

// Ears, fins and rims: places with less tissue behind them than some cells. One element across bends as no tissue does,
// and where there is none the surface rides on what is near and crumples. Said from kThinShare of the surface on. A
// cell that an author named is a choice: only what is thinner than it is said.
inline constexpr double kThinCells = 1.5, kThinCellsOfNamed = 1.0;  // [cells]
inline constexpr double kHeldCells = 2.0;                           // [cells] across it hold a wall or an ear
inline constexpr double kThinShare = 0.02;                          // [1] of the area: edges of every body have some
// `mesh`: filled as `wish` says, its report's cell known.
void report_thin_places(const SurfaceShape& shape, const FillRegion& region, const LatticeWish& wish, TetMesh& mesh);

// Parts that were dropped (tet_parts.h), and such as are still apart.
void report_parts(std::uint32_t kept, std::uint32_t of_surface, TetReport& report);

}  // namespace pliant
