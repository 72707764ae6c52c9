// Keys of a level that a Session can change between ticks, and the reasons against the others.
#pragma once

#include <string>

#include "content/keys/extension_table.h"

namespace pliant {

// Empty if the key is live; otherwise the reason and the remedy: "the mesh is built with it; change the scene and open
// it again".
std::string why_not_live(const Extension& extension, const Key& key);

}  // namespace pliant
