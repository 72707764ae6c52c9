// How soft bodies begin under gravity (UnderGravity), and what there is to say about it.
#pragma once

#include <string>
#include <vector>

#include "components/world.h"

namespace pliant {

// Before bodies are made: TetMesh::start, and where the mesh is the shape under its weight, its nodes without. A body
// that cannot keep its shape begins at rest in its sag, one that has no rest falls; TetReport::findings of its
// tetrahedra say so.
void begin_under_gravity(World& world);

// For whoever looks at a level before it runs: what sags far, turns over or finds no rest is said in
// TetReport::findings. Some tenths of a second a body. After begin_under_gravity.
void find_sag(World& world);

// "`name`: " and each of TetReport::findings, of all soft bodies.
std::vector<std::string> tissue_findings(const World& world);

// After a run: pinned bodies that are far from where they began, or have turned over, and those that have fallen out of
// the scene because nothing holds them. Tools are left out.
std::vector<std::string> explain_sag(const World& world);

}  // namespace pliant
