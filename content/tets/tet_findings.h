// Notes for the user about tetrahedra that fill a surface: TetReport::notes.
#pragma once

#include <string>

#include "components/tet_mesh.h"
#include "content/tets/fill_region.h"
#include "content/tets/lattice.h"

namespace pliant {

// Code of notes and errors that another `fill` cures.
inline constexpr const char* kFillNote = "tissue.fill";

inline constexpr double kTetsPerCell = 12.0;  // of the lattice

// "0.93 mm", "12 cm", "1.4 m".
std::string length_text(double metres);

// [m] The thinnest wall that about kUsualTets tetrahedra keep connected, with one layer slightly thinner than it.
// `doubled`: the surface is a double wall, with half of its area on each sheet.
double least_wall(const Mesh& surface, bool doubled);

// Reports a thin wall or open surface: how it was filled, and the alternatives.
void report_wall(const SurfaceShape& shape, Fill fill, double thickness, TetReport& report);

// Ears, fins and rims: places thinner than some cells. A single element across does not bend like tissue. Without an
// element, the surface follows a near one and crumples. Reported from kThinShare of the surface on. If the author chose
// the cell, only places thinner than it are reported.
inline constexpr double kThinCells = 1.5, kThinCellsOfNamed = 1.0;  // [cells]
inline constexpr double kHeldCells = 2.0;                           // [cells] across keep a wall or an ear connected
inline constexpr double kThinShare = 0.02;                          // [1] of the area: every body has some thin edges
// `mesh`: filled as `options` specifies, with its report's cell set.
void report_thin_places(const SurfaceShape& shape, const FillRegion& region, const LatticeOptions& options,
                        TetMesh& mesh);

// Reports dropped parts (tet_parts.h), and remaining separate parts.
void report_parts(std::uint32_t kept, std::uint32_t of_surface, TetReport& report);

}  // namespace pliant
