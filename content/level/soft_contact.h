// Contacts of tissue whose `contact` is left to the engine: split where that is proved (methods.md 2.10) and worth its
// time, else plain.
#pragma once

#include "components/tet_mesh.h"
#include "content/level/level.h"

namespace pliant {

// A soft body's contacts as stated. With PLIANT_deformable, the law of its dents, they are split.
SoftContact contact_of(const LevelNode& node);

// Why the contacts of a soft body are plain, as text that follows "contacts of the lattice: "; "": nothing speaks
// against split ones. By the level:
std::string why_plain(const Level& level, const LevelNode& node);
// and by its tissue. `pinned`: some node is.
std::string why_plain(const Mesh& surface, const TetMesh& tets, bool pinned);

}  // namespace pliant
