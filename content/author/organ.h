// An organ of several nested meshes, such as a capsule, vessels and lumps.
#pragma once

#include <string>
#include <vector>

#include "content/author/touchable.h"

namespace pliant {

struct Organ {
  std::int32_t body = -1;           // the outermost mesh: becomes tissue
  std::vector<std::int32_t> parts;  // only drawn; inside the body or below its node, and carried by it
};
// Node with a mesh: that node, or the object that contains it. Node without a mesh: the largest mesh below it. Error:
// there is no mesh with an area.
Result<Organ> organ_of(const Level& level, std::int32_t node);

// Makes the organ's body soft and lets it carry the parts. Returns the parts' names, "" if there are none.
Result<std::string> make_soft_organ(Level& level, std::int32_t node, SoftBodyParameters parameters = {});

// Preset: the tissue keeps its modelled shape under gravity and carries enclosed objects.
SoftBodyParameters as_modelled(SoftBodyParameters parameters);

}  // namespace pliant
