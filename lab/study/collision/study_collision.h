// Speed and miss rate of contact searches on a mesh: walking from the last place, the tree, P1's own tree of vertices,
// and brute force over every triangle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/mesh.h"
#include "lab/study/pareto.h"

namespace pliant {

enum class Search : std::uint8_t {
  kWalk,         // P1's contact vertex, from the last one along edges
  kPatches,      // descent over curved patches from the last foot: the search of a contact between two ticks
  kTree,         // P1's contact vertex, through the tree
  kClosest,      // the closest point of the flat triangles, through the tree
  kClosestHint,  // the same, starting from the last one
  kUpwards,      // P1's tree, upwards from the last vertex, as printed; then the triangles around the nearest vertex
  kUpwardsBall,  // the same, repaired: until the ball of the least distance is inside the cell
  kBrute         // every triangle with a sufficiently near bounding sphere
};
inline constexpr Search kSearches[] = {Search::kWalk,        Search::kPatches, Search::kTree,        Search::kClosest,
                                       Search::kClosestHint, Search::kUpwards, Search::kUpwardsBall, Search::kBrute};
const char* name_of(Search search);

// Path of a probe, tick by tick: it slides over the surface by 0.05 % of the mesh's size per tick, from 1.5 % behind it
// to 0.5 % in front of it.
std::vector<dvec3> wander(const Mesh& mesh, std::size_t ticks);

// A miss is an answer farther than the nearest place by more than a quarter of a mean edge. Curved patches bulge from
// the facets by less, so that one criterion serves every search. The strict criterion is 1e-9 of the mesh's size.
inline constexpr double kMissRoom = 0.25;  // [1] of the mean edge
struct SearchFigures {
  double us = 0.0;          // CPU time per query
  double misses = 0.0;      // [1] of the checked queries
  double strict = 0.0;      // [1] the same with the strict criterion; NaN for patches, whose truth is another surface;
                            // of P1's tree: queries that miss the nearest vertex
  std::size_t checked = 0;  //
};
// [m] Brute-force distances at every `every`-th place of the path.
struct Truth {
  std::size_t every = 1;
  std::vector<double> vertex, flat;  // to P1's contact vertex, and to the closest point
  std::vector<double> corner;        // to the nearest vertex of the mesh
  double us = 0.0;                   // per query of the contact vertex
};
Truth truth_along(const Mesh& mesh, const std::vector<dvec3>& way, std::size_t checks);
// Queries along the whole path.
SearchFigures search_along(const Mesh& mesh, Search search, const std::vector<dvec3>& way, const Truth& truth);

// Closest-point queries on a sphere of that many vertices, from random points near it as in FCPW's benchmark, so that
// the cache does not contain the data of the last query. `checks` of them are compared with brute force.
SearchFigures search_scattered(std::uint32_t vertices, std::size_t queries, std::size_t checks);
// Published figures of FCPW (November 2026) on such spheres, one core of another machine. [us]
struct PublishedQuery {
  std::uint32_t vertices;
  double scalar_us, simd_us;
};
inline constexpr PublishedQuery kFcpw[] = {{100'000, 3.8, 1.2}, {1'000'000, 11.0, 7.5}};

}  // namespace pliant
