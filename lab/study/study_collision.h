// How fast a place of touch is found on a mesh, and how often a nearer one is missed: by walking from the last place,
// through the tree, and by looking at every triangle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/mesh.h"
#include "lab/study/pareto.h"

namespace pliant {

enum class Search : std::uint8_t {
  kWalk,         // P1's contact vertex, from the last one over edges
  kPatches,      // downhill over curved patches from the last foot: what a contact does between two ticks
  kTree,         // P1's contact vertex, through the tree
  kClosest,      // the closest point of the flat triangles, through the tree
  kClosestHint,  // the same from the last one
  kBrute         // every triangle whose bounding sphere is near enough
};
inline constexpr Search kSearches[] = {Search::kWalk,    Search::kPatches,     Search::kTree,
                                       Search::kClosest, Search::kClosestHint, Search::kBrute};
const char* name_of(Search search);

// Where a probe is, tick by tick: it slides on over the surface, 0.05 % of the mesh's size a tick, from 1.5 % behind it
// to 0.5 % in front of it.
std::vector<dvec3> wander(const Mesh& mesh, std::size_t ticks);

// A miss is an answer that is farther than the nearest place by more than a quarter of a mean edge: curved patches
// bulge from the facets by less, and every search is judged alike. Strictly: by more than 1e-9 of the mesh's size.
inline constexpr double kMissRoom = 0.25;  // [1] of the mean edge
struct SearchFigures {
  double us = 0.0;          // a query, processor time
  double misses = 0.0;      // [1] of those that were checked
  double strict = 0.0;      // [1] the same, strictly; not a number: of patches, whose truth is another surface
  std::size_t checked = 0;  //
};
// Distances by brute force of every so many places of the way. [m]
struct Truth {
  std::size_t every = 1;
  std::vector<double> vertex, flat;  // of P1's contact vertex, and of the closest point
  double us = 0.0;                   // a query of the contact vertex
};
Truth truth_along(const Mesh& mesh, const std::vector<dvec3>& way, std::size_t checks);
// Queries all along the way.
SearchFigures search_along(const Mesh& mesh, Search search, const std::vector<dvec3>& way, const Truth& truth);

// Queries of the closest point on a sphere of so many vertices, of points as FCPW was asked: anywhere near it, so that
// none finds in the cache what the last one left there. `checks` of them are held against brute force.
SearchFigures search_scattered(std::uint32_t vertices, std::size_t queries, std::size_t checks);
// Published figures of FCPW (November 2026) on such spheres, one core of another machine. [us]
struct PublishedQuery {
  std::uint32_t vertices;
  double scalar_us, simd_us;
};
inline constexpr PublishedQuery kFcpw[] = {{100'000, 3.8, 1.2}, {1'000'000, 11.0, 7.5}};

}  // namespace pliant
