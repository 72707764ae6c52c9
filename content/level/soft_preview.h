// Previews the tetrahedra of a surface, for `inspect` and for an editor while a slider is moved. Embeds nothing and
// creates no world, so it takes at most a second (lattice.h).
#pragma once

#include <stop_token>

#include "components/soft_body.h"
#include "content/mesh/mesh_build.h"

namespace pliant {

struct SoftPreview {
  double cell = 0.0;  // [m] of the lattice, also if the body specifies none
  std::size_t tetrahedra = 0;
  std::size_t pinned = 0, on_handle = 0;  // nodes
  std::uint32_t parts = 0;                // kept
  std::uint32_t parts_lost = 0;           // dropped as too small (tet_parts.h)
  TetQuality quality;
  double volume = 0.0;      // [m3]
  double wall = 0.0;        // [m] wall thickness; 0: not a thin wall
  double step_ms = 0.0;     // [ms] estimated time of a soft step on this machine, with tool contact (step_cost.h)
  std::vector<Note> notes;  // as in inspect, without the body's name

  TetMesh body;  // without embedding; nodes in the order free, handle, pinned

  // For drawing, object frame.
  std::vector<dvec3> nodes;                         // [m]
  std::vector<std::array<std::uint32_t, 2>> edges;  // of tetrahedra, each once; ascending
};

// `surface`: the node's mesh in the object frame (build_mesh). `body.cell` and other zero values are chosen as for a
// run. `handle`: null if the body has none. `stop`: cancels from any thread; returns an error. Other errors are those
// of a run. The result does not depend on the number of threads, except step_ms.
Result<SoftPreview> preview_soft_body(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle = nullptr,
                                      const std::stop_token& stop = {});

}  // namespace pliant
