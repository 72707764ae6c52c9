// The sliders of a level: the key `expose` of PLIANT_simulation, checked.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"
#include "pliant/slider.h"

namespace pliant {

// The sliders in the order of the file; the error says which entry names what is absent, or cannot change in a run.
Result<std::vector<Slider>> sliders_of(const Level& level);

// Sliders of a renamed node follow; `to` "": the node is gone, and so are they.
void rename_exposed(LevelSimulation& simulation, const std::string& from, const std::string& to);
// Removes sliders of an extension that this node no longer has.
void forget_exposed(LevelSimulation& simulation, const std::string& node, const std::string& extension);

}  // namespace pliant
