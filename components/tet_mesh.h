// The inside of a soft body: tetrahedra at rest, and the embedding of its collision mesh. Object frame, scale baked in.
// Lifetime: from load to unload. Writer: content. Read by every clock.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "components/math.h"
#include "runtime/entity.h"
#include "runtime/result.h"
#include "runtime/store.h"

namespace pliant {

struct Mesh;

using Tet = std::array<std::uint32_t, 4>;  // nodes; positive volume: (b-a) x (c-a) . (d-a) > 0

// A cell of a lattice with the part of it that is tissue. Corner k is at (+-1, +-1, +-1) of its own coordinates: bit 0
// of k is x, bit 1 y, bit 2 z. Moments are over the tissue, in these coordinates.
struct LatticeCell {
  std::array<std::uint32_t, 8> nodes{};
  double share = 1.0;          // [1] of its volume
  dvec3 mean{0}, products{0};  // [1] of x, y, z; of yz, zx, xy
  dvec3 spread{1.0 / 3.0};     // [1] variance of x, y, z
};

inline constexpr std::size_t kTetsOfCell = 6;

// Factors on the body's material.
struct ElementFactors {
  double stiffness = 1.0, damping = 1.0;  // [1] on young; on rayleigh's beta
  double relaxation = 1.0;                // [1] on the shares of prony's arms
};

// A hollow inside the tetrahedra: its wall's faces, counter-clockwise seen from the tissue, so that they enclose a
// positive volume.
struct TetCavity {
  std::vector<uvec3> wall;            // nodes
  double pressure = 0.0, bulk = 0.0;  // [Pa] of pliant/parameters.h's Cavity
};

// Embedding of a point of the collision mesh in the tetrahedra: sum of weight[i] * node[tets[tet][i]]. Weights sum to
// 1; they may be negative where the collision mesh is slightly outside.
struct Embedding {
  std::uint32_t tet = 0;
  std::array<double, 4> weight{1, 0, 0, 0};  // [1]
};

// A point of the surface's rest shape with its share of the surface, and the tetrahedron that it moves with.
struct SurfaceSample {
  dvec3 position{0}, normal{0, 1, 0};  // [m], [1] outward; object frame
  double area = 0.0;                   // [m2]
  Embedding embedding;
};

// Shape of the worst and of the median element.
struct TetQuality {
  double smallest_dihedral = 0.0, largest_dihedral = 0.0;  // [rad] over all elements
  double worst_ratio = 0.0, median_ratio = 0.0;            // [1] 3 x inradius / circumradius: 1 regular, 0 flat
};

// Result of meshing a surface with tetrahedra, for inspection before the simulation. Zeros: from a file.
struct TetReport {
  double cell = 0.0;                // [m] of the lattice, in its focus if it has one
  double coarsest = 0.0;            // [m] cell farthest from the focus; `cell` without a focus
  double wall = 0.0;                // [m] median thickness of a surface that is a thin wall; 0: not a thin wall
  std::uint32_t parts_dropped = 0;  // too small to keep
  double volume_dropped = 0.0;      // [1] their share of the tissue
  double thin = 0.0;                // [1] share of the surface with less tissue behind it than thin_places.h requires
  double least_thickness = 0.0;     // [m] of that tissue; 0: nothing is thin
  vec3 thinnest{0};                 // [m] where
  std::vector<Note> notes;          // on how it is filled and what it carries, without the body's name
  std::vector<Note> findings;       // on how it stands under gravity, without the body's name
};

// A mesh that is only drawn and moves with the tissue around it.
struct CarriedPart {
  Entity entity;
  Handle<Mesh> mesh;                 // in the body's object frame
  std::vector<Embedding> embedding;  // of each of its vertices
  std::vector<vec3> aside;           // [m] of vertices outside of the tissue: offset from their embedding; else empty
};

struct TetMesh {
  std::string name;
  std::vector<dvec3> nodes;                 // [m] rest. Order: free, on the handle, of each further rigid part, pinned
  std::uint32_t free_count = 0;             // nodes [0, free_count) are free
  std::uint32_t handle_count = 0;           // nodes [free_count, free_count + handle_count) belong to the rigid handle
  std::vector<std::uint32_t> rigid_counts;  // nodes of each further rigid part (SoftBody::rigid), after the handle's
  std::vector<Tet> tets;
  // Of a lattice of hexahedra: they carry the elasticity. Tetrahedra 6 k to 6 k + 5 divide cell k, for what is
  // embedded.
  std::vector<LatticeCell> cells;
  std::vector<double> volume;           // [m3] of each node: what its mass is of, times the body's density; empty: a
                                        // quarter of each of its tetrahedra
  std::vector<std::uint16_t> group;     // of each tetrahedron of a file: its physical group, 0 none; empty: none
  std::vector<ElementFactors> factors;  // of each cell, or without cells of each tetrahedron; empty: 1
  std::vector<Embedding> embedding;     // of each vertex of the body's touch mesh (SoftBody::collision_mesh)
  std::vector<SurfaceSample> samples;  // of the touch mesh, a quarter of a cell apart; empty unless SoftContact::kSplit
  std::vector<CarriedPart> parts;
  std::vector<TetCavity> cavities;
  // [m] Initial positions of the nodes, if not at rest (UnderGravity). Writer: prepare_soft.
  std::vector<dvec3> start;
  TetQuality quality;
  TetReport report;

  std::uint32_t node_count() const { return static_cast<std::uint32_t>(nodes.size()); }
  std::uint32_t rigid_begin() const { return free_count + handle_count; }
  std::uint32_t pinned_begin() const {
    std::uint32_t end = rigid_begin();
    for (const std::uint32_t count : rigid_counts) end += count;
    return end;
  }
};

}  // namespace pliant
