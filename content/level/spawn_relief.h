// Drawn relief for the surfaces of a World that are to feel it.
#pragma once

#include <string>
#include <vector>

#include "components/world.h"

namespace pliant {

// Makes heights of the materials' maps for every mesh of a Deformable whose `relief` is above 0. The world has its
// images by then. `notes` receives where the relief fades or is stretched; may be null.
void add_relief(World& world, std::vector<std::string>* notes);

}  // namespace pliant
