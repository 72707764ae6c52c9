// What a surface would be as tissue, before a level says so: for `inspect`, and for an editor that shows it while
// somebody moves a slider. Nothing is embedded and no world is made, so it takes a second at most (lattice.h).
#pragma once

#include <stop_token>

#include "components/soft_body.h"
#include "content/mesh/mesh_build.h"

namespace pliant {

struct SoftPreview {
  double cell = 0.0;  // [m] of the lattice, also where the body names none
  std::size_t tetrahedra = 0;
  std::size_t pinned = 0, on_handle = 0;  // nodes
  std::uint32_t parts = 0;                // that are kept
  std::uint32_t parts_lost = 0;           // too small to keep (tet_parts.h)
  TetQuality quality;
  double volume = 0.0;   // [m3]
  double wall = 0.0;     // [m] thickness of the thin wall that the surface is; 0: it is none
  double step_ms = 0.0;  // [ms] of a soft step on this machine, pressed by a tool: an estimate (step_cost.h)
  std::vector<std::string> findings;  // as inspect says them, without the body's name

  TetMesh body;  // without embedding, its nodes in the order free, handle, pinned

  // To draw, object frame.
  std::vector<dvec3> nodes;                         // [m]
  std::vector<std::array<std::uint32_t, 2>> edges;  // of tetrahedra, each once; ascending
};

// `surface`: the node's mesh in the object frame (build_mesh). `body.cell` and what else is 0 is found as a run finds
// it. `handle`: null where the body has none. `stop`: ends it early, from any thread, with an error that says so.
// Errors: those that a run would end with. The same whatever the number of threads, but for step_ms.
Result<SoftPreview> preview_soft_body(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle = nullptr,
                                      const std::stop_token& stop = {});

}  // namespace pliant
