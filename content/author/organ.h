// An organ that is several meshes, one in the other: a capsule, vessels, lumps.
#pragma once

#include <string>
#include <vector>

#include "content/author/touchable.h"

namespace pliant {

struct Organ {
  std::int32_t body = -1;           // the outermost: it becomes tissue
  std::vector<std::int32_t> parts;  // only drawn, inside of it or below its node: they go along
};
// Of a node with a mesh: that node, or what it lies inside of. Of a node without: the largest mesh below it. Error:
// there is no mesh with an area.
Result<Organ> organ_of(const Level& level, std::int32_t node);

// The organ's body becomes soft and takes its parts along. Names of them, "" for none.
Result<std::string> make_soft_organ(Level& level, std::int32_t node, SoftBodyParameters parameters = {});

// As an organ is modelled: it keeps its shape under gravity, and takes along what lies inside of it.
SoftBodyParameters as_modelled(SoftBodyParameters parameters);

}  // namespace pliant
