// Initial state of soft bodies under gravity (UnderGravity), and findings about it.
#pragma once

#include <vector>

#include "components/world.h"

namespace pliant {

// Before bodies are made: sets TetMesh::start. If the mesh is modelled under load, its nodes become the unloaded shape.
// A body that cannot keep its shape begins at rest in its sag; one without an equilibrium falls. TetReport::findings
// of its tetrahedra report both.
void begin_under_gravity(World& world);

// For inspection of a level before it runs: large sag, rotation, or lack of equilibrium is reported in
// TetReport::findings. Some tenths of a second per body. After begin_under_gravity.
void find_sag(World& world);

// Each of TetReport::findings, "`name`: " before it, of all soft bodies.
std::vector<Note> tissue_findings(const World& world);

// After a run: pinned bodies that are far from their start, or have turned over, and unsupported ones that have fallen
// out of the scene. Tools are left out.
std::vector<Note> explain_sag(const World& world);

}  // namespace pliant
